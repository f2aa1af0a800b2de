#include "fovea/drive/live/live_decoder.h"

#include <fmt/format.h>

#include <cmath>

#include "fovea/core/parallel.h"
#include "fovea/drive/frame_parts.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/live/scan_points.h"
#include "fovea/drive/scans/sensor_scans.h"
#include "fovea/errors.h"

namespace fovea {

Image pixels_of(const LiveImage& image, const std::string& name) {
  if (const auto* pixels = std::get_if<Image>(&image.content)) return *pixels;
  const auto& bytes = std::get<std::string>(image.content);
  return decode_image({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, name);
}

std::string LiveDecoder::name_of(const LiveLidar& of, TimeNs stamp) const {
  return fmt::format("{}, scan{} of {:.3f} s", name.string(),
                     of.name.empty() ? "" : " of LiDAR " + of.name, seconds(stamp));
}

LoadedFrame LiveDecoder::decode(const RawFrame& raw) const {
  Frame frame;
  frame.index = raw.index;
  frame.stamp = raw.stamp;
  frame.motion = raw.motion;
  try {
    LidarScan scan =
        usable_points(raw.scan->points, lidar.format, raw.stamp, name_of(lidar, raw.stamp));
    frame.scan = std::move(scan.points);
    frame.dropped_points = scan.dropped;
    frame.dropped_points += raw.scan->dropped;
  } catch (const InputError& error) {
    return SkippedFrame{raw.index, SkipReason::kDamagedScan, error.what()};
  }
  if (further_lidars.empty()) {
    if (lidar.sweep_compensated) frame.scan.time.clear();
  } else {
    set_point_times(frame.scan, lidar.sweep_compensated, lidar.sweep);
    frame.scan.sensor.assign(frame.scan.size(), 0);
    add_further_scans(raw, frame);
  }
  add_images(raw, frame);
  if (!cameras.empty() && frame.missing_images.size() == cameras.size()) {
    return frame_without_images(frame);
  }
  return frame;
}

void LiveDecoder::add_further_scans(const RawFrame& raw, Frame& frame) const {
  for (std::size_t k = 0; k < further_lidars.size(); ++k) {
    const LiveLidar& further = further_lidars[k];
    const auto& measured = raw.further_scans[k];
    if (!measured) {
      frame.missing_scans.push_back(
          {further.name, SkipReason::kMissingScan, fmt::format("no scan for frame {}", raw.index)});
      continue;
    }
    try {
      LidarScan scan = usable_points(measured->points, further.format, measured->stamp,
                                     name_of(further, measured->stamp));
      frame.dropped_points += scan.dropped;
      frame.dropped_points += measured->dropped;
      set_point_times(scan.points, further.sweep_compensated, further.sweep);
      append_scan(frame.scan, std::move(scan.points), static_cast<std::uint16_t>(k + 1),
                  further.T_lidar_sensor, seconds(measured->stamp - frame.stamp));
    } catch (const InputError& error) {
      frame.missing_scans.push_back({further.name, SkipReason::kDamagedScan, error.what()});
    }
  }
}

void LiveDecoder::add_images(const RawFrame& raw, Frame& frame) const {
  const std::size_t count = cameras.size();
  std::vector<std::optional<MissingImage>> missing(count);
  frame.images.resize(count);
  parallel_for(count, 1, [&](std::size_t k) { missing[k] = load(k, raw, frame.images[k]); });
  for (std::size_t k = 0; k < count; ++k) {
    if (missing[k]) frame.missing_images.push_back(std::move(*missing[k]));
    frame.image_offsets.push_back(image_offset(k, raw));
    frame.image_exposures.push_back(image_exposure(k, raw));
  }
}

std::optional<MissingImage> LiveDecoder::load(std::size_t camera, const RawFrame& raw,
                                              Image& image) const {
  const LiveCamera& of = cameras[camera];
  const auto& taken = raw.images[camera];
  if (!taken) {
    return MissingImage{of.camera.index, SkipReason::kMissingImage,
                        fmt::format("no image {} of camera {}", raw.index, of.camera.index)};
  }
  const std::string image_name = fmt::format("{}, image of camera {} of {:.3f} s", name.string(),
                                             of.name, seconds(taken->stamp));
  return load_image(
      of.camera, of.rectifier ? &*of.rectifier : nullptr, image_name,
      [&] { return pixels_of(*taken, image_name); }, image);
}

double LiveDecoder::image_offset(std::size_t camera, const RawFrame& raw) const {
  const auto& taken = raw.images[camera];
  const LiveCamera& of = cameras[camera];
  if (!taken) return 0;
  return seconds(taken->stamp - raw.stamp) - of.usual_delay;
}

std::optional<double> LiveDecoder::image_exposure(std::size_t camera, const RawFrame& raw) {
  const auto& taken = raw.images[camera];
  if (!taken || !taken->exposure) return std::nullopt;
  const double exposure = std::log2(*taken->exposure);
  return std::isfinite(exposure) ? std::optional(exposure) : std::nullopt;
}

}  // namespace fovea
