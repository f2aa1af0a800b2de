// Rings of a LiDAR in its scans.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/base/point_cloud.h"

namespace fovea {

/// Direction and range of a point.
struct LidarDirection {
  double azimuth, elevation, range;  // rad, m
};

/// Points of one ring, by azimuth.
using LidarRing = std::vector<LidarDirection>;

/// A scan in the order of its file, without the points on the vehicle itself.
struct LidarSweep {
  std::vector<LidarDirection> directions;
  std::vector<std::uint16_t> ring;  ///< numbers of rings; empty if the scan does not state them
};

/// Scans of too few points to find rings in are left out.
std::vector<LidarSweep> sweeps_of(std::span<const PointCloud> scans);

/// Rings of one sweep, highest first. Empty if there are none (see estimate_sensor_profile).
std::vector<LidarRing> find_rings(const std::vector<LidarSweep>& sweeps);

/// Median elevation of a ring, rad.
double elevation_of(const LidarRing& ring);

}  // namespace fovea
