#include "fovea/pipeline/foveal_query.h"

namespace fovea {

std::vector<Ray> rays_of(const PointCloud& points_cam, const Camera& camera) {
  std::vector<Ray> rays;
  rays.reserve(points_cam.size());
  // Interpolated points are between points in view, but rounding may move them slightly outside.
  const Eigen::Vector2f last(float(camera.width - 1), float(camera.height - 1));
  for (const Eigen::Vector3f& p : points_cam.position) {
    rays.push_back({pixel_of(camera, p).cwiseMax(0.0f).cwiseMin(last), p.norm()});
  }
  return rays;
}

std::vector<Ray> map_rays(const TileMap& map, const FovealRegion& region,
                          const RigidMotion& T_local_lidar) {
  const RigidMotion T_cam_local = region.camera().T_cam_lidar * T_local_lidar.inverse();
  std::vector<Ray> rays;
  map.for_each_tile_near(
      T_local_lidar.translation(), region.reach(), [&](const TileId& id, const TilePoints& tile) {
        const RigidMotion T_cam_submap = T_cam_local * map.submaps()[id.submap].T_local_submap;
        const Eigen::Matrix3f R = T_cam_submap.linear().cast<float>();
        const Eigen::Vector3f t = (T_cam_submap * tile.origin).cast<float>();
        Eigen::Vector2f pixel;
        for (std::size_t i = 0; i < tile.size(); ++i) {
          const Eigen::Vector3f p_cam = R * tile.position_at(i) + t;
          if (region.contains(p_cam, pixel)) rays.push_back({pixel, p_cam.norm()});
        }
      });
  return rays;
}

}  // namespace fovea
