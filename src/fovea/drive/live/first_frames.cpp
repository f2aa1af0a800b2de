#include "fovea/drive/live/first_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "fovea/drive/described_camera.h"

namespace fovea {
namespace {

/// Offsets and exposures of the images of a camera, and notes about its delays.
void add_images(std::span<const RawFrame> frames, const DriveDescription& description,
                std::size_t slot, LiveBeginning& beginning) {
  DriveInfo& info = beginning.info;
  const LiveDecoder& decoder = beginning.decoder;
  info.image_offsets.emplace_back();
  info.image_exposures.emplace_back();
  ImageMatches matches;
  std::vector<double> delays;
  for (const RawFrame& frame : frames) {
    if (!frame.images[slot]) continue;
    info.image_offsets[slot][frame.index] = decoder.image_offset(slot, frame);
    if (const auto exposure = LiveDecoder::image_exposure(slot, frame)) {
      info.image_exposures[slot][frame.index] = *exposure;
    }
    matches.image_of_scan[frame.index] = frame.index;
    delays.push_back(seconds(frame.images[slot]->stamp - frame.stamp));
  }
  if (!delays.empty()) {
    const auto [least, most] = std::minmax_element(delays.begin(), delays.end());
    matches.min_delay = *least;
    matches.max_delay = *most;
  }
  note_matches(description.cameras[beginning.sensors.cameras[slot]], matches, frames.size(),
               description.image_tolerance, info);
}

/// The frame whose stamp gives the origin of `local`.
const RawFrame& first_usable(std::span<const RawFrame> frames) {
  const auto has_image = [](const RawFrame& frame) {
    return frame.images.empty() || std::any_of(frame.images.begin(), frame.images.end(),
                                               [](const auto& image) { return bool(image); });
  };
  const auto found = std::find_if(frames.begin(), frames.end(), has_image);
  return found == frames.end() ? frames.front() : *found;
}

/// Notes the scans that have no pose; false if none has one.
bool covers_scans(const Trajectory& T_local_lidar, std::span<const RawFrame> frames,
                  DriveInfo& info) {
  const auto reached =
      std::size_t(std::count_if(frames.begin(), frames.end(), [&](const RawFrame& frame) {
        return T_local_lidar.at(frame.stamp).has_value();
      }));
  if (reached == frames.size()) return true;
  info.warn(
      fmt::format("poses or positions reach {} of the first {} scans{}", reached, frames.size(),
                  reached == 0 ? ", are their times of one clock? No navigation so far" : ""));
  return reached > 0;
}

class FirstFramesSource : public FrameSource {
 public:
  FirstFramesSource(DriveInfo info, std::shared_ptr<const LiveDecoder> decoder,
                    std::vector<RawFrame> frames)
      : info_(std::move(info)), decoder_(std::move(decoder)) {
    for (RawFrame& frame : frames) frames_.emplace(frame.index, std::move(frame));
  }
  const DriveInfo& info() const override { return info_; }
  LoadedFrame load(int index) const override {
    const auto found = frames_.find(index);
    if (found == frames_.end()) {
      return SkippedFrame{index, SkipReason::kMissingScan,
                          fmt::format("no scan {} in the drive", index)};
    }
    return decoder_->decode(found->second);
  }
  std::optional<TimeNs> stamp(int index) const override {
    const auto found = frames_.find(index);
    if (found == frames_.end()) return std::nullopt;
    return found->second.stamp;
  }

 private:
  DriveInfo info_;
  std::shared_ptr<const LiveDecoder> decoder_;
  std::map<int, RawFrame> frames_;
};

}  // namespace

void add_first_frames(std::span<const RawFrame> frames, const DriveDescription& description,
                      LiveMotion& motion, const LocalFrame& local, LiveBeginning& beginning) {
  DriveInfo& info = beginning.info;
  info.begin = frames.front().index;
  info.end = frames.back().index + 1;
  info.frames = {};
  for (const RawFrame& frame : frames) info.frames.push_back(frame.index);
  for (std::size_t slot = 0; slot < beginning.sensors.cameras.size(); ++slot) {
    add_images(frames, description, slot, beginning);
  }
  LocalFrame frame = local;
  frame.time = first_usable(frames).stamp;
  FirstMotion first = motion.begin(frame, frames.back().stamp + sweep_end(beginning.decoder));
  info.append(first);
  if (first.navigation && !covers_scans(*first.navigation, frames, info)) {
    motion.navigation().postpone("poses or positions reach none of the first scans");
  } else if (first.navigation) {
    info.calibration.T_imu_lidar = description.T_body_lidar;
    info.navigation = std::move(first.navigation);
    info.navigation_accuracy = std::move(first.accuracy);
    info.origin = first.origin;
    info.coordinates = description.coordinates;
  }
  info.imu = std::move(first.imu);
  info.wheels = std::move(first.wheels);
}

TimeNs sweep_end(const LiveDecoder& decoder) {
  return from_seconds(decoder.lidar.sweep_middle + decoder.lidar.sweep.period / 2);
}

std::unique_ptr<FrameSource> first_frames_source(DriveInfo info,
                                                 std::shared_ptr<const LiveDecoder> decoder,
                                                 std::vector<RawFrame> frames) {
  return std::make_unique<FirstFramesSource>(std::move(info), std::move(decoder),
                                             std::move(frames));
}

}  // namespace fovea
