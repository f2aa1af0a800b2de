#include "fovea/evaluation/truth_surfaces.h"

#include <algorithm>

#include "fovea/core/parallel.h"
#include "fovea/evaluation/evaluated_set.h"
#include "fovea/geometry/kd_tree.h"
#include "fovea/geometry/voxel_grid.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 4096;
constexpr float kFootprint = 0.01f;  // m; a pixel of KITTI's cameras at 7 m
constexpr float kSeenVoxel = 0.05f;  // m

bool in_any_view(const std::vector<Camera>& cameras, const Eigen::Vector3d& p_lidar) {
  if (cameras.empty()) return true;
  return std::any_of(cameras.begin(), cameras.end(), [&](const Camera& camera) {
    return scored_pixel(camera, Eigen::Vector3d(camera.T_cam_lidar * p_lidar)).has_value();
  });
}

}  // namespace

SurfaceMatches match_surfaces(const PointCloud& points_true, const World& world,
                              const SurfaceIndex& surfaces) {
  const std::size_t count = points_true.size();
  SurfaceMatches matches{std::vector<float>(count), std::vector<Rgb>(count),
                         std::vector<std::uint8_t>(count)};
  parallel_for(count, kGrain, [&](std::size_t i) {
    const Eigen::Vector3d p = points_true.origin + points_true.position[i].cast<double>();
    const SurfacePoint nearest = surfaces.nearest(p);
    const Material& material = world.materials[world.mesh_local.material[nearest.triangle]];
    matches.distance[i] = static_cast<float>((nearest.position - p).norm());
    matches.albedo[i] = encode_srgb(albedo(material, nearest.texture, kFootprint));
    matches.matte[i] = material.gloss == 0 ? 1 : 0;
  });
  return matches;
}

std::vector<TrueReturn> visible_static(const std::vector<TrueReturn>& returns,
                                       const std::vector<Camera>& cameras) {
  std::vector<TrueReturn> visible;
  for (const TrueReturn& r : returns) {
    const float range = r.hit_lidar.norm();
    if (r.moving || !(range > kEvaluatedNear && range < kEvaluatedFar)) continue;
    if (in_any_view(cameras, r.hit_lidar.cast<double>())) visible.push_back(r);
  }
  return visible;
}

std::vector<Eigen::Vector3f> seen_surface(const DriveTruth& truth,
                                          const std::vector<PosePair>& frames,
                                          const std::vector<Camera>& cameras,
                                          const Eigen::Vector3d& origin_true) {
  std::vector<std::vector<Eigen::Vector3f>> seen(frames.size());
  parallel_for(frames.size(), 1, [&](std::size_t i) {
    std::vector<Eigen::Vector3f> hits;
    for (const TrueReturn& r : visible_static(truth.returns(frames[i].frame), cameras)) {
      const Eigen::Vector3d p = frames[i].T_true_lidar * r.hit_lidar.cast<double>();
      hits.push_back((p - origin_true).cast<float>());
    }
    seen[i] = voxel_thinned(std::move(hits), kSeenVoxel);
  });
  std::vector<Eigen::Vector3f> all;
  for (std::vector<Eigen::Vector3f>& hits : seen) {
    all.insert(all.end(), hits.begin(), hits.end());
    hits = {};
  }
  return voxel_thinned(std::move(all), kSeenVoxel);
}

SurfaceShares surface_shares(const std::vector<float>& distance,
                             const std::vector<Eigen::Vector3f>& map,
                             const std::vector<Eigen::Vector3f>& seen) {
  const KdTree tree(map, KdTree::kLargeLeafSize);
  std::vector<float> to_map(seen.size());
  parallel_for(seen.size(), kGrain, [&](std::size_t i) {
    to_map[i] = std::sqrt(tree.nearest(seen[i]).squared_distance);
  });
  SurfaceShares shares;
  shares.seen = seen.size();
  for (std::size_t k = 0; k < SurfaceShares::kCentimetres.size(); ++k) {
    const float bound = 0.01f * static_cast<float>(SurfaceShares::kCentimetres[k]);
    const double precision = share_within(distance, bound);
    const double completeness = share_within(to_map, bound);
    const double sum = precision + completeness;
    shares.precision[k] = precision;
    shares.completeness[k] = completeness;
    shares.f_score[k] = sum == 0 ? 0 : 2 * precision * completeness / sum;
  }
  return shares;
}

}  // namespace fovea
