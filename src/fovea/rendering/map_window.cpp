#include "fovea/rendering/map_window.h"

#include <algorithm>
#include <set>

#include "fovea/core/parallel.h"
#include "fovea/geometry/point_index.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/map/colored_points.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/tile_place.h"
#include "fovea/mapping/registration/normals.h"

namespace fovea {
namespace {

/// Normals are those of points this far apart: what noise does to closer ones turns them about, m.
constexpr float kNormalSpacing = 0.08f;
constexpr int kNormalNeighbors = 12;
constexpr std::size_t kPointsPerTask = 1024;

/// Of each point that of the nearest of some that are thinned.
std::vector<Eigen::Vector3f> normals_of(const std::vector<Eigen::Vector3f>& position) {
  const std::vector<Eigen::Vector3f> thinned = voxel_thinned(position, kNormalSpacing);
  const std::vector<Eigen::Vector3f> normals =
      estimate_normals(thinned, {kNormalNeighbors, kNormalSpacing});
  const PointIndex index(thinned, kNormalSpacing);
  std::vector<Eigen::Vector3f> result(position.size(), Eigen::Vector3f::Zero());
  parallel_for(position.size(), kPointsPerTask, [&](std::size_t i) {
    const Neighbor nearest = index.nearest(position[i], 2 * kNormalSpacing);
    if (std::isfinite(nearest.squared_distance)) result[i] = normals[nearest.index];
  });
  return result;
}

/// Of coloured points among those alone: an image must have no holes between them.
std::vector<float> spacing_of(const MapSurfels& surfels) {
  std::vector<float> spacing = sample_spacing(surfels.position);
  std::vector<Eigen::Vector3f> colored;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    if (surfels.colored[i] != 0) colored.push_back(surfels.position[i]);
  }
  const std::vector<float> among_colored = sample_spacing(colored);
  for (std::size_t i = 0, k = 0; i < surfels.size(); ++i) {
    if (surfels.colored[i] != 0) spacing[i] = among_colored[k++];
  }
  return spacing;
}

template <class T>
void append_column(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

void MapSurfels::append(const MapSurfels& other) {
  const Eigen::Vector3f shift = (other.origin - origin).cast<float>();
  position.reserve(size() + other.size());
  for (const Eigen::Vector3f& p : other.position) position.push_back(p + shift);
  append_column(other.normal, normal);
  append_column(other.spacing, spacing);
  append_column(other.intensity, intensity);
  append_column(other.color, color);
  append_column(other.colored, colored);
}

MapWindow::MapWindow(const MapReader& map, double reach)
    : map_(map),
      reach_(reach),
      tile_size_(map_tile_size(map.meta())),
      T_local_submap_(map.submaps()) {
  for (const auto& [id, points] : map.tile_sizes()) {
    tiles_.emplace_back(id, T_local_submap_.at(id.submap) * middle_of(id.key, tile_size_));
  }
}

const MapSurfels& MapWindow::around(const Eigen::Vector3d& place_local) {
  std::set<TileId> wanted;
  for (const auto& [id, middle] : tiles_) {
    if ((middle - place_local).norm() <= reach_ + reach_of_tile(tile_size_)) wanted.insert(id);
  }
  const std::size_t had = near_.size();
  std::erase_if(near_, [&](const auto& tile) { return !wanted.contains(tile.first); });
  const bool same = near_.size() == had && wanted.size() == had && version_ > 0;
  if (same) return all_;
  for (const TileId& id : wanted) {
    if (!near_.contains(id)) near_.emplace(id, read(id));
  }
  all_ = {};
  all_.origin = place_local;
  for (const auto& [id, tile] : near_) all_.append(tile);
  all_.spacing = spacing_of(all_);  // tiles of several submaps share places
  ++version_;
  return all_;
}

MapSurfels MapWindow::read(const TileId& id) const {
  const PointCloud tile = map_.read_tile(id);
  const RigidMotion& T = T_local_submap_[id.submap];
  MapSurfels surfels;
  surfels.origin = T * tile.origin;
  const Eigen::Matrix3f R = T.linear().cast<float>();
  surfels.position.reserve(tile.size());
  for (const Eigen::Vector3f& p : tile.position) surfels.position.push_back(R * p);
  surfels.normal = normals_of(surfels.position);
  surfels.color = tile.color;
  for (std::size_t i = 0; i < tile.size(); ++i) {
    surfels.colored.push_back(tile.camera[i] == kNoCamera ? 0 : 1);
    surfels.intensity.push_back(tile.intensity.empty() ? luma(to_float(tile.color[i])) / 255
                                                       : tile.intensity[i]);
  }
  return surfels;
}

}  // namespace fovea
