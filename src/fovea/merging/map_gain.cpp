#include "fovea/merging/map_gain.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "fovea/geometry/point_index.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/tile_cache.h"
#include "fovea/map/tile_place.h"
#include "fovea/merging/place_points.h"

namespace fovea {
namespace {

/// Tiles of B that are compared, at most, and every how many of their points.
constexpr std::size_t kTiles = 256, kStep = 8;
constexpr std::size_t kTilesOfMatch = 16;
/// Submaps of B before and after a submap that count for its gain. On a few surfaces, shadows of
/// different days may be the larger peak.
constexpr std::size_t kNear = 5;
/// Channels of a gain that differ by more (stops) are peaks of different surfaces.
constexpr float kMostTint = 0.5f;

/// Adds the differences of colors, B minus A, of points on common surfaces.
/// @param points_a, points_b  of the tiles, in one frame
void add_differences(const std::vector<PointCloud>& tiles_a, const PlacePoints& points_a,
                     const PointCloud& tile_b, const PlacePoints& points_b,
                     CodeDifferences& b_minus_a) {
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

/// The tiles of each submap of a map.
std::map<std::size_t, std::vector<TileKey>> tiles_by_submap(const MapReader& map) {
  std::map<std::size_t, std::vector<TileKey>> tiles;
  for (const auto& [id, points] : map.tile_sizes()) tiles[id.submap].push_back(id.key);
  return tiles;
}

/// Compares the colors of pairs of submaps.
class SubmapColors {
 public:
  SubmapColors(const MapReader& a, const MapReader& b)
      : a_(a),
        b_(b),
        size_a_(map_tile_size(a.meta())),
        size_b_(map_tile_size(b.meta())),
        tiles_a_(tiles_by_submap(a)),
        tiles_b_(tiles_by_submap(b)) {}

  CodeDifferences b_minus_a(const SubmapMatch& match) const {
    const std::vector<TileKey> shared = shared_tiles(match);
    const std::size_t compared = std::min(kTilesOfMatch, shared.size());
    CodeDifferences differences;
    for (std::size_t k = 0; k < compared; ++k) {
      const TileKey& key = shared[k * shared.size() / compared];
      const Eigen::Vector3d center_a = match.T_a_b * middle_of(key, size_b_);
      PlacePoints points_a(center_a), points_b(center_a);
      std::vector<PointCloud> tiles_a;
      for (const TileKey& near : tiles_near(match.submap_a, center_a)) {
        tiles_a.push_back(a_.read_tile({match.submap_a, near}));
        points_a.add(tiles_a.size() - 1, tiles_a.back(), RigidMotion::Identity(),
                     reach_of_tile(size_b_));
      }
      const PointCloud tile_b = b_.read_tile({match.submap_b, key});
      points_b.add(0, tile_b, match.T_a_b, reach_of_tile(size_b_));
      add_differences(tiles_a, points_a, tile_b, points_b, differences);
    }
    return differences;
  }

 private:
  /// Tiles of A's submap that may have points within reach of a tile of B.
  std::vector<TileKey> tiles_near(std::size_t submap_a, const Eigen::Vector3d& center_a) const {
    const double reach = reach_of_tile(size_a_) + reach_of_tile(size_b_);
    std::vector<TileKey> near;
    const auto tiles = tiles_a_.find(submap_a);
    if (tiles == tiles_a_.end()) return near;
    for (const TileKey& key : tiles->second) {
      if ((middle_of(key, size_a_) - center_a).norm() < reach) near.push_back(key);
    }
    return near;
  }
  /// Tiles of B's submap whose middle lies in a tile of A's submap.
  std::vector<TileKey> shared_tiles(const SubmapMatch& match) const {
    std::vector<TileKey> shared;
    const auto a = tiles_a_.find(match.submap_a), b = tiles_b_.find(match.submap_b);
    if (a == tiles_a_.end() || b == tiles_b_.end()) return shared;
    for (const TileKey& key : b->second) {
      const Eigen::Vector3d place = match.T_a_b * middle_of(key, size_b_) / size_a_;
      const Eigen::Vector3i cell = place.array().floor().cast<int>();
      const TileKey in_a{cell.x(), cell.y(), cell.z()};
      if (std::find(a->second.begin(), a->second.end(), in_a) != a->second.end()) {
        shared.push_back(key);
      }
    }
    return shared;
  }

  const MapReader &a_, &b_;
  double size_a_, size_b_;  // of the tiles, m
  std::map<std::size_t, std::vector<TileKey>> tiles_a_, tiles_b_;
};

}  // namespace

void set_gains(const MapReader& a, const MapReader& b, std::vector<SubmapMatch>& matches) {
  const SubmapColors colors(a, b);
  struct Compared {
    SubmapMatch* best = nullptr;  // has most surfaces in common
    std::size_t most = 0;
    CodeDifferences b_minus_a;  // of all partners
  };
  std::map<std::size_t, Compared> compared;  // by submap of B
  for (SubmapMatch& match : matches) {
    const CodeDifferences b_minus_a = colors.b_minus_a(match);
    if (b_minus_a.size() == 0) continue;
    Compared& of_submap = compared[match.submap_b];
    of_submap.b_minus_a.append(b_minus_a);
    if (b_minus_a.size() <= of_submap.most) continue;
    of_submap.best = &match;
    of_submap.most = b_minus_a.size();
  }
  for (auto& [submap, of_submap] : compared) {
    CodeDifferences near;
    const std::size_t first = submap - std::min(submap, kNear);
    const auto end = compared.upper_bound(submap + kNear);
    for (auto other = compared.lower_bound(first); other != end; ++other) {
      near.append(other->second.b_minus_a);
    }
    const std::optional<LogGain> gain = gain_of(near);
    if (gain && gain->maxCoeff() - gain->minCoeff() < kMostTint) of_submap.best->log2_gain = gain;
  }
}

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
    add_differences(tiles_a, points_a, tile_b, points_b, b_minus_a);
  }
  return gain_of(b_minus_a).value_or(LogGain::Zero());
}

}  // namespace fovea
