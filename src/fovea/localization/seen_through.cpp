#include "fovea/localization/seen_through.h"

#include "fovea/mapping/fusion/place_match.h"

namespace fovea {
namespace {

constexpr float kSeenRange = 30;  // m

}  // namespace

double seen_through(const RegistrationCloud& target, const RangeImage& image,
                    const RigidMotion& T_target_lidar, float lowest) {
  const Eigen::Isometry3f T_lidar_target = T_target_lidar.inverse().cast<float>();
  std::size_t free = 0, surface = 0;
  for (std::size_t i = 0; i < target.points.size(); ++i) {
    if (!is_vertical(target.normals[i])) continue;
    const Eigen::Vector3f p_lidar = T_lidar_target * target.points[i];
    if (p_lidar.norm() > kSeenRange || p_lidar.z() < lowest) continue;
    const Visibility visibility = image.visibility(p_lidar);
    free += visibility == Visibility::kFree;
    surface += visibility == Visibility::kSurface;
  }
  return free > 0 ? double(free) / double(free + surface) : 0;
}

}  // namespace fovea
