// Rings of a LiDAR in its scans.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/point_cloud.h"

namespace fovea {

/// Direction and range of a point.
struct LidarDirection {
  double azimuth, elevation, range;  // rad, m
};

/// Points of one ring, by azimuth.
using LidarRing = std::vector<LidarDirection>;

/// A scan in the order of its file, without points on the vehicle.
struct LidarSweep {
  std::vector<LidarDirection> directions;
  std::vector<std::uint16_t> ring;  ///< ring numbers; empty if the scan has none
};

/// Skips scans with too few points for rings.
std::vector<LidarSweep> sweeps_of(std::span<const PointCloud> scans);

/// Rings of one sweep from top to bottom. Empty if there are none (see estimate_sensor_profile).
std::vector<LidarRing> find_rings(const std::vector<LidarSweep>& sweeps);

/// Median elevation of a ring, rad.
double elevation_of(const LidarRing& ring);

}  // namespace fovea
