#include "fovea/rendering/virtual_lidar.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "fovea/base/angle.h"
#include "fovea/base/parallel.h"

namespace fovea {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr std::size_t kDiscsPerTask = 16384;
/// A beam that meets a disc at less than this (sine) is as good as parallel to it.
constexpr float kGrazing = 0.03f;
/// Discs this far behind the first one are of the same surface, m.
constexpr float kSurface = 0.05f;

struct Hit {
  std::uint32_t beam, disc;
  float range;   // m
  float weight;  // 1 at the disc's middle, 0 at its rim
};

/// The beams of a pattern, by number: ring * columns + column.
class Beams {
 public:
  explicit Beams(const LidarPattern& pattern) : pattern_(pattern) {}

  std::size_t size() const { return pattern_.elevation.size() * std::size_t(pattern_.columns); }

  Eigen::Vector3f direction(std::uint32_t beam) const {
    const double elevation = pattern_.elevation[beam / std::uint32_t(pattern_.columns)];
    const double azimuth = azimuth_of(int(beam % std::uint32_t(pattern_.columns)));
    return Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                           std::cos(elevation) * std::sin(azimuth), std::sin(elevation))
        .cast<float>();
  }

  /// Calls f(beam) for the beams within an angle of a point's direction.
  template <class F>
  void for_each_near(const Eigen::Vector3f& p, float range, double angle, F&& f) const {
    const double elevation = std::asin(std::clamp(double(p.z() / range), -1.0, 1.0));
    const auto& rings = pattern_.elevation;
    const auto first =
        std::lower_bound(rings.begin(), rings.end(), elevation + angle, std::greater<double>());
    if (first == rings.end() || *first < elevation - angle) return;
    const double azimuth = std::atan2(p.y(), p.x());
    for (auto ring = first; ring != rings.end() && *ring >= elevation - angle; ++ring) {
      const double spread = angle / std::max(0.05, std::cos(*ring));
      const int begin = int(std::ceil(column_of(azimuth + spread)));
      const int end = int(std::floor(column_of(azimuth - spread)));
      const auto row = std::uint32_t(ring - rings.begin()) * std::uint32_t(pattern_.columns);
      for (int c = begin; c <= std::min(end, begin + pattern_.columns - 1); ++c) {
        f(row + std::uint32_t((c % pattern_.columns + pattern_.columns) % pattern_.columns));
      }
    }
  }

 private:
  double azimuth_of(int column) const {
    return std::numbers::pi - kTurn * (column + 0.5) / pattern_.columns;
  }
  double column_of(double azimuth) const {
    return (std::numbers::pi - azimuth) / kTurn * pattern_.columns - 0.5;
  }

  const LidarPattern& pattern_;
};

/// Where a beam meets a disc, if it does.
/// @param p, n  the disc's middle and normal, LiDAR frame
bool meet(const Eigen::Vector3f& beam, const Eigen::Vector3f& p, const Eigen::Vector3f& n,
          float radius, Hit& hit) {
  const float facing = n.dot(beam);
  hit.range = std::abs(facing) > kGrazing ? n.dot(p) / facing : p.dot(beam);
  const float squared = (hit.range * beam - p).squaredNorm() / (radius * radius);
  hit.weight = 1 - squared;
  return hit.weight > 0;
}

std::vector<Hit> find_hits(const MapSurfels& map, const RigidMotion& T_local_lidar,
                           const LidarPattern& pattern, const Beams& beams) {
  const Eigen::Isometry3f T_lidar_map =
      (T_local_lidar.inverse() * Eigen::Translation3d(map.origin)).cast<float>();
  std::vector<std::vector<Hit>> chunks((map.size() + kDiscsPerTask - 1) / kDiscsPerTask);
  parallel_chunks(map.size(), kDiscsPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<Hit>& hits = chunks[begin / kDiscsPerTask];
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f p = T_lidar_map * map.position[i];
      const float range = p.norm(), radius = map.spacing[i];
      if (!(range >= float(pattern.min_range) && range <= float(pattern.max_range))) continue;
      const Eigen::Vector3f n = T_lidar_map.linear() * map.normal[i];
      const double angle = std::asin(std::min(1.0, double(radius / range)));
      beams.for_each_near(p, range, angle, [&](std::uint32_t beam) {
        Hit hit{beam, std::uint32_t(i), 0, 0};
        if (meet(beams.direction(beam), p, n, radius, hit)) hits.push_back(hit);
      });
    }
  });
  std::vector<Hit> all;
  for (const std::vector<Hit>& hits : chunks) all.insert(all.end(), hits.begin(), hits.end());
  return all;
}

}  // namespace

LidarPattern hdl64() {
  LidarPattern pattern;
  for (int i = 0; i < 32; ++i) pattern.elevation.push_back((2 - i / 3.0) * kDegree);
  for (int i = 0; i < 32; ++i) pattern.elevation.push_back((-8.83 - i / 2.0) * kDegree);
  pattern.columns = 2083;
  pattern.min_range = 0.9;
  pattern.max_range = 120;
  return pattern;
}

PointCloud cast_lidar(const MapSurfels& map, const RigidMotion& T_local_lidar,
                      const LidarPattern& pattern) {
  const Beams beams(pattern);
  const std::vector<Hit> hits = find_hits(map, T_local_lidar, pattern, beams);
  struct Mean {
    float front = std::numeric_limits<float>::infinity();
    double weight = 0, range = 0, intensity = 0;
  };
  std::vector<Mean> means(beams.size());
  for (const Hit& hit : hits) {
    means[hit.beam].front = std::min(means[hit.beam].front, hit.range);
  }
  for (const Hit& hit : hits) {
    Mean& mean = means[hit.beam];
    if (hit.range > mean.front + kSurface) continue;
    mean.weight += hit.weight;
    mean.range += double{hit.weight} * hit.range;
    mean.intensity += double{hit.weight} * map.intensity[hit.disc];
  }
  PointCloud scan_lidar;
  for (std::uint32_t beam = 0; beam < means.size(); ++beam) {
    const Mean& mean = means[beam];
    if (!(mean.weight > 0)) continue;
    scan_lidar.position.push_back(beams.direction(beam) * float(mean.range / mean.weight));
    scan_lidar.intensity.push_back(float(mean.intensity / mean.weight));
  }
  return scan_lidar;
}

}  // namespace fovea
