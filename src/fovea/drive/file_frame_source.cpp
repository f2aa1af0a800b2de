// FrameSource over numbered files: checks that a frame has its parts, then reads them.
#include <fmt/format.h>

#include <set>

#include "fovea/core/parallel.h"
#include "fovea/drive/drive_files.h"
#include "fovea/drive/frame_parts.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/drive/lost_drive.h"
#include "fovea/drive/scans/lidar_scan.h"
#include "fovea/drive/scans/sensor_scans.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

class FileFrameSource : public FrameSource {
 public:
  FileFrameSource(DriveInfo info, DriveFiles files)
      : info_(std::move(info)), files_(std::move(files)) {}

  const DriveInfo& info() const override { return info_; }

  std::optional<TimeNs> stamp(int index) const override {
    return frame_stamp(info_, files_.stamps, index);
  }

  LoadedFrame load(int index) const override {
    if (const auto missing = missing_part(index)) return *missing;
    Frame frame;
    frame.index = index;
    frame.stamp = *stamp(index);
    try {
      LidarScan scan = read_lidar_scan(files_.scans.at(index), files_.scan_format, frame.stamp);
      frame.scan = std::move(scan.points);
      frame.dropped_points = scan.dropped;
      if (info_.sweep_compensated) frame.scan.time.clear();
      if (!files_.further_lidars.empty()) {
        set_point_times(frame.scan, files_.first_lidar_compensated, info_.sweep);
        frame.scan.sensor.assign(frame.scan.size(), 0);
      }
    } catch (const InputError& error) {
      require_drive(files_.scans, index, info_.path);
      return SkippedFrame{index, SkipReason::kDamagedScan, error.what()};
    }
    add_further_scans(frame);
    read_images(frame);
    const std::size_t cameras = files_.images.size();
    if (cameras > 0 && frame.missing_images.size() == cameras) return frame_without_images(frame);
    return frame;
  }

  void expect(int index) const override {
    const auto expect_of = [&](const NumberedFiles& files) {
      if (const auto file = files.find(index); file != files.end()) expect_file(file->second);
    };
    expect_of(files_.scans);
    for (const FurtherLidar& lidar : files_.further_lidars) expect_of(lidar.scans);
    for (const NumberedFiles& images : files_.images) expect_of(images);
  }

 private:
  /// What can be known to be missing without reading the scan or an image.
  std::optional<SkippedFrame> missing_part(int index) const {
    const auto skip = [&](SkipReason reason, std::string detail) {
      return SkippedFrame{index, reason, std::move(detail)};
    };
    if (!files_.scans.contains(index)) {
      return skip(SkipReason::kMissingScan, fmt::format("no scan {} in the drive", index));
    }
    if (!stamp(index)) return skip(SkipReason::kMissingStamp, why_no_stamp(index));
    return std::nullopt;
  }

  std::string why_no_stamp(int index) const {
    const std::string place = files_.stamps_name_scans ? fmt::format("of scan {}", index)
                                                       : fmt::format("in line {}", index + 1);
    const auto listed = [&](const std::vector<int>& lines) {
      return std::binary_search(lines.begin(), lines.end(), index);
    };
    if (listed(files_.stamps.out_of_order)) {
      return fmt::format("the time stamp {} is out of order", place);
    }
    if (listed(files_.stamps.malformed)) {
      return fmt::format("the time stamp {} is malformed", place);
    }
    return fmt::format("no time stamp {}", place);
  }

