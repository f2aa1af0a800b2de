// Rays from points to a camera: of a scan, and of the map in the foveal region.
#pragma once

#include <vector>

#include "fovea/foveal_region.h"
#include "fovea/map/tile_map.h"
#include "fovea/ray_filter.h"

namespace fovea {

/// Single-precision projection of a point in front of the camera.
inline Eigen::Vector2f pixel_of(const Camera& camera, const Eigen::Vector3f& p_cam) {
  return {float(camera.fx) * p_cam.x() / p_cam.z() + float(camera.cx),
          float(camera.fy) * p_cam.y() / p_cam.z() + float(camera.cy)};
}

/// Rays of all points, which must project into the camera.
std::vector<Ray> rays_of(const PointCloud& points_cam, const Camera& camera);

/// Rays of the map's points in the foveal region (the paper's P_A^f), in the map's order. Reads
/// only tiles within the region's far range of the LiDAR.
std::vector<Ray> map_rays(const TileMap& map, const FovealRegion& region,
                          const RigidMotion& T_local_lidar);

}  // namespace fovea
