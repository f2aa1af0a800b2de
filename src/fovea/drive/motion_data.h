// Motion that sensors other than the LiDAR measured.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fovea/geometry/geodesy.h"
#include "fovea/geometry/imu_data.h"
#include "fovea/trajectory.h"

namespace fovea {

/// Where the frame `local` of navigation lies.
struct NavigationOrigin {
  std::optional<GeodeticPoint> point;    ///< of positions; local is east-north-up there
  CoordinateReference coordinates;       ///< of `point`
  std::optional<Eigen::Vector3d> world;  ///< of poses: in their world, whose axes local has
};

/// Measurements in strictly increasing time.
struct MotionData {
  std::vector<StampedPose> poses;  ///< T_local_lidar by navigation
  std::vector<double> accuracy;    ///< of each pose, see DriveInfo::navigation_accuracy
  std::vector<ImuSample> imu;
  std::vector<WheelSpeed> wheels;
  /// Navigation of the drive begins with these poses, after the first frames.
  std::optional<NavigationOrigin> begins;
};

}  // namespace fovea
