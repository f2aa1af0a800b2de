#include "fovea/pipeline/motion_history.h"

namespace fovea {
namespace {

constexpr TimeNs kKept = 60 * kNsPerSecond;

/// Appends samples, and drops those before the last minute.
template <class Sample>
void extend(std::vector<Sample>& samples, const std::vector<Sample>& more) {
  if (more.empty()) return;
  samples.insert(samples.end(), more.begin(), more.end());
  const TimeNs begin = samples.back().time - kKept;
  std::erase_if(samples, [&](const Sample& sample) { return sample.time < begin; });
}

}  // namespace

MotionHistory::MotionHistory(const DriveInfo& drive)
    : navigation_(drive.navigation),
      accuracy_(drive.navigation_accuracy),
      imu_(drive.imu),
      wheels_(drive.wheels) {
  if (!navigation_ && drive.kind == kLiveDrive) navigation_.emplace();
}

void MotionHistory::add(const MotionData& data) {
  if (navigation_ && !data.poses.empty()) {
    navigation_->extend(data.poses);
    accuracy_.insert(accuracy_.end(), data.accuracy.begin(), data.accuracy.end());
    const std::size_t dropped = navigation_->drop_before(data.poses.back().time - kKept);
    accuracy_.erase(accuracy_.begin(), accuracy_.begin() + std::ptrdiff_t(dropped));
  }
  if (imu_) extend(imu_->samples, data.imu);
  if (wheels_) extend(wheels_->samples, data.wheels);
}

}  // namespace fovea
