#include "fovea/pipeline/dynamic_points.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "fovea/core/parallel.h"
#include "fovea/geometry/cell_brick.h"

namespace fovea {
namespace {

constexpr double kVoxel = 0.2;  // m
/// Fewer scans that see through a voxel may be chance.
constexpr int kMinFree = 3;
constexpr std::size_t kVoxelGrain = 256;
/// Voxels below a removed one that lose the points of the same frames. Rays graze the road and
/// never see through the lowest part of an object.
constexpr std::uint32_t kVoxelsBelow = 2;

/// The voxels of a tile.
class TileVoxels {
 public:
  explicit TileVoxels(double tile_size)
      : edge_(std::max(1, static_cast<int>(std::lround(tile_size / kVoxel)))),
        size_(static_cast<float>(tile_size / edge_)),
        per_meter_(1 / size_) {}

  std::uint32_t cells_per_layer() const { return static_cast<std::uint32_t>(edge_ * edge_); }
  std::uint32_t cell_of(const TilePoints& points, std::size_t i) const {
    const auto along = [&](std::size_t axis) {
      const float value = float(points.position[axis][i]) * kPositionStep;
      return std::clamp(int(value * per_meter_), 0, edge_ - 1);
    };
    return static_cast<std::uint32_t>((along(2) * edge_ + along(1)) * edge_ + along(0));
  }
  Eigen::Vector3f center_of(std::uint32_t cell) const {
    const auto n = static_cast<std::uint32_t>(edge_);
    const std::uint32_t x = cell % n, y = cell / n % n, z = cell / n / n;
    return Eigen::Vector3f(float(x), float(y), float(z)) * size_ +
           Eigen::Vector3f::Constant(size_ / 2);
  }

 private:
  int edge_;  // voxels
  float size_, per_meter_;
};

std::uint32_t aged(std::uint32_t bits, int frames) {
  return frames < DynamicPointFilter::kMemory ? bits << frames : 0;
}

/// Number of scans that observed a voxel as free since the last one that hit it.
int free_since_filled(std::uint32_t filled, std::uint32_t seen_free) {
  return std::popcount(seen_free & ((filled & -filled) - 1));  // without a hit: all
}

/// The voxels of a cloud, each with one of its points.
class CloudVoxels {
 public:
  explicit CloudVoxels(const PointCloud& points) : voxel_of_point_(points.size()) {
    const float inverse = static_cast<float>(1 / kVoxel);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const Eigen::Array3i cell = (points.position[i].array() * inverse).floor().cast<int>();
      const auto [voxel, is_new] =
          voxel_of_key_.try_emplace(cell_key(cell), std::uint32_t(first_point.size()));
      if (is_new) {
        first_point.push_back(i);
        cells_.push_back(cell);
      }
      voxel_of_point_[i] = *voxel;
    }
  }

  /// Marks of the points from marks of the voxels. Marked voxels mark those below them, too.
  std::vector<std::uint8_t> marks_of_points(const std::vector<std::uint8_t>& of_voxels) const {
    std::vector<std::uint8_t> with_below = of_voxels;
    for (std::size_t voxel = 0; voxel < of_voxels.size(); ++voxel) {
      for (std::uint32_t k = 1; of_voxels[voxel] != 0 && k <= kVoxelsBelow; ++k) {
        const Eigen::Array3i below = cells_[voxel] - Eigen::Array3i(0, 0, int(k));
        if (const auto* found = voxel_of_key_.find(cell_key(below))) with_below[*found] = 1;
      }
    }
    std::vector<std::uint8_t> marks(voxel_of_point_.size());
    for (std::size_t i = 0; i < marks.size(); ++i) marks[i] = with_below[voxel_of_point_[i]];
    return marks;
  }

  std::vector<std::uint32_t> first_point;

 private:
  std::vector<std::uint32_t> voxel_of_point_;
  std::vector<Eigen::Array3i> cells_;
  FlatMap<std::uint32_t> voxel_of_key_;
};

/// What two LiDARs see of a position. A surface counts, even if the other one sees through it.
Visibility combined(Visibility a, Visibility b) {
  for (const Visibility visibility : {Visibility::kSurface, Visibility::kFree}) {
    if (a == visibility || b == visibility) return visibility;
  }
  return Visibility::kUnknown;
}

}  // namespace

void DynamicPointFilter::Scan::classify(std::span<const Eigen::Vector3f> p_lidar,
                                        std::span<Visibility> visibilities) const {
  views.front().image.classify(p_lidar, visibilities);
  for (const SensorView& view : std::span(views).subspan(1)) {
    const Eigen::Isometry3f T_sensor_lidar = view.T_lidar_sensor.inverse().cast<float>();
    std::vector<Eigen::Vector3f> p_sensor;
    for (const Eigen::Vector3f& p : p_lidar) p_sensor.push_back(T_sensor_lidar * p);
    std::vector<Visibility> of_view(p_sensor.size());
    view.image.classify(p_sensor, of_view);
    std::ranges::transform(visibilities, of_view, visibilities.begin(), combined);
  }
}

