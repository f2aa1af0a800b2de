// The simulated LiDAR: its beams, its sweep, its errors and how it is mounted.
#pragma once

namespace fovea {

/// HDL-64E S2: 32 beams from +2 to -8.33 degrees and 32 from -8.83 to -24.33, turning clockwise.
struct LidarOptions {
  double period = 0.1034;                   ///< s a sweep, KITTI's
  int columns = 2083;                       ///< firings a sweep
  double min_range = 0.9, max_range = 120;  ///< m
  double range_noise = 0.015;               ///< m, standard deviation
  double range_resolution = 0.002;          ///< m; 0: exact
  double dropouts = 1;      ///< factor on the chance that a weak return is lost; 0: none is
  double height = 1.73;     ///< m above the road
  bool point_times = true;  ///< scans say when each point was measured, where their format can
};

/// ConfigError that names the key.
void check(const LidarOptions& lidar);

}  // namespace fovea
