#include "fovea/merging/submap_scans.h"

#include <utility>

#include "fovea/geometry/voxel_grid.h"
#include "fovea/map/keyframe_returns.h"
#include "fovea/merging/placed_keyframes.h"

namespace fovea {
namespace {

/// m: beyond this, rings are too far apart for normals.
constexpr double kMaxRange = 60;

}  // namespace

SubmapScans::SubmapScans(const MapReader& map, const MapContent& content)
    : content_(content), points_(content.T_local_submap.size()) {
  std::vector<Eigen::Vector3f> points;
  std::optional<std::size_t> submap;  // whose points these are
  for_each_placed_keyframe(map, content, [&](const PlacedKeyframe& keyframe) {
    if (submap && *submap != keyframe.submap) keep(*submap, std::exchange(points, {}));
    submap = keyframe.submap;
    const Eigen::Isometry3f T_submap_sensor = keyframe.T_submap_sensor.cast<float>();
    for (const Eigen::Vector3f& p : returns_of(keyframe.image, kMaxRange)) {
      points.push_back(T_submap_sensor * p);
    }
  });
  if (submap) {
    keep(*submap, std::move(points));
  } else {
    surfaces_.emplace(map);
  }
}

void SubmapScans::keep(std::size_t submap, std::vector<Eigen::Vector3f> points) {
  points_[submap] = file_.append(voxel_thinned(std::move(points), MapSurfaces::kVoxel));
}

std::vector<Eigen::Vector3f> SubmapScans::points_near(const Eigen::Vector3d& center_local,
                                                      double radius,
                                                      std::optional<std::size_t> submap) {
  if (surfaces_) return surfaces_->points_near(center_local, radius, submap);
  std::vector<Eigen::Vector3f> near;
  for (std::size_t id = submap.value_or(0); id < (submap ? *submap + 1 : points_.size()); ++id) {
    const RigidMotion& T_local_submap = content_.T_local_submap[id];
    if (!points_[id]) continue;
    if ((T_local_submap.translation() - center_local).norm() > radius + 2 * kMaxRange) continue;
    const Eigen::Matrix3f R = T_local_submap.linear().cast<float>();
    const Eigen::Vector3f t = (T_local_submap.translation() - center_local).cast<float>();
    for (const Eigen::Vector3f& p : file_.read<Eigen::Vector3f>(*points_[id])) {
      const Eigen::Vector3f p_center = R * p + t;
      if (p_center.norm() <= float(radius)) near.push_back(p_center);
    }
  }
  return voxel_thinned(std::move(near), MapSurfaces::kVoxel);
}

}  // namespace fovea
