// From GPS/INS records to poses of the LiDAR.
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

struct Navigation {
  Trajectory trajectory;  ///< T_local_lidar; local = east-north-up axes at `origin`
  GeodeticPoint origin;   ///< where the LiDAR was at the time asked for
  /// Standard deviation of a coordinate (m) of each pose of the trajectory, see DriveInfo.
  std::vector<double> accuracy;
};

/// Poses of the LiDAR at the records' times, and between them by interpolation, relative to where
/// it was at `origin_time` (at the first record, where the records do not reach that time).
/// @param records  at least one, in strictly increasing time; std::invalid_argument otherwise
Navigation make_navigation(const std::vector<StampedOxts>& records, const RigidMotion& T_imu_lidar,
                           TimeNs origin_time);

}  // namespace fovea
