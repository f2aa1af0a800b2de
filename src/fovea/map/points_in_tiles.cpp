#include "fovea/map/points_in_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 8192, kBlock = 256;

/// Points that follow each other in one tile, as neighbours in a cloud mostly do.
struct Run {
  TileKey tile;
  TilePoints::Range points;
};

/// Tiles and places there of some points, a row for each axis, on which the compiler works four
/// wide.
class Block {
 public:
  Block(const RigidMotion& T_submap_points, double tile_size)
      : R_(T_submap_points.linear()), t_(T_submap_points.translation()), tile_size_(tile_size) {}

  /// @param first     of the points' places in `position`
  /// @param position  gets where they are in their tiles
  void compute(std::span<const Eigen::Vector3f> points, std::size_t first, TilePlaces& position) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      x_[i] = points[i].x();
      y_[i] = points[i].y();
      z_[i] = points[i].z();
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      compute_axis(axis, points.size(), position[axis].data() + first);
    }
  }

  TileKey tile(std::size_t i) const { return {tile_[0][i], tile_[1][i], tile_[2][i]}; }

 private:
  static constexpr double kLeast = std::numeric_limits<std::int32_t>::min(),
                          kMost = std::numeric_limits<std::int32_t>::max();

  /// Whether a key can say which tile it is; NaN is none.
  static int is_in_reach(double index) {
    return static_cast<int>(index >= kLeast) & static_cast<int>(index <= kMost);  // no branch
  }

  void compute_axis(std::size_t axis, std::size_t count, std::uint16_t* position) {
    const auto k = Eigen::Index(axis);
    const double rx = R_(k, 0), ry = R_(k, 1), rz = R_(k, 2), t = t_[k], tile_size = tile_size_,
                 tiles_per_metre = 1 / tile_size;
    std::int32_t* const tile = tile_[axis].data();
    int all_in_reach = 1;
    for (std::size_t i = 0; i < count; ++i) {
      p_[i] = rx * double(x_[i]) + ry * double(y_[i]) + rz * double(z_[i]) + t;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double index = std::floor(p_[i] * tiles_per_metre);
      all_in_reach &= is_in_reach(index);
      tile[i] = static_cast<std::int32_t>(std::min(kMost, std::max(kLeast, index)));
    }
    if (all_in_reach == 0) throw_too_far(count, tiles_per_metre);
    for (std::size_t i = 0; i < count; ++i) {
      position[i] = position_steps(p_[i] - double(tile[i]) * tile_size);
    }
  }

  [[noreturn]] void throw_too_far(std::size_t count, double tiles_per_metre) const {
    const double far = *std::find_if(p_.data(), p_.data() + count, [&](double p) {
      return is_in_reach(std::floor(p * tiles_per_metre)) == 0;
    });
    throw std::invalid_argument(
        fmt::format("a point lies {} tiles from its submap's origin: not finite or too far",
                    far * tiles_per_metre));
  }

  Eigen::Matrix3d R_;
  Eigen::Vector3d t_;
  double tile_size_;
  std::array<float, kBlock> x_, y_, z_;
  std::array<double, kBlock> p_;  // m, submap frame, along the axis at hand
  std::array<std::array<std::int32_t, kBlock>, 3> tile_;
};

}  // namespace

PointsInTiles points_in_tiles(std::span<const Eigen::Vector3f> points,
                              const RigidMotion& T_submap_points, double tile_size) {
  PointsInTiles result;
  for (auto& axis : result.position) axis.resize(points.size());
  std::vector<std::vector<Run>> chunks((points.size() + kGrain - 1) / kGrain);
  parallel_chunks(points.size(), kGrain, [&](std::size_t chunk_begin, std::size_t chunk_end) {
    Block block(T_submap_points, tile_size);
    std::vector<Run>& runs = chunks[chunk_begin / kGrain];
    for (std::size_t begin = chunk_begin; begin < chunk_end; begin += kBlock) {
      const std::size_t count = std::min(kBlock, chunk_end - begin);
      block.compute(points.subspan(begin, count), begin, result.position);
      for (std::size_t i = 0; i < count; ++i) {
        const auto at = static_cast<std::uint32_t>(begin + i);
        const TileKey tile = block.tile(i);
        if (runs.empty() || runs.back().tile != tile) runs.push_back({tile, {at, at}});
        runs.back().points.end = at + 1;
      }
    }
  });
  for (const std::vector<Run>& runs : chunks) {
    for (const auto& [tile, range] : runs) {
      std::vector<TilePoints::Range>& ranges = result.ranges[tile];
      if (ranges.empty() || ranges.back().end != range.begin) {
        ranges.push_back(range);
      } else {  // a chunk ended in between
        ranges.back().end = range.end;
      }
    }
  }
  return result;
}

}  // namespace fovea
