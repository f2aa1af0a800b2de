#include "fovea/pipeline/dynamic_points.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "fovea/base/errors.h"
#include "fovea/base/parallel.h"
#include "fovea/base/run_column.h"
#include "fovea/geometry/cell_brick.h"

namespace fovea {
namespace {

constexpr double kVoxel = 0.2;  // m
/// Fewer scans than this that saw through a place are taken for chance.
constexpr int kMinFree = 3;
constexpr std::size_t kVoxelGrain = 256;
/// How many voxels beneath one that goes lose what came with it: rays graze the road, so that they
/// never see through what stands just above it, the foot of a thing.
constexpr std::uint32_t kFoot = 2;

int voxels_per_edge(const TileMap& map) {
  return std::max(1, static_cast<int>(std::lround(map.tile_size() / kVoxel)));
}

/// Edge of a voxel, m. Whoever looks for a point's voxel takes the quotient of one by this, or a
/// point on a border would be in another one for another.
float voxel_size(const TileMap& map) {
  return static_cast<float>(map.tile_size() / voxels_per_edge(map));
}

/// Calls f(point, cell) for points of a tile that follow each other.
template <class F>
void for_each_cell(const TilePoints& points, std::size_t begin, std::size_t end,
                   float cells_per_metre, int edge, F&& f) {
  std::array<std::uint32_t, 256> cells;  // found eight at a time
  for (; begin < end; begin += cells.size()) {
    const std::size_t n = std::min(cells.size(), end - begin);
    std::array<const std::uint16_t*, 3> steps;
    for (std::size_t axis = 0; axis < 3; ++axis) steps[axis] = &points.position[axis][begin];
    const auto along = [&](std::size_t axis, std::size_t i) {
      const float value = float(steps[axis][i]) * kPositionStep;
      return std::clamp(int(value * cells_per_metre), 0, edge - 1);
    };
    for (std::size_t i = 0; i < n; ++i) {
      cells[i] =
          static_cast<std::uint32_t>((along(2, i) * edge + along(1, i)) * edge + along(0, i));
    }
    for (std::size_t i = 0; i < n; ++i) f(static_cast<std::uint32_t>(begin + i), cells[i]);
  }
}

/// Along x, y and z.
std::array<std::uint32_t, 3> place_of(std::uint32_t cell, int edge) {
  const auto n = static_cast<std::uint32_t>(edge);
  return {cell % n, cell / n % n, cell / n / n};
}

Eigen::Vector3f center_of(std::uint32_t cell, float size, int edge) {
  const auto [x, y, z] = place_of(cell, edge);
  return Eigen::Vector3f(float(x), float(y), float(z)) * size + Eigen::Vector3f::Constant(size / 2);
}

std::uint32_t aged(std::uint32_t bits, int frames) {
  return frames < DynamicPointFilter::kMemory ? bits << frames : 0;
}

/// Scans that saw through since the last that saw something there.
int free_since_filled(std::uint32_t filled, std::uint32_t free) {
  return std::popcount(free & ((filled & -filled) - 1));  // of no filled bit at all: every one
}

/// Of some cells of a tile and those beneath them: what lies elsewhere is told by its box.
class CellBounds {
 public:
  /// @param size  of a cell, m; `edge` of them are a tile's
  CellBounds(float size, int edge) : edge_(edge), steps_(double(size) / double(kPositionStep)) {}

  /// @param beneath  so many cells beneath it count, too
  void add(std::uint32_t cell, std::uint32_t beneath) {
    const std::array<std::uint32_t, 3> high = place_of(cell, edge_);
    std::array<std::uint32_t, 3> low = high;
    low[2] -= std::min(low[2], beneath);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low_[axis] = std::min(low_[axis], low[axis] * steps_ - kHair);
      high_[axis] = std::max(high_[axis], (high[axis] + 1) * steps_ + kHair);
    }
  }
  bool may_hold_some_of(const TilePoints::Box& box) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // What lies beyond the outermost cells counts to them.
      const bool is_before = box.high[axis] < low_[axis] && low_[axis] > 0;
      const bool is_behind = box.low[axis] > high_[axis] && high_[axis] < edge_ * steps_;
      if (is_before || is_behind) return false;
    }
    return true;
  }

 private:
  static constexpr double kHair = 1;  // steps: single precision tells which cell a point is in
  int edge_;
  double steps_;  // of a cell's edge
  std::array<double, 3> low_{1e9, 1e9, 1e9}, high_{-1e9, -1e9, -1e9};
};

