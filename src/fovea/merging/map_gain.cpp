#include "fovea/merging/map_gain.h"

#include <algorithm>
#include <cmath>

#include "fovea/geometry/point_index.h"
#include "fovea/map/tile_cache.h"
#include "fovea/map/tile_place.h"
#include "fovea/merging/place_points.h"

namespace fovea {
namespace {

/// How many of B's tiles are asked at most, and every how many of their points.
constexpr std::size_t kTiles = 256, kStep = 8;

/// A's tiles around a place, read when they are asked for.
class TilesOfA {
 public:
  TilesOfA(const MapReader& map, double tile_size)
      : map_(map), places_(stored_map(map, tile_size)) {
    places_.add_submap(RigidMotion::Identity());  // the last one's tiles count as near everywhere
  }

  std::vector<PointCloud> near(const Eigen::Vector3d& center_a, double radius,
                               PlacePoints& points) const {
    std::vector<PointCloud> tiles;
    for (const TileId& id : places_.stored_near(center_a, radius)) {
      tiles.push_back(map_.read_tile(id));
      points.add(tiles.size() - 1, tiles.back(), places_.submaps()[id.submap].T_local_submap,
                 radius);
    }
    return tiles;
  }

 private:
  const MapReader& map_;
  TileMap places_;
};

}  // namespace

LogGain gain_of_maps(const MapReader& a, const MapReader& b,
                     const std::vector<RigidMotion>& T_a_submap_b, double tile_size) {
  const TilesOfA all_a(a, tile_size);
  const auto tiles_b = b.tile_sizes();
  const double radius = reach_of_tile(tile_size);
  CodeDifferences b_minus_a;
  for (std::size_t k = 0; k < tiles_b.size();
       k += std::max<std::size_t>(1, tiles_b.size() / kTiles)) {
    const TileId id = tiles_b[k].first;
    const RigidMotion& T_a_here = T_a_submap_b.at(id.submap);
    const Eigen::Vector3d center_a = T_a_here * middle_of(id.key, tile_size);
    PlacePoints points_a(center_a), points_b(center_a);
    const std::vector<PointCloud> tiles_a = all_a.near(center_a, radius, points_a);
    if (tiles_a.empty()) continue;
    const PointCloud tile_b = b.read_tile(id);
    points_b.add(0, tile_b, T_a_here, radius);
    const PointIndex index_a(points_a.position(), kIndexSpacing);
    for (std::size_t i = 0; i < points_b.position().size(); i += kStep) {
      const Neighbor nearest = index_a.nearest(points_b.position()[i], kSameSurface);
      if (!std::isfinite(nearest.squared_distance)) continue;
      const PlacePoints::From from = points_a.from(nearest.index);
      const FusedColor known = color_of(tiles_a[from.tile], from.point);
      const FusedColor seen = color_of(tile_b, points_b.from(i).point);
      if (seen.views < 2 || known.views < 2) continue;
      if (seen.saturated != 0 || known.saturated != 0) continue;
      b_minus_a.add(codes_of(seen.color) - codes_of(known.color));
    }
  }
  return gain_of(b_minus_a).value_or(LogGain::Zero());
}

}  // namespace fovea
