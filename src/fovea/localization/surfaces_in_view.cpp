#include "fovea/localization/surfaces_in_view.h"

#include "fovea/mapping/fusion/place_match.h"

namespace fovea {
namespace {

constexpr float kSeenRange = 30;  // m

}  // namespace

SurfacesInView surfaces_in_view(const RegistrationCloud& target, const RangeImage& image,
                                const RigidMotion& T_target_lidar, float lowest) {
  const Eigen::Isometry3f T_lidar_target = T_target_lidar.inverse().cast<float>();
  const float sensor_height = float(T_target_lidar.translation().z());
  SurfacesInView result;
  for (std::size_t i = 0; i < target.points.size(); ++i) {
    if (!is_vertical(target.normals[i])) continue;
    if (target.points[i].z() - sensor_height < lowest) continue;
    const Eigen::Vector3f p_lidar = T_lidar_target * target.points[i];
    if (p_lidar.norm() > kSeenRange) continue;
    const Visibility visibility = image.visibility(p_lidar);
    result.through += visibility == Visibility::kFree;
    result.seen += visibility == Visibility::kSurface;
  }
  return result;
}

}  // namespace fovea
