#include "fovea/pipeline/visible_map.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/core/parallel.h"
#include "fovea/core/random.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/projected_block.h"
#include "fovea/pipeline/view_frustum.h"

namespace fovea {
namespace {

constexpr std::size_t kChunkSize = 8192, kBlock = ColorBlock::kSize;
/// Radius of a point's disc over the spacing of the points: discs of neighbors overlap.
constexpr float kDiscRadius = 0.75f;
/// Seed of the random rounding of colors.
constexpr std::uint64_t kRoundingSeed = 0x636f6c6f7572ull;
/// A submap counts as recent until the vehicle has driven this far from its end, m: a camera that
/// looks back sees the surfaces that a camera ahead has colored.
constexpr double kRecentPath = 120;
static_assert(kChunkSize <= 1 << 16);
static_assert(kChunkSize % TilePoints::kBoxed == 0 && TilePoints::kBoxed <= ProjectedBlock::kSize);

std::size_t find_first_recent(const std::vector<Submap>& submaps) {
  double path = 0;
  std::size_t first = submaps.size() - std::min<std::size_t>(submaps.size(), 1);
  for (; first > 0 && path < kRecentPath; --first) {
    path += (submaps[first].T_local_submap.translation() -
             submaps[first - 1].T_local_submap.translation())
                .norm();
  }
  return first;
}

}  // namespace

void VisibleMap::collect_chunks(const TileMap& map, const FovealRegion& region,
                                const RigidMotion& T_cam_local) {
  chunks_.clear();
  const Eigen::Vector3d lidar_local = T_cam_local.inverse() * camera_.T_cam_lidar.translation();
  map.for_each_tile_near(
      lidar_local, region.reach(), [&](const TileId& id, const TilePoints& points) {
        const RigidMotion T_cam_tile = T_cam_local * map.submaps()[id.submap].T_local_submap *
                                       Eigen::Translation3d(points.origin);
        const Eigen::Array3f gain_codes =
            float(kColorCodesPerStop) * map.submaps()[id.submap].log2_gain;
        if (points.empty() || !ViewFrustum(camera_, T_cam_tile).may_contain(points.box)) return;
        const auto size = static_cast<std::uint32_t>(points.size());
        for (std::uint32_t begin = 0; begin < size; begin += std::uint32_t(kChunkSize)) {
          const std::uint32_t end = std::min(size, begin + std::uint32_t(kChunkSize));
          chunks_.push_back(
              {id, &points, T_cam_tile, gain_codes, begin, end, chunks_.size() % kShards, 0, 0});
        }
      });
}

void VisibleMap::render(const TileMap& map, const FovealRegion& region,
                        const RigidMotion& T_cam_local, double spacing) {
  camera_ = region.camera();
  quantizer_ = ViewQuantizer(camera_, region.reach() + camera_.T_cam_lidar.translation().norm());
  white_zone_end_ = static_cast<float>(region.far_range());
  disc_radius_ = kDiscRadius * static_cast<float>(spacing * camera_.fx);
  collect_chunks(map, region, T_cam_local);
  first_recent_submap_ = find_first_recent(map.submaps());
  parallel_for(kShards, 1, [&](std::size_t shard) {
    shards_[shard].depth.clear(camera_);
    std::size_t first = 0;
    for (std::size_t k = shard; k < chunks_.size(); k += kShards) {
      chunks_[k].first = first;
      render_chunk(region, chunks_[k]);
      first += chunks_[k].count;
    }
  });
  std::swap(depth_, shards_[0].depth);
  for (std::size_t shard = 1; shard < kShards; ++shard) depth_.add(shards_[shard].depth);
}

void VisibleMap::render_chunk(const FovealRegion& region, Chunk& chunk) {
  const Eigen::Matrix3f R = chunk.T_cam_tile.linear().cast<float>();
  const Eigen::Vector3f t = chunk.T_cam_tile.translation().cast<float>();
  const ViewFrustum frustum(camera_, chunk.T_cam_tile);
  ProjectedBlock block(camera_);
  std::array<std::int32_t, ProjectedBlock::kSize> in_zone;
  std::array<PointInView, ProjectedBlock::kSize> quantized;
  const ViewQuantizer quantizer = quantizer_;
  ProjectedPoints samples;
  Shard& shard = shards_[chunk.shard];
  const std::size_t most = chunk.first + (chunk.end - chunk.begin);
  if (shard.points.size() < most) shard.points.resize(most + most / 8);
  PointInView* out = shard.points.data() + chunk.first;
  constexpr auto kBoxed = static_cast<std::uint32_t>(TilePoints::kBoxed);
  for (std::uint32_t begin = chunk.begin; begin < chunk.end; begin += kBoxed) {
    if (!frustum.may_contain(chunk.points->boxes[begin / kBoxed])) continue;
    const std::uint32_t n = std::min(chunk.end - begin, kBoxed);
    const auto steps = [&](std::size_t axis) {
      return std::span(chunk.points->position[axis]).subspan(begin, n);
    };
    block.project({steps(0), steps(1), steps(2)}, kPositionStep, R, t);
    for (std::uint32_t i = 0; i < n; ++i) {
      in_zone[i] = region.may_color(block.p_cam(i), chunk.points->range_at(begin + i));
    }
    if (region.has_slices()) {
      for (std::uint32_t i = 0; i < n; ++i) {
        if (in_zone[i] != 0 && !region.in_slices(block.p_cam(i))) in_zone[i] = 0;
      }
    }
    const std::uint32_t first = begin - chunk.begin;
    for (std::uint32_t i = 0; i < quantized.size(); ++i) {
      quantized[i] =
          quantizer.quantize(block.pixel(i), block.depth(i), static_cast<std::uint16_t>(first + i));
    }
    // Branch-free compaction.
    std::size_t in_view = 0, in_region = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      out[in_region] = quantized[i];
      samples.put(in_view, block.pixel(i), block.depth(i));
      in_view += block.in_view(i);
      in_region += block.in_view(i) & (in_zone[i] != 0);
    }
    shard.depth.add(samples, in_view, disc_radius_);
    out += in_region;
    chunk.count += in_region;
  }
}