std::vector<std::uint8_t> DynamicPointFilter::classify(const PointCloud& points_local,
                                                       const RigidMotion& T_odom_local) const {
  if (!options_.remove || scans_.size() < std::size_t(kMinFree)) {
    return std::vector<std::uint8_t>(points_local.size(), 0);
  }

  const CloudVoxels voxels(points_local);
  std::vector<std::uint8_t> is_dynamic(voxels.first_point.size());
  parallel_chunks(is_dynamic.size(), kVoxelGrain, [&](std::size_t begin, std::size_t end) {
    const std::size_t n = end - begin;
    std::vector<Eigen::Vector3d> p_odom(n);
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector3d p = points_local.position[voxels.first_point[begin + i]].cast<double>();
      p_odom[i] = T_odom_local * (points_local.origin + p);
    }
    std::vector<int> free(n), filled(n);
    std::vector<Eigen::Vector3f> p_lidar(n);
    std::vector<Visibility> visibilities(n);
    for (const Scan& scan : scans_) {
      for (std::size_t i = 0; i < n; ++i)
        p_lidar[i] = (scan.T_lidar_odom * p_odom[i]).cast<float>();
      scan.classify(p_lidar, visibilities);
      for (std::size_t i = 0; i < n; ++i) {
        free[i] += visibilities[i] == Visibility::kFree;
        filled[i] += visibilities[i] == Visibility::kSurface;
      }
    }
    for (std::size_t i = 0; i < n; ++i) {
      is_dynamic[begin + i] = free[i] >= kMinFree && free[i] > filled[i];
    }
  });
  return voxels.marks_of_points(is_dynamic);
}

std::vector<DynamicPointFilter::Tile> DynamicPointFilter::add_scan(const TileMap& map,
                                                                   std::vector<SensorView> scan,
                                                                   const RigidMotion& T_odom_lidar,
                                                                   const RigidMotion& T_odom_local,
                                                                   int frame) {
  scans_.push_back({std::move(scan), T_odom_lidar.inverse()});
  if (scans_.size() > kVotingScans) scans_.pop_front();
  std::vector<Tile> tiles = tiles_near(map, T_odom_local.inverse() * T_odom_lidar.translation());
  parallel_for(tiles.size(), 1,
               [&](std::size_t i) { update_evidence(map, T_odom_local, frame, tiles[i]); });
  return tiles;
}

std::vector<DynamicPointFilter::Tile> DynamicPointFilter::tiles_near(
    const TileMap& map, const Eigen::Vector3d& center_local) {
  std::vector<Tile> tiles;
  std::map<TileId, Evidence> in_range;  // drops the evidence for all other tiles
  map.for_each_tile_near(
      center_local, options_.range, [&](const TileId& id, const TilePoints& points) {
        auto node = evidence_.extract(id);
        auto entry =
            node ? in_range.insert(std::move(node)).position : in_range.try_emplace(id).first;
        tiles.push_back({id, &points, &entry->second, {}, false});
      });
  evidence_ = std::move(in_range);
  return tiles;
}

void DynamicPointFilter::update_evidence(const TileMap& map, const RigidMotion& T_odom_local,
                                         int frame, Tile& tile) const {
  const TileVoxels grid(map.tile_size());
  Evidence& evidence = *tile.evidence;
  const int age = frame - evidence.frame;
  evidence.frame = frame;
  for (Voxel& voxel : evidence.voxels) {
    voxel.filled = aged(voxel.filled, age);
    voxel.seen_free = aged(voxel.seen_free, age);
  }
  // New points. A replay leaves out those of later frames.
  tile.points->frame.for_each_run_from(
      evidence.known_points, [&](std::size_t begin, std::size_t end, int points_frame) {
        if (points_frame > frame) return false;
        for (std::size_t i = begin; i < end; ++i) {
          const std::uint32_t cell = grid.cell_of(*tile.points, i);
          const auto [voxel, is_new] =
              evidence.voxel_of_cell.try_emplace(cell, std::uint32_t(evidence.voxels.size()));
          if (is_new) evidence.voxels.push_back({cell, 0, 0});
          evidence.voxels[*voxel].filled |= aged(1, frame - points_frame);
        }
        evidence.known_points = end;
        return true;
      });
  const Scan& scan = scans_.back();
  const RigidMotion T_lidar_submap =
      scan.T_lidar_odom * T_odom_local * map.submaps()[tile.id.submap].T_local_submap;
  const Eigen::Matrix3f R = T_lidar_submap.linear().cast<float>();
  const Eigen::Vector3f t = (T_lidar_submap * tile.points->origin).cast<float>();
  std::vector<Eigen::Vector3f> p_lidar;
  p_lidar.reserve(evidence.voxels.size());
  for (const Voxel& voxel : evidence.voxels) p_lidar.push_back(R * grid.center_of(voxel.cell) + t);
  std::vector<Visibility> visibilities(p_lidar.size());
  scan.classify(p_lidar, visibilities);
  for (std::size_t i = 0; i < visibilities.size(); ++i) {
    evidence.voxels[i].filled |= visibilities[i] == Visibility::kSurface ? 1 : 0;
    evidence.voxels[i].seen_free |= visibilities[i] == Visibility::kFree ? 1 : 0;
  }
}

