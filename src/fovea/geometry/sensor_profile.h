// How one LiDAR scans: its rings, its sweep, its noise and its height.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fovea/sweep_motion.h"

namespace fovea {

/// A LiDAR of a drive. Every constant that depends on the sensor is derived from it.
struct SensorProfile {
  std::string name = "lidar";
  /// Elevations of the rings (rad), highest first; empty for a pattern without rings (Livox).
  std::vector<double> ring_elevations;
  double ring_spacing = 0;   ///< rad, across: median angle between neighboring rings
  double point_spacing = 0;  ///< rad, along: median angle between neighboring points of a ring
  SweepTiming sweep;
  double range_noise = 0.02;     ///< m, standard deviation
  std::optional<double> height;  ///< m above the ground; absent where no ground is in view

  bool operator==(const SensorProfile&) const = default;
};

/// LiDARs of one vehicle.
inline constexpr std::size_t kMaxLidars = 16;

/// A LiDAR on a vehicle.
struct MountedLidar {
  SensorProfile profile;
  /// The frame `lidar` of a drive is that of its first LiDAR.
  RigidMotion T_lidar_sensor = RigidMotion::Identity();
};

/// Height of a LiDAR on the roof of a car (m), for profiles that do not know theirs.
inline constexpr double kUsualSensorHeight = 1.73;

/// Angle between the two rings around an elevation (rad); between the outermost two beyond them.
double ring_spacing_at(const SensorProfile& profile, double elevation);

/// Elevation of a ray that meets flat ground at a range (m from the sensor's foot), rad.
double elevation_on_ground(const SensorProfile& profile, double range);

/// How far apart two neighboring rings meet flat ground at a range (m from the sensor's foot).
double ring_gap_on_ground(const SensorProfile& profile, double range);

}  // namespace fovea