template <class F>
void VisibleMap::for_each_block(const PointCloud& points_cam, std::size_t begin, std::size_t end,
                                F&& f) const {
  ProjectedBlock block(camera_);
  for (; begin < end; begin += kBlock) {
    const std::size_t block_end = std::min(begin + kBlock, end);
    block.project(std::span(points_cam.position).subspan(begin, block_end - begin),
                  Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero());
    f(begin, block_end, block);
  }
}

void VisibleMap::add_occluders(const PointCloud& points_cam) {
  const std::size_t shard_size = (points_cam.size() + kShards - 1) / kShards;
  parallel_for(kShards, 1, [&](std::size_t shard) {
    DepthBuffer& depth = shards_[shard].depth;
    depth.clear(camera_);
    const std::size_t end = std::min(points_cam.size(), (shard + 1) * shard_size);
    ProjectedPoints samples;
    for_each_block(points_cam, shard * shard_size, end,
                   [&](std::size_t begin, std::size_t block_end, const ProjectedBlock& block) {
                     std::size_t count = 0;
                     for (std::size_t i = 0; i < block_end - begin; ++i) {
                       if (block.in_view(i)) samples.put(count++, block.pixel(i), block.depth(i));
                     }
                     depth.add(samples, count, disc_radius_);
                   });
  });
  for (const Shard& shard : shards_) depth_.add(shard.depth);
}

void VisibleMap::doubt_around(std::vector<Eigen::Vector3f> moving_cam) {
  constexpr float kThinning = 0.5f, kReach = 1.5f;  // m
  for (const Eigen::Vector3f& p : voxel_thinned(std::move(moving_cam), kThinning)) {
    const auto pixel = camera_.project(p.cast<double>());
    if (!pixel) continue;
    depth_.doubt(pixel->cast<float>(), kReach * static_cast<float>(camera_.fx) / p.z());
  }
}

