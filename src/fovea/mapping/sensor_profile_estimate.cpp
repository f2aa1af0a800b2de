#include "fovea/mapping/sensor_profile_estimate.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "fovea/core/angle.h"
#include "fovea/core/median.h"
#include "fovea/ground.h"
#include "fovea/mapping/lidar_rings.h"

namespace fovea {
namespace {

/// Median angle between consecutive points of a ring.
double spacing_along(const std::vector<LidarRing>& rings) {
  constexpr double kSame = 1e-4;  // rad: multiple returns of one beam
  constexpr double kGap = 3 * kDegree;
  std::vector<double> steps;
  for (const LidarRing& ring : rings) {
    for (std::size_t i = 1; i < ring.size(); ++i) {
      const double step = ring[i].azimuth - ring[i - 1].azimuth;
      if (step > kSame && step < kGap) steps.push_back(step);
    }
  }
  return median_of(std::move(steps));
}

/// Standard deviation of a range from the mean of its neighbors on the ring, which is on the
/// surface if that is smooth. Empty if there are too few comparisons.
std::optional<double> range_noise_of(const std::vector<LidarRing>& rings, double spacing) {
  constexpr std::size_t kLeastDifferences = 200;
  constexpr double kStep = 0.3;                // m: more is an edge of depth
  constexpr double kToDeviation = 1 / 0.6745;  // median of a normal variable's magnitude
  std::vector<double> differences;
  for (const LidarRing& ring : rings) {
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
      const double before = ring[i].azimuth - ring[i - 1].azimuth,
                   after = ring[i + 1].azimuth - ring[i].azimuth;
      if (std::max(before, after) > 1.5 * spacing || std::min(before, after) < 0.5 * spacing) {
        continue;
      }
      const double difference = ring[i].range - (ring[i - 1].range + ring[i + 1].range) / 2;
      if (std::abs(difference) < kStep) differences.push_back(std::abs(difference));
    }
  }
  if (differences.size() < kLeastDifferences) return std::nullopt;
  return median_of(std::move(differences)) * kToDeviation / std::sqrt(1.5);
}

/// Mean angle between neighboring points of a scan without rings.
double spacing_without_rings(const LidarSweep& sweep) {
  constexpr double kCell = 1 * kDegree;
  std::set<std::pair<int, int>> cells;
  double solid_angle = 0;
  for (const LidarDirection& d : sweep.directions) {
    const auto row = int(std::floor(d.elevation / kCell));
    const double width = kCell / std::max(0.1, std::cos(row * kCell));
    if (cells.emplace(row, int(std::floor(d.azimuth / width))).second) solid_angle += kCell * kCell;
  }
  return std::sqrt(solid_angle / double(sweep.directions.size()));
}

/// Height above the ground of an upright or inverted LiDAR, from the first scan with visible
/// ground.
std::optional<double> height_of(std::span<const PointCloud> scans) {
  for (const PointCloud& scan : scans) {
    if (const auto height = sensor_height(scan.position)) return height;
    std::vector<Eigen::Vector3f> turned = scan.position;
    for (Eigen::Vector3f& p : turned) p = {p.x(), -p.y(), -p.z()};
    if (const auto height = sensor_height(turned)) return height;
  }
  return std::nullopt;
}

}  // namespace

SensorProfile estimate_sensor_profile(std::span<const PointCloud> scans,
                                      const SensorProfile& stated) {
  SensorProfile profile = stated;
  const std::vector<LidarSweep> sweeps = sweeps_of(scans);
  if (sweeps.empty()) return profile;
  if (!profile.height) profile.height = height_of(scans);
  const std::vector<LidarRing> rings = find_rings(sweeps);
  if (rings.empty()) {
    profile.ring_spacing = profile.point_spacing = spacing_without_rings(sweeps.front());
    return profile;
  }
  for (const LidarRing& ring : rings) profile.ring_elevations.push_back(elevation_of(ring));
  std::vector<double> gaps;
  for (std::size_t i = 1; i < rings.size(); ++i) {
    gaps.push_back(profile.ring_elevations[i - 1] - profile.ring_elevations[i]);
  }
  profile.ring_spacing = median_of(std::move(gaps));
  profile.point_spacing = spacing_along(rings);
  profile.range_noise = range_noise_of(rings, profile.point_spacing).value_or(profile.range_noise);
  return profile;
}

}  // namespace fovea
