#include "fovea/rendering/virtual_lidar.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/core/parallel.h"
#include "fovea/rendering/lidar_beams.h"

namespace fovea {
namespace {

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
                           const LidarPattern& pattern, const LidarBeams& beams) {
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

LidarPattern lidar_pattern(LidarModel model) {
  const LidarDataSheet& sheet = lidar_data_sheet(model);
  return {.elevation = sheet.elevations,
          .rosette = sheet.rosette,
          .columns = static_cast<int>(std::lround(sheet.firing_rate * sheet.period)),
          .period = sheet.period,
          .min_range = sheet.min_range,
          .max_range = sheet.max_range};
}

PointCloud cast_lidar(const MapSurfels& map, const RigidMotion& T_local_lidar,
                      const LidarPattern& pattern, double time) {
  const LidarBeams beams(pattern, time);
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
