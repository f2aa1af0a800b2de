#include "fovea/merging/point_merge.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "fovea/base/parallel.h"
#include "fovea/geometry/point_index.h"
#include "fovea/mapping/color_fusion.h"
#include "fovea/mapping/exposure.h"

namespace fovea {
namespace {

/// Points of two maps nearer than this show one surface: what is left of registration and of the
/// LiDAR's noise.
constexpr float kSameSurface = 0.05f;  // m
/// What an index of a map's points is built for.
constexpr double kIndexSpacing = kSameSurface / 4;
/// Edge of the cubes that are merged one after the other, m.
constexpr double kCube = 32;
constexpr std::size_t kGrain = 4096;
/// How many of B's tiles are asked for the gain at most, and every how many of their points.
constexpr std::size_t kGainTiles = 256, kGainStep = 8;

using Cube = std::array<int, 3>;

Cube cube_of(const Eigen::Vector3d& p_local) {
  const Eigen::Array3i cube = (p_local.array() / kCube).floor().cast<int>();
  return {cube.x(), cube.y(), cube.z()};
}

Eigen::Vector3d middle_of(const Cube& cube) {
  return kCube * (Eigen::Vector3d(cube[0], cube[1], cube[2]) + Eigen::Vector3d::Constant(0.5));
}

/// So far from its middle may lie what has to do with a cube's points.
const double kCubeReach = kCube / 2 * std::sqrt(3.0) + kSameSurface;

/// Points of some tiles around a place, and where each comes from.
class PlacePoints {
 public:
  explicit PlacePoints(const Eigen::Vector3d& center_local) : center_local_(center_local) {}

  void add(std::size_t tile, const PointCloud& points, const RigidMotion& T_local_submap,
           double radius) {
    const Eigen::Matrix3f R = T_local_submap.linear().cast<float>();
    const Eigen::Vector3f t = (T_local_submap * points.origin - center_local_).cast<float>();
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3f p = R * points.position[i] + t;
      if (p.norm() > float(radius)) continue;
      position_.push_back(p);
      from_.push_back({std::uint32_t(tile), i});
    }
  }

  struct From {
    std::uint32_t tile, point;
  };
  const std::vector<Eigen::Vector3f>& position() const { return position_; }
  const From& from(std::size_t i) const { return from_[i]; }

 private:
  Eigen::Vector3d center_local_;
  std::vector<Eigen::Vector3f> position_;
  std::vector<From> from_;
};

FusedColor color_of(const PointCloud& tile, std::size_t i) {
  return {tile.color[i], tile.views[i], tile.spread[i], tile.weight[i]};
}

/// Merges what one cube holds.
class CubeMerger {
 public:
  CubeMerger(TileMap& map, std::size_t first_b, double spacing, const Cube& cube)
      : map_(map),
        first_b_(first_b),
        spacing_(float(spacing)),
        center_local_(middle_of(cube)),
        a_(center_local_),
        b_(center_local_) {}

  void merge(PointMergeFigures& figures) {
    gather();
    const PointIndex index_a(a_.position(), kIndexSpacing), index_b(b_.position(), kIndexSpacing);
    const std::vector<bool> known = known_points(index_a);
    fuse_colors(index_b, figures);
    keep_new_points(known, figures);
  }

 private:
  bool is_inside(const Eigen::Vector3f& p_center) const {
    const Eigen::Array3f half = Eigen::Array3f::Constant(float(kCube / 2));
    return (p_center.array() >= -half).all() && (p_center.array() < half).all();
  }

  void gather() {
    map_.for_each_tile_near(
        center_local_, kCubeReach, [&](const TileId& id, const PointCloud& points) {
          (id.submap < first_b_ ? a_ : b_)
              .add(tiles_.size(), points, map_.submaps()[id.submap].T_local_submap, kCubeReach);
          tiles_.push_back({id, &points});
        });
  }

