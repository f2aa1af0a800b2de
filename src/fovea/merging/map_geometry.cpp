#include "fovea/merging/map_geometry.h"

#include <algorithm>

#include "fovea/geometry/voxel_grid.h"

namespace fovea {

MapGeometry::MapGeometry(const MapReader& map)
    : T_local_submap_(map.submaps()), tiles_(T_local_submap_.size()) {
  map.for_each_tile([&](std::size_t submap, const TileKey&, const PointCloud& tile) {
    std::vector<Eigen::Vector3f> measured;
    for (std::size_t i = 0; i < tile.size(); ++i) {
      if (tile.interpolated[i] == 0) measured.push_back(tile.position[i]);
    }
    measured = voxel_thinned(std::move(measured), kVoxel);
    for (const Eigen::Vector3f& p : measured) {
      tile_reach_ = std::max(tile_reach_, double{p.norm()});
    }
    if (!measured.empty()) tiles_[submap].push_back({file_.append(measured), tile.origin});
  });
}

std::vector<Eigen::Vector3f> MapGeometry::points_near(const Eigen::Vector3d& center_local,
                                                      double radius,
                                                      std::optional<std::size_t> submap) const {
  std::vector<Eigen::Vector3f> points;
  for (std::size_t id = submap.value_or(0); id < (submap ? *submap + 1 : tiles_.size()); ++id) {
    const Eigen::Vector3d center_submap = T_local_submap_[id].inverse() * center_local;
    const Eigen::Matrix3f R = T_local_submap_[id].linear().cast<float>();
    for (const Tile& tile : tiles_[id]) {
      const Eigen::Vector3d away = tile.origin - center_submap;
      if (away.norm() > radius + tile_reach_) continue;
      for (const Eigen::Vector3f& p : file_.read<Eigen::Vector3f>(tile.points)) {
        const Eigen::Vector3f p_center = R * (away.cast<float>() + p);
        if (p_center.norm() <= radius) points.push_back(p_center);
      }
    }
  }
  return voxel_thinned(std::move(points), kVoxel);
}

}  // namespace fovea