/// Tile coordinates to those of the LiDAR, in float: what is looked at is near.
struct TileView {
  Eigen::Matrix3f R;
  Eigen::Vector3f t;
  TileView(const RigidMotion& T_lidar_submap, const Eigen::Vector3d& tile_origin)
      : R(T_lidar_submap.linear().cast<float>()), t((T_lidar_submap * tile_origin).cast<float>()) {}
};

}  // namespace

void DynamicPointOptions::validate() const {
  if (!(range > 0 && range <= 200)) {
    throw ConfigError("a range is out of range", "moving.range",
                      "give metres above 0 and up to 200");
  }
  if (free_scans < 1 || free_scans > DynamicPointFilter::kMemory) {
    throw ConfigError("a number of scans is out of range", "moving.free_scans", "give 1 to 32");
  }
}

std::vector<std::uint8_t> DynamicPointFilter::classify(const PointCloud& points_local,
                                                       const RigidMotion& T_odom_local) const {
  std::vector<std::uint8_t> marks(points_local.size(), 0);
  if (!options_.remove || scans_.size() < std::size_t(kMinFree)) return marks;

  // One verdict a voxel: its first point's.
  FlatMap<std::uint32_t> voxel_of_key;
  std::vector<std::uint32_t> voxel(points_local.size()), first_point;
  const float inverse = static_cast<float>(1 / kVoxel);
  std::uint64_t last_key = 0;
  for (std::uint32_t i = 0; i < voxel.size(); ++i) {
    const std::uint64_t key =
        cell_key((points_local.position[i].array() * inverse).floor().cast<int>());
    if (i > 0 && key == last_key) {  // neighbours in a cloud mostly share a voxel
      voxel[i] = voxel[i - 1];
      continue;
    }
    last_key = key;
    const auto [place, is_new] = voxel_of_key.try_emplace(key, std::uint32_t(first_point.size()));
    if (is_new) first_point.push_back(i);
    voxel[i] = *place;
  }
  std::vector<std::uint8_t> moving(first_point.size());
  const int judges = static_cast<int>(scans_.size());
  struct Judged {
    std::size_t voxel;
    Eigen::Vector3d p_odom;
    int free = 0, filled = 0;
  };
  parallel_chunks(first_point.size(), kVoxelGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<Judged> judged;
    for (std::size_t v = begin; v < end; ++v) {
      const Eigen::Vector3d p = points_local.position[first_point[v]].cast<double>();
      judged.push_back({v, T_odom_local * (points_local.origin + p)});
    }
    std::vector<Eigen::Vector3f> p_lidar;
    std::array<Visibility, kVoxelGrain> visibilities;
    for (int k = judges; k-- > 0;) {
      // Those which the judges that are left cannot make free go; mostly half of them are asked.
      std::erase_if(judged, [&](const Judged& j) {
        return j.free + k + 1 < kMinFree || j.free + k + 1 <= j.filled;
      });
      p_lidar.clear();
      for (const Judged& j : judged) {
        p_lidar.push_back((scans_[k].T_lidar_odom * j.p_odom).cast<float>());
      }
      scans_[k].image.classify(p_lidar, visibilities);
      for (std::size_t i = 0; i < judged.size(); ++i) {
        judged[i].free += visibilities[i] == Visibility::kFree;
        judged[i].filled += visibilities[i] == Visibility::kSurface;
      }
    }
    for (const Judged& j : judged) {
      moving[j.voxel] = j.free >= kMinFree && j.free > j.filled;
    }
  });
  for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = moving[voxel[i]];
  return marks;
}