  /// Which of B's points in the cube A knows.
  std::vector<bool> known_points(const PointIndex& index_a) const {
    std::vector<char> known(b_.position().size());  // not bool: written by several threads
    parallel_chunks(known.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!is_inside(b_.position()[i])) continue;
        const Neighbor nearest = index_a.nearest(b_.position()[i], kSameSurface);
        if (!std::isfinite(nearest.squared_distance)) continue;
        // Where no camera saw A's points they may be as sparse as the scan.
        const bool is_dense = views(a_, nearest.index) > 0 || views(b_, i) == 0;
        known[i] = is_dense || nearest.squared_distance < spacing_ * spacing_;
      }
    });
    return {known.begin(), known.end()};
  }

  void fuse_colors(const PointIndex& index_b, PointMergeFigures& figures) {
    std::vector<std::uint32_t> seen_by(a_.position().size(), kNone);
    parallel_chunks(seen_by.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!is_inside(a_.position()[i])) continue;
        const Neighbor nearest = index_b.nearest(a_.position()[i], kSameSurface);
        if (!std::isfinite(nearest.squared_distance) || views(b_, nearest.index) == 0) continue;
        seen_by[i] = nearest.index;
      }
    });
    // B's tiles are read, A's are changed.
    for (std::size_t i = 0; i < seen_by.size(); ++i) {
      if (seen_by[i] == kNone) continue;
      const PlacePoints::From to = a_.from(i), from = b_.from(seen_by[i]);
      const PointCloud& tile_b = *tiles_[from.tile].points;
      TileColors& colors = colors_of(to.tile);
      const FusedColor before{colors.color[to.point], colors.views[to.point],
                              colors.spread[to.point], colors.weight[to.point]};
      const FusedColor both = fused(before, color_of(tile_b, from.point));
      colors.color[to.point] = both.color;
      colors.views[to.point] = both.views;
      colors.spread[to.point] = both.spread;
      colors.weight[to.point] = both.weight;
      if (before.views == 0) colors.camera[to.point] = tile_b.camera[from.point];
      ++figures.fused;
    }
  }

  void keep_new_points(const std::vector<bool>& known, PointMergeFigures& figures) {
    for (std::size_t i = 0; i < known.size();) {
      const std::uint32_t tile = b_.from(i).tile;
      std::vector<char> gone(tiles_[tile].points->size());
      std::size_t left_out = 0;
      for (; i < known.size() && b_.from(i).tile == tile; ++i) {
        figures.added += is_inside(b_.position()[i]) && !known[i];
        left_out += known[i];
        gone[b_.from(i).point] = known[i];
      }
      figures.known += left_out;
      if (left_out == 0) continue;
      std::vector<std::uint32_t> kept;
      for (std::uint32_t k = 0; k < gone.size(); ++k) {
        if (!gone[k]) kept.push_back(k);
      }
      map_.keep_points(tiles_[tile].id, kept);
    }
  }

  std::uint8_t views(const PlacePoints& points, std::size_t i) const {
    const PlacePoints::From from = points.from(i);
    return tiles_[from.tile].points->views[from.point];
  }

  TileColors& colors_of(std::uint32_t tile) {
    if (tile != changed_tile_) {
      changed_ = map_.colors(tiles_[tile].id);
      changed_tile_ = tile;
    }
    return changed_;
  }

  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct TileHere {
    TileId id;
    const PointCloud* points;
  };

  TileMap& map_;
  std::size_t first_b_;
  float spacing_;
  Eigen::Vector3d center_local_;
  PlacePoints a_, b_;
  std::vector<TileHere> tiles_;
  std::uint32_t changed_tile_ = kNone;
  TileColors changed_;
};

/// Middle of a tile, and how far its points may lie from there.
Eigen::Vector3d middle_of(const TileKey& key, double tile_size) {
  return tile_size * (Eigen::Vector3d(key.x, key.y, key.z) + Eigen::Vector3d::Constant(0.5));
}
double reach_of_tile(double tile_size) { return tile_size / 2 * std::sqrt(3.0) + 0.01; }

