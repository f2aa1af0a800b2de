#include "fovea/pipeline/frame_motion.h"

#include <cmath>

namespace fovea {
namespace {

/// Longer steps between poses contain a pause, s.
constexpr double kLongestStep = 1;

std::optional<FrameMotion> between(const RigidMotion& here, TimeNs stamp, const RigidMotion& other,
                                   TimeNs other_stamp) {
  const double elapsed = seconds(other_stamp - stamp);
  if (elapsed == 0 || std::abs(elapsed) > kLongestStep) return std::nullopt;
  return FrameMotion{here, {velocity_between(here, other, elapsed)}};
}

}  // namespace

std::optional<FrameMotion> known_motion(const FrameSource& source,
                                        const std::vector<RigidMotion>& given_poses, int index) {
  const DriveInfo& drive = source.info();
  const auto stamp = source.stamp(index);
  if (!stamp) return std::nullopt;
  if (drive.navigation) {
    const auto pose = drive.navigation->at(*stamp);
    const auto motion =
        drive.navigation->motion(*stamp, *stamp + from_seconds(drive.sweep.end_time()));
    if (!pose || !motion) return std::nullopt;
    return FrameMotion{*pose, *motion};
  }
  const int other = index > drive.begin ? index - 1 : index + 1;
  const auto poses_end = drive.begin + static_cast<int>(given_poses.size());
  if (other >= std::min(poses_end, drive.end) || index >= poses_end) return std::nullopt;
  const auto other_stamp = source.stamp(other);
  if (!other_stamp) return std::nullopt;
  return between(given_poses.at(std::size_t(index - drive.begin)), *stamp,
                 given_poses.at(std::size_t(other - drive.begin)), *other_stamp);
}

std::optional<FrameMotion> mapped_motion(const FrameRecord& record,
                                         const std::optional<FrameRecord>& before) {
  if (record.motion) return FrameMotion{record.T_local_lidar, *record.motion};
  if (!before || before->status == FrameStatus::kSkipped) return std::nullopt;
  return between(record.T_local_lidar, *record.stamp, before->T_local_lidar, *before->stamp);
}

}  // namespace fovea
