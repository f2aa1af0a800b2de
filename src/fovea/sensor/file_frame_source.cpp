// FrameSource over numbered files: checks that a frame has all its parts, then reads them.
#include <fmt/format.h>

#include "fovea/base/errors.h"
#include "fovea/base/parallel.h"
#include "fovea/sensor/drive_files.h"
#include "fovea/sensor/image_decode.h"
#include "fovea/sensor/kitti_scan.h"

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

  FrameResult load(int index) const override {
    if (const auto missing = missing_part(index)) return *missing;
    Frame frame;
    frame.index = index;
    frame.stamp = *stamp(index);
    try {
      KittiScan scan = read_kitti_scan(files_.scans.at(index));
      frame.scan = std::move(scan.points);
      frame.dropped_points = scan.dropped;
    } catch (const InputError& error) {
      return SkippedFrame{index, SkipReason::kDamagedScan, error.what()};
    }
    if (const auto damaged = read_images(index, frame.images)) return *damaged;
    return frame;
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
    for (std::size_t k = 0; k < files_.images.size(); ++k) {
      if (files_.images[k].contains(index)) continue;
      return skip(SkipReason::kMissingImage, fmt::format("no image {} of camera {}", index,
                                                         info_.calibration.cameras[k].index));
    }
    return std::nullopt;
  }

  std::string why_no_stamp(int index) const {
    const auto listed = [&](const std::vector<int>& lines) {
      return std::binary_search(lines.begin(), lines.end(), index);
    };
    if (listed(files_.stamps.out_of_order)) {
      return fmt::format("time stamp of line {} is out of order", index + 1);
    }
    if (listed(files_.stamps.malformed)) {
      return fmt::format("time stamp of line {} is malformed", index + 1);
    }
    return fmt::format("no time stamp in line {}", index + 1);
  }

  /// Decodes the images of all cameras at once; the first camera's failure, if any.
  std::optional<SkippedFrame> read_images(int index, std::vector<Image>& images) const {
    const std::size_t count = files_.images.size();
    std::vector<std::string> failures(count);
    images.resize(count);
    parallel_for(count, 1, [&](std::size_t k) {
      const Camera& camera = info_.calibration.cameras[k];
      const std::filesystem::path& file = files_.images[k].at(index);
      try {
        images[k] = read_image(file);
        if (images[k].width != camera.width || images[k].height != camera.height) {
          failures[k] =
              fmt::format("the image has {} x {} pixels, its camera {} x {}, {}", images[k].width,
                          images[k].height, camera.width, camera.height, file.string());
        }
      } catch (const InputError& error) {
        failures[k] = error.what();
      }
    });
    for (std::string& failure : failures) {
      if (!failure.empty()) {
        return SkippedFrame{index, SkipReason::kDamagedImage, std::move(failure)};
      }
    }
    return std::nullopt;
  }

  DriveInfo info_;
  DriveFiles files_;
};

}  // namespace

std::unique_ptr<FrameSource> make_frame_source(DriveInfo info, DriveFiles files) {
  return std::make_unique<FileFrameSource>(std::move(info), std::move(files));
}

}  // namespace fovea