/// The cubes that B's tiles reach into, along B's way.
std::vector<Cube> cubes_of(const TileMap& map, std::size_t first_b) {
  std::vector<Cube> cubes;
  std::set<Cube> taken;
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(reach_of_tile(map.tile_size()));
  const auto take_tile = [&](const Submap& submap, const TileKey& key) {
    const Eigen::Vector3d middle_local = submap.T_local_submap * middle_of(key, map.tile_size());
    const Cube low = cube_of(middle_local - reach), high = cube_of(middle_local + reach);
    for (int z = low[2]; z <= high[2]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        for (int x = low[0]; x <= high[0]; ++x) {
          if (taken.insert({x, y, z}).second) cubes.push_back({x, y, z});
        }
      }
    }
  };
  for (std::size_t id = first_b; id < map.submaps().size(); ++id) {
    const Submap& submap = map.submaps()[id];
    std::set<TileKey> keys;  // of both kinds in one order: which are in memory must not matter
    for (const auto& [key, tile] : submap.tiles) keys.insert(key);
    for (const auto& [key, points] : submap.stored) keys.insert(key);
    for (const TileKey& key : keys) take_tile(submap, key);
  }
  return cubes;
}

}  // namespace

PointMergeFigures merge_points(TileMap& map, std::size_t first_b, double spacing,
                               MapKeeper& keeper) {
  PointMergeFigures figures;
  for (const Cube& cube : cubes_of(map, first_b)) {
    keeper.bring_near(map, middle_of(cube), kCubeReach);
    CubeMerger(map, first_b, spacing, cube).merge(figures);
    if (keeper.needs_memory(map)) keeper.checkpoint(map, {}, middle_of(cube), kCubeReach);
  }
  return figures;
}

Eigen::Array3f gain_of_maps(const MapReader& a, const MapReader& b,
                            const std::vector<RigidMotion>& T_a_submap_b, double tile_size) {
  TileMap places(tile_size);  // of A's tiles: none of them is ever in memory
  const std::vector<RigidMotion> T_a_submap = a.submaps();
  for (const RigidMotion& T : T_a_submap) places.add_submap(T);
  for (const auto& [id, points] : a.tile_sizes()) places.declare_stored(id, points);
  places.add_submap(RigidMotion::Identity());  // the last one's tiles count as near everywhere
  const auto tiles_b = b.tile_sizes();
  const std::size_t step = std::max<std::size_t>(1, tiles_b.size() / kGainTiles);
  std::vector<Eigen::Array3f> gains;
  for (std::size_t k = 0; k < tiles_b.size(); k += step) {
    const TileId id = tiles_b[k].first;
    const RigidMotion& T_a_b = T_a_submap_b.at(id.submap);
    const Eigen::Vector3d center_a = T_a_b * middle_of(id.key, tile_size);
    const double radius = reach_of_tile(tile_size);
    const std::vector<TileId> near = places.stored_near(center_a, radius);
    if (near.empty()) continue;
    PlacePoints points_a(center_a), points_b(center_a);
    std::vector<PointCloud> clouds;
    for (const TileId& id_a : near) {
      clouds.push_back(a.read_tile(id_a));
      points_a.add(clouds.size() - 1, clouds.back(), T_a_submap[id_a.submap], radius);
    }
    const PointCloud tile_b = b.read_tile(id);
    points_b.add(0, tile_b, T_a_b, radius);
    const PointIndex index_a(points_a.position(), kIndexSpacing);
    for (std::size_t i = 0; i < points_b.position().size(); i += kGainStep) {
      const Neighbor nearest = index_a.nearest(points_b.position()[i], kSameSurface);
      if (!std::isfinite(nearest.squared_distance)) continue;
      const FusedColor seen = color_of(tile_b, points_b.from(i).point);
      const PlacePoints::From from = points_a.from(nearest.index);
      const FusedColor known = color_of(clouds[from.tile], from.point);
      if (seen.views < 2 || known.views < 2) continue;
      const auto gain = gain_between(to_float(known.color).array(), to_float(seen.color).array());
      if (gain) gains.push_back(*gain);
    }
  }
  return median_gain(gains);
}

}  // namespace fovea
