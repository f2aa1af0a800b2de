// Motion that sensors other than the LiDAR measured.
#pragma once

#include <vector>

#include "fovea/geometry/imu_data.h"
#include "fovea/geometry/trajectory.h"

namespace fovea {

/// Measurements in strictly increasing time.
struct MotionData {
  std::vector<StampedPose> poses;  ///< T_local_lidar by navigation
  std::vector<double> accuracy;    ///< of each pose, see DriveInfo::navigation_accuracy
  std::vector<ImuSample> imu;
  std::vector<WheelSpeed> wheels;
};

}  // namespace fovea
