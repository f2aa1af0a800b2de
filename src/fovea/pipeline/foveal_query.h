// Rays from points to a camera: of the scan, and of the map inside the foveal region.
#pragma once

#include <vector>

#include "fovea/map/tile_map.h"
#include "fovea/mapping/foveal_region.h"
#include "fovea/mapping/ray_filter.h"

namespace fovea {

/// Projection of a point that is in front of the camera, in float: for many points.
inline Eigen::Vector2f pixel_of(const Camera& camera, const Eigen::Vector3f& p_cam) {
  return {float(camera.fx) * p_cam.x() / p_cam.z() + float(camera.cx),
          float(camera.fy) * p_cam.y() / p_cam.z() + float(camera.cy)};
}

/// Rays of all points, which must project into the camera.
std::vector<Ray> rays_of(const PointCloud& points_cam, const Camera& camera);

/// Rays of the accumulated points inside the foveal region (the paper's P_A^f), in the map's order.
/// Looks only at tiles within the region's far range of the LiDAR.
std::vector<Ray> map_rays(const TileMap& map, const FovealRegion& region,
                          const RigidMotion& T_local_lidar);

}  // namespace fovea