std::vector<DynamicPointFilter::Tile> DynamicPointFilter::tiles_near(
    const TileMap& map, const Eigen::Vector3d& center_local) {
  std::vector<Tile> tiles;
  std::map<TileId, Block> within_reach;  // the others are forgotten
  map.for_each_tile_near(center_local, options_.range,
                         [&](const TileId& id, const TilePoints& points) {
                           auto node = blocks_.extract(id);
                           auto place = node ? within_reach.insert(std::move(node)).position
                                             : within_reach.try_emplace(id).first;
                           tiles.push_back({id, &points, &place->second, {}, false});
                         });
  blocks_ = std::move(within_reach);
  return tiles;
}

void DynamicPointFilter::look(const TileMap& map, const RigidMotion& T_odom_local, int frame,
                              Tile& tile) const {
  const Scan& scan = scans_.back();
  Block& block = *tile.block;
  const int edge = voxels_per_edge(map);
  const float size = voxel_size(map);
  const int age = frame - block.frame;
  block.frame = frame;
  for (Voxel& voxel : block.voxels) {
    voxel.filled = aged(voxel.filled, age);
    voxel.free = aged(voxel.free, age);
  }
  // Points that came since. Those of later frames are there when scans are replayed.
  Voxel* last = nullptr;  // neighbours mostly share a voxel
  tile.points->frame.for_each_run_from(block.known_points, [&](auto begin, auto end, int came) {
    if (came > frame) return false;
    const std::uint32_t bit = aged(1, frame - came);
    for_each_cell(*tile.points, begin, end, 1 / size, edge, [&](std::uint32_t, std::uint32_t cell) {
      if (last == nullptr || last->cell != cell) {
        const auto [place, is_new] =
            block.place.try_emplace(cell, std::uint32_t(block.voxels.size()));
        if (is_new) block.voxels.push_back({cell, 0, 0});
        last = &block.voxels[*place];
      }
      last->filled |= bit;
    });
    block.known_points = end;
    return true;
  });
  const TileView view(
      scan.T_lidar_odom * T_odom_local * map.submaps()[tile.id.submap].T_local_submap,
      tile.points->origin);
  std::vector<Eigen::Vector3f> p_lidar;
  p_lidar.reserve(block.voxels.size());
  for (const Voxel& voxel : block.voxels) {
    p_lidar.push_back(view.R * center_of(voxel.cell, size, edge) + view.t);
  }
  std::vector<Visibility> visibilities(p_lidar.size());
  scan.image.classify(p_lidar, visibilities);
  for (std::size_t i = 0; i < visibilities.size(); ++i) {
    block.voxels[i].filled |= visibilities[i] == Visibility::kSurface ? 1 : 0;
    block.voxels[i].free |= visibilities[i] == Visibility::kFree ? 1 : 0;
  }
}