bool DynamicPointFilter::is_gone(const Voxel& voxel) const {
  return (voxel.seen_free & 1) != 0 &&
         free_since_filled(voxel.filled, voxel.seen_free) >= options_.free_scans;
}

void DynamicPointFilter::select_kept(const TileMap& map, Tile& tile) const {
  Evidence& evidence = *tile.evidence;
  // Frames whose points go, by cell: a bit for each age, as in Voxel, and kAllFrames.
  constexpr std::uint64_t kAllFrames = std::uint64_t{1} << kMemory;
  FlatMap<std::uint64_t> removed;
  for (const Voxel& voxel : evidence.voxels) {
    if (is_gone(voxel)) removed.try_emplace(voxel.cell, kAllFrames);
  }
  tile.shrinks = removed.size() > 0;
  if (!tile.shrinks) return;

  const TileVoxels grid(map.tile_size());
  const auto count = static_cast<std::uint32_t>(tile.points->size());
  std::vector<std::uint32_t> cell(count);
  std::vector<std::uint64_t> frames(count);
  for (std::uint32_t i = 0; i < count; ++i) cell[i] = grid.cell_of(*tile.points, i);
  tile.points->frame.for_each_run([&](std::size_t begin, std::size_t end, int frame) {
    std::fill(frames.begin() + std::ptrdiff_t(begin), frames.begin() + std::ptrdiff_t(end),
              kAllFrames | aged(1, evidence.frame - frame));
  });
  const auto removed_in = [&](std::uint32_t c) {
    const std::uint64_t* found = removed.find(c);
    return found != nullptr ? *found : 0;
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    if ((removed_in(cell[i]) & kAllFrames) == 0) continue;
    for (std::uint32_t k = 1; k <= kVoxelsBelow && cell[i] >= k * grid.cells_per_layer(); ++k) {
      *removed.try_emplace(cell[i] - k * grid.cells_per_layer(), 0).first |=
          frames[i] & ~kAllFrames;
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    if ((removed_in(cell[i]) & frames[i]) == 0) tile.kept.push_back(i);
  }
  std::erase_if(evidence.voxels, [&](const Voxel& voxel) { return is_gone(voxel); });
  evidence.voxel_of_cell.clear();
  for (std::uint32_t v = 0; v < evidence.voxels.size(); ++v) {
    evidence.voxel_of_cell.try_emplace(evidence.voxels[v].cell, v);
  }
  evidence.known_points = tile.kept.size();
}

std::size_t DynamicPointFilter::observe(TileMap& map, std::vector<SensorView> scan,
                                        const RigidMotion& T_odom_lidar,
                                        const RigidMotion& T_odom_local, int frame) {
  if (!options_.remove) return 0;
  std::vector<Tile> tiles = add_scan(map, std::move(scan), T_odom_lidar, T_odom_local, frame);
  parallel_for(tiles.size(), 1, [&](std::size_t i) { select_kept(map, tiles[i]); });
  const std::size_t before = map.size();
  for (const Tile& tile : tiles) {
    if (tile.shrinks) map.keep_points(tile.id, tile.kept);
    if (tile.kept.empty() && tile.shrinks) evidence_.erase(tile.id);
  }
  return before - map.size();
}

void DynamicPointFilter::follow_removal(const TileId& id, std::span<const std::uint32_t> kept) {
  const auto found = evidence_.find(id);
  if (found == evidence_.end()) return;
  std::size_t& known = found->second.known_points;
  known =
      static_cast<std::size_t>(std::lower_bound(kept.begin(), kept.end(), known) - kept.begin());
  if (kept.empty()) evidence_.erase(found);
}

void DynamicPointFilter::replay(const TileMap& map, std::vector<SensorView> scan,
                                const RigidMotion& T_odom_lidar, const RigidMotion& T_odom_local,
                                int frame) {
  if (options_.remove) add_scan(map, std::move(scan), T_odom_lidar, T_odom_local, frame);
}

}  // namespace fovea
