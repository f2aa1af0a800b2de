#include "fovea/geometry/transform_cloud.h"

#include "fovea/core/parallel.h"

namespace fovea {

PointCloud transform_cloud(PointCloud points_b, const RigidMotion& T_a_b,
                           const Eigen::Vector3d& origin_a) {
  // The large numbers meet in double once; the points stay near zero in float.
  const Eigen::Matrix3f R = T_a_b.linear().cast<float>();
  const Eigen::Vector3f t = (T_a_b * points_b.origin - origin_a).cast<float>();
  constexpr std::size_t kGrain = 16384;
  parallel_for(points_b.size(), kGrain,
               [&](std::size_t i) { points_b.position[i] = R * points_b.position[i] + t; });
  parallel_for(points_b.normal.size(), kGrain,
               [&](std::size_t i) { points_b.normal[i] = R * points_b.normal[i]; });
  points_b.origin = origin_a;
  return points_b;
}

}  // namespace fovea
