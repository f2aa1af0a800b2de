#include "fovea/map/map_surfaces.h"

#include "fovea/geometry/voxel_grid.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/tile_place.h"

namespace fovea {

MapSurfaces::MapSurfaces(const MapReader& map)
    : map_(map),
      tile_size_(map_tile_size(map.meta())),
      T_local_submap_(map.submaps()),
      tiles_(T_local_submap_.size()) {
  for (const auto& [id, points] : map.tile_sizes()) {
    Tile tile;
    tile.key = id.key;
    tiles_.at(id.submap).push_back(tile);
  }
}

void MapSurfaces::read(std::size_t submap, Tile& tile) {
  const PointCloud points = map_.read_tile({submap, tile.key});
  std::vector<Eigen::Vector3f> measured;
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Coarse points are of the periphery, and off by the errors of their frame's heading.
    if (points.interpolated[i] == 0 && points.sampling_level[i] == 0) {
      measured.push_back(points.position[i]);
    }
  }
  tile.points = file_.append(voxel_thinned(std::move(measured), kVoxel));
  tile.origin = points.origin;
}

std::vector<Eigen::Vector3f> MapSurfaces::points_near(const Eigen::Vector3d& center_local,
                                                      double radius,
                                                      std::optional<std::size_t> submap) {
  std::vector<Eigen::Vector3f> points;
  for (std::size_t id = submap.value_or(0); id < (submap ? *submap + 1 : tiles_.size()); ++id) {
    const Eigen::Vector3d center_submap = T_local_submap_[id].inverse() * center_local;
    const Eigen::Matrix3f R = T_local_submap_[id].linear().cast<float>();
    for (Tile& tile : tiles_[id]) {
      const double away = (middle_of(tile.key, tile_size_) - center_submap).norm();
      if (away > radius + reach_of_tile(tile_size_)) continue;
      if (!tile.points) read(id, tile);
      const Eigen::Vector3f origin = (tile.origin - center_submap).cast<float>();
      for (const Eigen::Vector3f& p : file_.read<Eigen::Vector3f>(*tile.points)) {
        const Eigen::Vector3f p_center = R * (origin + p);
        if (p_center.norm() <= radius) points.push_back(p_center);
      }
    }
  }
  return voxel_thinned(std::move(points), kVoxel);
}

}  // namespace fovea
