// From positions on earth to poses of the LiDAR.
#pragma once

#include <optional>
#include <vector>

#include "fovea/base/time.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/geometry/trajectory.h"
#include "fovea/sensor/oxts.h"

namespace fovea {

struct StampedOxts {
  TimeNs time = 0;
  OxtsRecord record;
};

/// Where on earth a body was, and how it was turned.
struct GeodeticPose {
  TimeNs time = 0;
  GeodeticPoint position;
  Eigen::Matrix3d R_enu_body = Eigen::Matrix3d::Identity();  ///< to east-north-up at the position
  double accuracy = 0;                 ///< standard deviation of a coordinate (m), see DriveInfo
  std::optional<Twist> velocity = {};  ///< per second, in the body's frame, where it was measured
};

struct Navigation {
  Trajectory trajectory;  ///< T_local_lidar; local = east-north-up axes at `origin`
  GeodeticPoint origin;   ///< where the LiDAR was at the time asked for
  /// Standard deviation of a coordinate (m) of each pose of the trajectory, see DriveInfo.
  std::vector<double> accuracy;
};

/// Poses of the LiDAR at the given times, and between them by interpolation, relative to where it
/// was at `origin_time` (at the first pose, where they do not reach that time).
/// @param poses  at least one, in strictly increasing time; std::invalid_argument otherwise
Navigation navigation_of(const std::vector<GeodeticPose>& poses, const RigidMotion& T_body_lidar,
                         TimeNs origin_time);

/// The same of GPS/INS records: infinite accuracy where a record has no satellite.
Navigation make_navigation(const std::vector<StampedOxts>& records, const RigidMotion& T_imu_lidar,
                           TimeNs origin_time);

}  // namespace fovea
