// The simulated LiDAR: its beams, its sweep, its errors and how it is mounted.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fovea/geometry/lidar_data_sheet.h"
#include "fovea/geometry/sensor_profile.h"

namespace fovea {

/// Defaults are those of KITTI's HDL-64E S2.
struct LidarOptions {
  LidarModel model = LidarModel::kHdl64;
  /// Elevations of the rings (rad), highest first; empty: those of the model.
  std::vector<double> elevations;
  double period = 0.1034;                   ///< s a sweep, KITTI's
  int columns = 2083;                       ///< firings a sweep; 0: by the model's firing rate
  double min_range = 0.9, max_range = 120;  ///< m
  double range_noise = 0.015;               ///< m, standard deviation
  double range_resolution = 0.002;          ///< m; 0: exact
  double dropouts = 1;      ///< factor on the chance that a weak return is lost; 0: none is
  double height = 1.73;     ///< m above the road
  bool point_times = true;  ///< scans say when each point was measured, where their format can
  /// rad: Rz(yaw) Ry(pitch) Rx(roll) turns the LiDAR against the vehicle, about its own origin.
  double roll = 0, pitch = 0, yaw = 0;
  /// When each azimuth is measured, in the LiDAR's own frame: see SweepTiming.
  SweepDirection direction = SweepTiming().direction;
  double start_azimuth = SweepTiming().start_azimuth;  ///< rad
  double stamp_phase = SweepTiming().stamp_phase;      ///< 0: start of the sweep; 1: its end
};

/// A further LiDAR. It scans once a frame.
struct FurtherLidarOptions {
  LidarOptions lidar;
  double forward = 0, left = 0;  ///< m, from the first LiDAR
  double stamp_offset = 0;       ///< s, from the stamp of the first LiDAR's scan to that of its own
};

/// Makes the LiDAR one of another model: rings, period, firings, ranges. Its noise and resolution
/// are those of the data sheet, scaled as `lidar` scales those of its own model (0 stays 0).
void set_model(LidarOptions& lidar, LidarModel model);

/// Elevations of the rings (rad), highest first.
const std::vector<double>& ring_elevations(const LidarOptions& lidar);
/// Firings a sweep.
int sweep_columns(const LidarOptions& lidar);

/// The timing of its sweeps.
SweepTiming sweep_timing_of(const LidarOptions& lidar);
/// Whether the sweeps turn and are stamped as KITTI's, at any period.
bool has_kittis_sweep(const LidarOptions& lidar);
/// Time from the stamp to the middle of the sweep (s).
double sweep_middle(const LidarOptions& lidar);

/// Table of a LiDAR's keys: "lidar", "lidar_2", ...
std::string lidar_table(std::size_t number);
/// ConfigError that names the key.
void check(const LidarOptions& lidar, const std::string& table = lidar_table(0));
void check(const std::vector<FurtherLidarOptions>& lidars);
/// ConfigError for a sweep that KITTI's format cannot describe: its scans have no point times.
void check_kitti_format(const LidarOptions& lidar);

}  // namespace fovea
