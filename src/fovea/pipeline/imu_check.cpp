#include "fovea/pipeline/imu_check.h"

namespace fovea {

void ImuCheck::add(const FrameRecord& record) {
  if (poses_.size() == kFrames || record.status == FrameStatus::kSkipped || !record.stamp) return;
  if (record.has("pose_unknown") || record.has("registration_lost")) return;
  const bool is_firm = !record.has("registration_failed") && !record.has("registration_degenerate");
  poses_.push_back({record.index, *record.stamp, record.T_odom_lidar,
                    record.motion.value_or(SweepMotion{}), is_firm});
}

ImuHandEye ImuCheck::estimate(const ImuData& imu) const {
  return estimate_imu_hand_eye(turns_of(poses_), imu.samples, imu.T_lidar_imu.linear());
}

}  // namespace fovea