  void add_further_scans(Frame& frame) const {
    for (std::size_t k = 0; k < files_.further_lidars.size(); ++k) {
      const FurtherLidar& lidar = files_.further_lidars[k];
      const auto file = lidar.scans.find(frame.index);
      if (file == lidar.scans.end()) {
        frame.missing_scans.push_back({lidar.name, SkipReason::kMissingScan,
                                       fmt::format("no scan for frame {}", frame.index)});
        continue;
      }
      const auto found = lidar.stamps.find(frame.index);
      const TimeNs stamp = found == lidar.stamps.end() ? frame.stamp : found->second;
      try {
        LidarScan scan = read_lidar_scan(file->second, lidar.format, stamp);
        frame.dropped_points += scan.dropped;
        set_point_times(scan.points, lidar.sweep_compensated, lidar.sweep);
        append_scan(frame.scan, std::move(scan.points), static_cast<std::uint16_t>(k + 1),
                    lidar.T_lidar_sensor, seconds(stamp - frame.stamp));
      } catch (const InputError& error) {
        require_drive(lidar.scans, frame.index, info_.path);
        frame.missing_scans.push_back({lidar.name, SkipReason::kDamagedScan, error.what()});
      }
    }
  }

  /// Decodes the images of all cameras at once; those that cannot be used stay empty.
  void read_images(Frame& frame) const {
    const std::size_t count = files_.images.size();
    std::vector<std::optional<MissingImage>> missing(count);
    frame.images.resize(count);
    parallel_for(count, 1, [&](std::size_t k) {
      missing[k] = read_image_of(k, frame.index, frame.images[k]);
    });
    for (std::optional<MissingImage>& image : missing) {
      if (image) frame.missing_images.push_back(std::move(*image));
    }
    for (std::size_t k = 0; k < count; ++k) {
      frame.image_offsets.push_back(info_.image_offset(k, frame.index));
      frame.image_exposures.push_back(
          info_.image_exposure(info_.calibration.cameras[k].index, frame.index));
    }
  }

  /// Reads one camera's image; why it stays empty, if it does.
  std::optional<MissingImage> read_image_of(std::size_t k, int index, Image& image) const {
    const Camera& camera = info_.calibration.cameras[k];
    const auto file = files_.images[k].find(index);
    if (file == files_.images[k].end()) {
      return MissingImage{camera.index, SkipReason::kMissingImage,
                          fmt::format("no image {} of camera {}", index, camera.index)};
    }
    const auto read = [&] {
      try {
        return read_image(file->second);
      } catch (const InputError&) {
        require_drive(files_.images[k], index, info_.path);
        throw;
      }
    };
    return load_image(camera, rectifier_of(k), file->second.string(), read, image);
  }

  /// Null where the images of the k-th camera are rectified already.
  const ImageRectifier* rectifier_of(std::size_t k) const {
    return k < files_.rectifiers.size() && files_.rectifiers[k] ? &*files_.rectifiers[k] : nullptr;
  }

  DriveInfo info_;
  DriveFiles files_;
};

/// The frames of the range of which the drive has anything. Numbers may have gaps of any length.
std::vector<int> present_frames(const DriveInfo& info, const DriveFiles& files) {
  std::set<int> present;
  const auto add = [&](int index) {
    if (index >= info.begin && index < info.end) present.insert(index);
  };
  for (const auto& [index, file] : files.scans) add(index);
  for (const NumberedFiles& images : files.images) {
    for (const auto& [index, file] : images) add(index);
  }
  for (std::size_t i = 0; info.has_time_stamps && i < files.stamps.times.size(); ++i) {
    if (files.stamps.times[i]) add(static_cast<int>(i));
  }
  return {present.begin(), present.end()};
}

/// Notes scans whose names are no number of a frame, or a number that another scan has.
void note_scans_left_out(const NumberedFiles& scans, DriveInfo& info) {
  const std::vector<std::filesystem::path> others = files_left_out(scans);
  if (others.empty()) return;
  info.warn(fmt::format(
      "{} scan{} left out: the name is no number below {}, or a number that another "
      "scan has (the first: {})",
      others.size(), others.size() == 1 ? " is" : "s are", kEndOfNames, others.front().string()));
}

}  // namespace

std::unique_ptr<FrameSource> make_frame_source(DriveInfo info, DriveFiles files) {
  info.frames = present_frames(info, files);
  note_scans_left_out(files.scans, info);
  return std::make_unique<FileFrameSource>(std::move(info), std::move(files));
}

}  // namespace fovea
