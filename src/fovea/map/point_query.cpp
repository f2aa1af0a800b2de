#include "fovea/map/point_query.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "fovea/errors.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/map_point_filter.h"
#include "fovea/map/points_in_local.h"

namespace fovea {
namespace {

/// Whether a box may contain points of a tile.
bool is_near(const PointQuery::Box& box, const Eigen::Vector3d& center_local, double tile_size) {
  const double radius = tile_size * std::sqrt(3) / 2;
  const Eigen::Vector3d nearest = center_local.cwiseMax(box.low).cwiseMin(box.high);
  return (nearest - center_local).norm() <= radius;
}

/// The points of a tile that pass, in the frame `local`.
PointCloud passing_points(std::size_t submap, const PointCloud& tile,
                          const RigidMotion& T_local_submap, const PointQuery& query,
                          const MapPointFilter& filter) {
  const auto is_inside = [&](const PointQuery::Box& box, std::size_t i) {
    const Eigen::Vector3d p = T_local_submap * (tile.origin + tile.position[i].cast<double>());
    return (p.array() >= box.low.array()).all() && (p.array() <= box.high.array()).all();
  };
  std::vector<std::uint32_t> passing;
  for (std::size_t i = 0; i < tile.size(); ++i) {
    if (query.box && !is_inside(*query.box, i)) continue;
    if (filter.matches(submap, tile, i)) passing.push_back(static_cast<std::uint32_t>(i));
  }
  return points_in_local(tile.select(passing), T_local_submap);
}

void check(const PointQuery& query) {
  if (query.box && !(query.box->low.array() < query.box->high.array()).all()) {
    throw ConfigError("the box has no volume", "box", "give its low and high corner");
  }
}

}  // namespace

PointCloud find_points(const MapReader& map, const PointQuery& query) {
  check(query);
  const PointFilter where = query.where.empty() ? PointFilter() : PointFilter::parse(query.where);
  const std::shared_ptr<const void> state = map.hold_state();
  const MapPointFilter filter(map, where);
  const double tile_size = map_tile_size(map.meta());
  const std::vector<RigidMotion> T_local_submap = map.submaps();
  PointCloud points_local;
  for (const auto& [id, count] : map.tile_sizes()) {
    const Eigen::Vector3d middle(id.key.x + 0.5, id.key.y + 0.5, id.key.z + 0.5);
    const RigidMotion& T = T_local_submap.at(id.submap);
    if (query.box && !is_near(*query.box, T * (tile_size * middle), tile_size)) continue;
    const PointCloud found = passing_points(id.submap, map.read_tile(id), T, query, filter);
    if (!found.empty()) points_local.append(found);
  }
  return points_local;
}

}  // namespace fovea