std::vector<std::uint8_t> VisibleMap::find_occluding(const PointCloud& points_cam) const {
  std::vector<std::uint8_t> marks(points_cam.size());
  parallel_chunks(marks.size(), kChunkSize, [&](std::size_t chunk_begin, std::size_t chunk_end) {
    for_each_block(points_cam, chunk_begin, chunk_end,
                   [&](std::size_t begin, std::size_t end, const ProjectedBlock& block) {
                     for (std::size_t i = 0; i < end - begin; ++i) {
                       marks[begin + i] =
                           block.in_view(i) &&
                           depth_.is_in_front(block.pixel(i), block.depth(i), white_zone_end_);
                     }
                   });
  });
  return marks;
}

std::size_t VisibleMap::recolor_chunk(const Chunk& chunk, std::span<FusedColor> colors,
                                      const ViewColors& view, std::uint32_t seed,
                                      std::vector<std::uint32_t>& first_colored) const {
  std::size_t count = 0;
  const std::span<const PointInView> all = points_of(chunk);
  for (std::size_t begin = 0; begin < all.size(); begin += kBlock) {
    const auto points = all.subspan(begin, std::min(kBlock, all.size() - begin));
    ProjectedPoints projected;
    for (std::size_t i = 0; i < points.size(); ++i) {
      projected.put(i, quantizer_.pixel(points[i]), quantizer_.depth(points[i]));
    }
    std::array<std::uint32_t, kBlock> visible;
    const std::size_t n = depth_.find_visible(projected, points.size(), visible);
    for (std::size_t j = 0; j < n; ++j) {
      const std::uint32_t i = visible[j];
      projected.put(j, {projected.u[i], projected.v[i]}, projected.depth[i]);
    }
    ViewColors::Samples seen;
    view.sample(projected, n, seen);
    for (std::size_t j = 0; j < n; ++j) {
      if (seen[j].weight == 0) continue;
      const std::uint32_t index = chunk.begin + points[visible[j]].index;
      if (colors[index].views == 0) first_colored.push_back(index);
      seen[j].code -= chunk.gain_codes;
      if (depth_.is_doubtful({projected.u[j], projected.v[j]})) seen[j].trust_less();
      fuse(seen[j], quick_bits(index, seed), colors[index]);
    }
    count += n;
  }
  return count;
}

std::vector<std::span<FusedColor>> VisibleMap::colors_of_chunks(TileMap& map) const {
  std::vector<std::span<FusedColor>> colors(chunks_.size());
  parallel_for(chunks_.size(), 1, [&](std::size_t first) {
    if (chunks_[first].begin != 0) return;
    // One thread handles all chunks of a tile. It skips a tile without points in the region, since
    // write access may copy the tile.
    const auto end =
        std::find_if(chunks_.begin() + static_cast<std::ptrdiff_t>(first), chunks_.end(),
                     [&](const Chunk& chunk) { return chunk.tile != chunks_[first].tile; });
    const auto last = static_cast<std::size_t>(end - chunks_.begin());
    std::size_t count = 0;
    for (std::size_t k = first; k < last; ++k) count += chunks_[k].count;
    if (count == 0) return;
    const std::span<FusedColor> of_tile = map.colors(chunks_[first].tile);
    std::fill(colors.begin() + static_cast<std::ptrdiff_t>(first),
              colors.begin() + static_cast<std::ptrdiff_t>(last), of_tile);
  });
  return colors;
}

std::size_t VisibleMap::recolor(TileMap& map, const ViewColors& view, int frame) const {
  const auto camera = static_cast<std::uint64_t>(camera_.index);
  Random random =
      Random::of_item(static_cast<std::uint64_t>(frame) << 8 | camera, kRoundingSeed, 0);
  const auto seed = static_cast<std::uint32_t>(random.next());
  const std::vector<std::span<FusedColor>> colors = colors_of_chunks(map);
  std::vector<std::vector<std::uint32_t>> first_colored(chunks_.size());
  const std::size_t count =
      parallel_sum(chunks_.size(), 1, std::size_t{0}, [&](std::size_t k, std::size_t) {
        return recolor_chunk(chunks_[k], colors[k], view, seed, first_colored[k]);
      });
  for (std::size_t k = 0; k < chunks_.size(); ++k) {
    if (first_colored[k].empty()) continue;
    map.put_camera(chunks_[k].tile, first_colored[k], static_cast<std::int8_t>(camera_.index));
  }
  return count;
}

}  // namespace fovea
