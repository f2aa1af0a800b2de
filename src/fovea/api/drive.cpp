#include "fovea/drive.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "fovea/api/drive_content.h"
#include "fovea/errors.h"

namespace fovea {

int DriveFrame::index() const { return content_->frame.index; }
TimeNs DriveFrame::stamp() const { return content_->frame.stamp; }
const PointCloud& DriveFrame::scan() const { return content_->frame.scan; }
const std::vector<Image>& DriveFrame::images() const { return content_->frame.images; }
std::vector<std::string> DriveFrame::missing_images() const {
  std::vector<std::string> lines;
  for (const MissingImage& image : content_->frame.missing_images) {
    lines.push_back(
        fmt::format("camera {}: {}, {}", image.camera, to_string(image.reason), image.detail));
  }
  return lines;
}
std::size_t DriveFrame::points_dropped() const { return content_->frame.dropped_points.total(); }

const Frame& frame_of(const Drive& drive, const DriveFrame& frame) {
  if (frame.content().drive != drive.content()) {
    throw std::invalid_argument("the frame is of another drive");
  }
  return frame.content().frame;
}

Drive::Drive(const std::filesystem::path& folder, const DriveOptions& options)
    : content_(std::make_shared<const Content>(Content{open_drive(folder, options), folder})) {}

const std::filesystem::path& Drive::folder() const { return content_->source->info().path; }
const std::string& Drive::kind() const { return content_->source->info().kind; }
std::vector<int> Drive::frames() const { return content_->source->info().frame_indices(); }

DriveFrame Drive::load(int index) const {
  const DriveInfo& info = content_->source->info();
  if (index < info.begin || index >= info.end) {
    throw std::out_of_range(fmt::format("the drive has no frame {}", index));
  }
  LoadedFrame loaded = content_->source->load(index);
  if (const auto* skipped = std::get_if<SkippedFrame>(&loaded)) {
    throw InputError(fmt::format("frame {} is skipped: {}", index, to_string(skipped->reason)),
                     skipped->detail, "go on with the next one");
  }
  return DriveFrame(std::make_shared<const DriveFrame::Content>(
      DriveFrame::Content{content_, std::get<Frame>(std::move(loaded))}));
}

std::optional<DriveFrame> Drive::try_load(int index) const {
  try {
    return load(index);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

const std::vector<Camera>& Drive::cameras() const {
  return content_->source->info().calibration.cameras;
}
SweepTiming Drive::sweep() const { return content_->source->info().sweep; }
bool Drive::is_compensated() const { return content_->source->info().sweep_compensated; }
const std::optional<Trajectory>& Drive::navigation() const {
  return content_->source->info().navigation;
}
const std::optional<RigidMotion>& Drive::T_body_lidar() const {
  return content_->source->info().calibration.T_imu_lidar;
}
const std::vector<std::string>& Drive::warnings() const {
  return content_->source->info().warnings;
}
const std::vector<std::string>& Drive::notes() const { return content_->source->info().notes; }

}  // namespace fovea
