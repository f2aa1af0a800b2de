// From positions on earth to poses of the LiDAR.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fovea/drive/kitti/oxts.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/time.h"
#include "fovea/trajectory.h"

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
  /// Standard deviation of a coordinate (m); 0: not stated, infinite: without a fix.
  double accuracy = 0;
  std::optional<Twist> velocity = {};  ///< per second, in the body's frame, where it was measured
};

struct Navigation {
  Trajectory trajectory;  ///< T_local_lidar; local = east-north-up axes at `origin`
  /// Where the LiDAR was at the time asked for; absent if no position has a fix.
  std::optional<GeodeticPoint> origin;
  /// Standard deviation of a coordinate (m) of each pose of the trajectory, see DriveInfo.
  std::vector<double> accuracy;
};

/// Poses of the LiDAR at the given times, and between them by interpolation, relative to where it
/// was at `origin_time` (at the first pose, where they do not reach that time).
/// The origin is absent if no pose has a fix.
/// @param poses  at least one, in strictly increasing time; std::invalid_argument otherwise
Navigation navigation_of(const std::vector<GeodeticPose>& poses, const RigidMotion& T_body_lidar,
                         TimeNs origin_time);

/// Where the LiDAR was at a time; at the first pose, where they do not reach that time.
/// @param poses  as navigation_of()
GeodeticPoint lidar_position(const std::vector<GeodeticPose>& poses,
                             const RigidMotion& T_body_lidar, TimeNs time);

/// The same as navigation_of() for a given origin of `local`.
Navigation navigation_around(const GeodeticPoint& origin, const std::vector<GeodeticPose>& poses,
                             const RigidMotion& T_body_lidar);

/// For each position whether the vehicle cannot reach it from the others, such as those that a
/// receiver states before it has a fix.
std::vector<bool> far_positions(const std::vector<GeodeticPose>& poses);

/// Note on a file or folder of positions without an origin.
std::string no_fix_note(const std::filesystem::path& positions);

/// The poses of GPS/INS records: infinite accuracy where a record has no satellite.
std::vector<GeodeticPose> geodetic_poses(const std::vector<StampedOxts>& records);

/// navigation_of() of GPS/INS records.
Navigation make_navigation(const std::vector<StampedOxts>& records, const RigidMotion& T_imu_lidar,
                           TimeNs origin_time);

}  // namespace fovea
