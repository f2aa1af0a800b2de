#include "fovea/merging/point_merge.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "fovea/core/parallel.h"
#include "fovea/geometry/point_index.h"
#include "fovea/map/tile_place.h"
#include "fovea/mapping/color_fusion.h"
#include "fovea/merging/place_points.h"

namespace fovea {
namespace {

/// Edge of the cubes that are merged one after the other, m.
constexpr double kCube = 32;
constexpr std::size_t kGrain = 4096;

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
    const std::vector<bool> known = known_points(PointIndex(a_.position(), kIndexSpacing));
    fuse_colors(PointIndex(b_.position(), kIndexSpacing), figures);
    keep_new_points(known, figures);
  }

 private:
  bool is_inside(const Eigen::Vector3f& p_center) const {
    const Eigen::Array3f half = Eigen::Array3f::Constant(float(kCube / 2));
    return (p_center.array() >= -half).all() && (p_center.array() < half).all();
  }

  void gather() {
    map_.for_each_tile_near(
        center_local_, kCubeReach, [&](const TileId& id, const TilePoints& points) {
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
        known[i] = shows_surface(nearest.squared_distance, views(a_, nearest.index) > 0,
                                 views(b_, i) > 0, spacing_);
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
    std::map<std::pair<std::uint32_t, std::int8_t>, std::vector<std::uint32_t>> first_colored;
    // B's tiles are read, A's are changed.
    for (std::size_t i = 0; i < seen_by.size(); ++i) {
      if (seen_by[i] == kNone) continue;
      const PlacePoints::From to = a_.from(i), from = b_.from(seen_by[i]);
      const TilePoints& tile_b = *tiles_[from.tile].points;
      FusedColor& color = colors_of(to.tile)[to.point];
      if (color.views == 0) {
        first_colored[{to.tile, tile_b.camera[from.point]}].push_back(to.point);
      }
      color = fused(color, tile_b.colors[from.point]);
      ++figures.fused;
    }
    for (auto& [of, points] : first_colored) {
      std::sort(points.begin(), points.end());
      map_.put_camera(tiles_[of.first].id, points, of.second);
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
    return tiles_[from.tile].points->colors[from.point].views;
  }

  std::span<FusedColor> colors_of(std::uint32_t tile) {
    if (tile != changed_tile_) {
      changed_ = map_.colors(tiles_[tile].id);
      changed_tile_ = tile;
    }
    return changed_;
  }

  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct TileHere {
    TileId id;
    const TilePoints* points;
  };

  TileMap& map_;
  std::size_t first_b_;
  float spacing_;
  Eigen::Vector3d center_local_;
  PlacePoints a_, b_;
  std::vector<TileHere> tiles_;
  std::uint32_t changed_tile_ = kNone;
  std::span<FusedColor> changed_;
};

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
    for (const auto& [key, points] : submap.stored) take_tile(submap, key);
  }
  return cubes;
}

}  // namespace

PointMergeFigures merge_points(TileMap& map, std::size_t first_b, double spacing,
                               Checkpointer& file, TileCache& cache) {
  PointMergeFigures figures;
  for (const Cube& cube : cubes_of(map, first_b)) {
    cache.load_within(map, middle_of(cube), kCubeReach);
    CubeMerger(map, first_b, spacing, cube).merge(figures);
    if (!cache.is_full(map)) continue;
    cache.evict_beyond(map, middle_of(cube), kCubeReach);
    file.checkpoint(map, {});
  }
  return figures;
}

}  // namespace fovea