void DynamicPointFilter::select_kept(const TileMap& map, Tile& tile) const {
  Block& block = *tile.block;
  const auto gone = [&](const Voxel& voxel) {
    return (voxel.free & 1) != 0 &&
           free_since_filled(voxel.filled, voxel.free) >= options_.free_scans;
  };
  tile.shrinks = std::any_of(block.voxels.begin(), block.voxels.end(), gone);
  if (!tile.shrinks) return;
  const int edge = voxels_per_edge(map);
  CellBounds bounds(voxel_size(map), edge);
  for (const Voxel& voxel : block.voxels) {
    if (gone(voxel)) bounds.add(voxel.cell, kFoot);
  }
  const float cells_per_metre = 1 / voxel_size(map);
  const auto layer = static_cast<std::uint32_t>(edge * edge);
  const auto frame_bit = [&](std::size_t i) {
    return aged(1, block.frame - tile.points->frame[i]);
  };
  RunColumn<std::uint32_t> voxel_of_point;   // neighbours mostly share one
  constexpr std::uint32_t kElsewhere = ~0u;  // none that goes, nor beneath one
  std::uint32_t first = 0, last_cell = kElsewhere;
  const auto end_run = [&](std::uint32_t end) {
    if (end == first) return;
    const std::uint32_t place = last_cell == kElsewhere ? kElsewhere : *block.place.find(last_cell);
    voxel_of_point.push_back(place, end - first);
    first = end;
  };
  const auto go_on = [&](std::uint32_t i, std::uint32_t cell) {
    if (cell == last_cell) return;
    end_run(i);
    last_cell = cell;
  };
  const auto count = static_cast<std::uint32_t>(tile.points->size());
  for (std::uint32_t begin = 0; begin < count; begin += TilePoints::kBoxed) {
    if (bounds.may_hold_some_of(tile.points->boxes[begin / TilePoints::kBoxed])) {
      for_each_cell(*tile.points, begin, std::min<std::size_t>(begin + TilePoints::kBoxed, count),
                    cells_per_metre, edge, go_on);
    } else {
      go_on(begin, kElsewhere);
    }
  }
  end_run(count);
  FlatMap<std::uint32_t> foot;  // by cell: frames whose points go
  voxel_of_point.for_each_run([&](std::uint32_t begin, std::uint32_t end, std::uint32_t place) {
    if (place == kElsewhere || !gone(block.voxels[place])) return;
    const Voxel& voxel = block.voxels[place];
    for (std::uint32_t k = 1; k <= kFoot && voxel.cell >= k * layer; ++k) {
      std::uint32_t& frames = *foot.try_emplace(voxel.cell - k * layer).first;
      for (std::uint32_t i = begin; i < end; ++i) frames |= frame_bit(i);
    }
  });
  voxel_of_point.for_each_run([&](std::uint32_t begin, std::uint32_t end, std::uint32_t place) {
    if (place != kElsewhere && gone(block.voxels[place])) return;
    const std::uint32_t* beneath =
        place == kElsewhere ? nullptr : foot.find(block.voxels[place].cell);
    for (std::uint32_t i = begin; i < end; ++i) {
      if (beneath == nullptr || (*beneath & frame_bit(i)) == 0) tile.kept.push_back(i);
    }
  });
  std::erase_if(block.voxels, gone);
  block.place.clear();
  for (std::uint32_t v = 0; v < block.voxels.size(); ++v) {
    block.place.try_emplace(block.voxels[v].cell, v);
  }
  block.known_points = tile.kept.size();
}

std::vector<DynamicPointFilter::Tile> DynamicPointFilter::gather(const TileMap& map,
                                                                 RangeImage scan,
                                                                 const RigidMotion& T_odom_lidar,
                                                                 const RigidMotion& T_odom_local,
                                                                 int frame) {
  scans_.push_back({std::move(scan), T_odom_lidar.inverse()});
  if (scans_.size() > kVotingScans) scans_.pop_front();
  std::vector<Tile> tiles = tiles_near(map, T_odom_local.inverse() * T_odom_lidar.translation());
  parallel_for(tiles.size(), 1, [&](std::size_t i) { look(map, T_odom_local, frame, tiles[i]); });
  return tiles;
}

std::size_t DynamicPointFilter::observe(TileMap& map, RangeImage scan,
                                        const RigidMotion& T_odom_lidar,
                                        const RigidMotion& T_odom_local, int frame) {
  if (!options_.remove) return 0;
  std::vector<Tile> tiles = gather(map, std::move(scan), T_odom_lidar, T_odom_local, frame);
  parallel_for(tiles.size(), 1, [&](std::size_t i) { select_kept(map, tiles[i]); });
  const std::size_t before = map.size();
  for (const Tile& tile : tiles) {
    if (tile.shrinks) map.keep_points(tile.id, tile.kept);
    if (tile.kept.empty() && tile.shrinks) blocks_.erase(tile.id);
  }
  return before - map.size();
}

void DynamicPointFilter::replay(const TileMap& map, RangeImage scan,
                                const RigidMotion& T_odom_lidar, const RigidMotion& T_odom_local,
                                int frame) {
  if (options_.remove) gather(map, std::move(scan), T_odom_lidar, T_odom_local, frame);
}

}  // namespace fovea
