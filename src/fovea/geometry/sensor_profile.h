// How one LiDAR scans: its rings, its sweep, its noise and its height.
#pragma once

#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "fovea/geometry/rigid_motion.h"

namespace fovea {

/// Direction of rotation, seen from above.
enum class SweepDirection { kClockwise, kCounterclockwise };

/// When the points of a sweep were measured, for scans whose points have no times.
///
/// The sensor turns once a period. It starts at `start_azimuth`; at the scan's stamp it has
/// completed the share `stamp_phase` of the sweep. The defaults are KITTI's: clockwise from behind,
/// so that the sensor faces forward at the stamp.
struct SweepTiming {
  double period = 0.1;  ///< s
  SweepDirection direction = SweepDirection::kClockwise;
  double start_azimuth = std::numbers::pi;  ///< rad, atan2(y, x) in the LiDAR frame
  double stamp_phase = 0.5;                 ///< 0: stamped at the start of the sweep; 1: at its end

  /// From the stamp to the start, the middle and the end of the sweep (s).
  double start_time() const { return -stamp_phase * period; }
  double middle_time() const { return (0.5 - stamp_phase) * period; }
  double end_time() const { return (1 - stamp_phase) * period; }

  bool operator==(const SweepTiming&) const = default;
};

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
