#include "fovea/map/colored_points.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "fovea/core/parallel.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/geometry/voxel_members.h"

namespace fovea {
namespace {

constexpr std::size_t kRunLength = 1024;
constexpr float kVoxelEdge = 0.1f;
constexpr float kMaxSpacing = 0.1f;  // a lone point says nothing of a surface farther off
constexpr std::size_t kGrain = 4096;

VoxelMembers sort_into(const VoxelTable& table, const std::vector<Eigen::Vector3f>& points) {
  std::vector<std::uint32_t> voxel(points.size());
  parallel_for(points.size(), kGrain,
               [&](std::size_t i) { voxel[i] = table.find(table.voxel_of(points[i])); });
  return {voxel, table.size()};
}

}  // namespace

ColoredPoints colored_points(PointCloud map_local) {
  std::vector<std::uint8_t> is_uncolored;
  is_uncolored.reserve(map_local.size());
  for (const std::int8_t camera : map_local.camera) is_uncolored.push_back(camera == kNoCamera);
  map_local.drop(is_uncolored);
  return all_points(std::move(map_local));
}

ColoredPoints all_points(PointCloud map_local) {
  ColoredPoints points;
  points.origin = map_local.origin;
  points.position = std::move(map_local.position);
  points.color = std::move(map_local.color);
  points.interpolated = std::move(map_local.interpolated);
  points.reason = std::move(map_local.reason);
  points.frame = std::move(map_local.frame);
  points.sampling_level = std::move(map_local.sampling_level);
  points.runs = make_runs(points.position, kRunLength);
  return points;
}

std::vector<PointRun> make_runs(const std::vector<Eigen::Vector3f>& position, std::size_t length) {
  std::vector<PointRun> runs;
  for (std::size_t begin = 0; begin < position.size(); begin += length) {
    const std::size_t end = std::min(position.size(), begin + length);
    PointRun run{static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end),
                 position[begin], position[begin]};
    for (std::size_t i = begin; i < end; ++i) {
      run.low = run.low.cwiseMin(position[i]);
      run.high = run.high.cwiseMax(position[i]);
    }
    runs.push_back(run);
  }
  return runs;
}

namespace {

/// As sample_spacing(), without a limit.
std::vector<float> spacing_by_density(const std::vector<Eigen::Vector3f>& position) {
  VoxelTable table(kVoxelEdge);
  std::vector<std::uint32_t> voxel(position.size()), count;
  for (std::size_t i = 0; i < position.size(); ++i) {
    voxel[i] = table.insert(table.voxel_of(position[i]));
    if (voxel[i] == count.size()) count.push_back(0);
    ++count[voxel[i]];
  }
  // A surface through the middle voxel has about 0.3 m x 0.3 m inside the block, however it lies;
  // inside the voxel alone it may have next to nothing.
  std::vector<float> spacing(table.size());
  parallel_for(table.size(), kGrain, [&](std::size_t id) {
    std::uint32_t points = 0;
    table.for_each_around(table.voxel(static_cast<std::uint32_t>(id)),
                          [&](std::uint32_t near) { points += count[near]; });
    spacing[id] = 3 * kVoxelEdge / std::sqrt(static_cast<float>(points));
  });
  std::vector<float> per_point(position.size());
  parallel_for(position.size(), kGrain, [&](std::size_t i) { per_point[i] = spacing[voxel[i]]; });
  return per_point;
}

}  // namespace

std::vector<float> sample_spacing(const std::vector<Eigen::Vector3f>& position) {
  std::vector<float> spacing = spacing_by_density(position);
  for (float& value : spacing) value = std::min(value, kMaxSpacing);
  return spacing;
}

std::vector<float> sample_spacing(const ColoredPoints& map, double cell) {
  if (map.sampling_level.empty()) return sample_spacing(map.position);
  constexpr float kMargin = 1.5f, kIsolated = 2;  // cells
  std::vector<float> spacing = spacing_by_density(map.position);
  for (std::size_t i = 0; i < spacing.size(); ++i) {
    const float own = static_cast<float>(cell) * float(1 << map.sampling_level[i]);
    spacing[i] = spacing[i] > kIsolated * own ? own / 2 : std::min(spacing[i], kMargin * own);
  }
  return spacing;
}

double surface_density(const std::vector<Eigen::Vector3f>& map,
                       const std::vector<Eigen::Vector3f>& evaluated) {
  if (evaluated.empty()) return std::numeric_limits<double>::quiet_NaN();
  constexpr float kRadius = kVoxelEdge;  // so that the block around a voxel holds the whole ball
  const std::vector<std::uint32_t> samples = voxel_sample(evaluated, kVoxelEdge);
  VoxelTable table(kVoxelEdge);
  for (const std::uint32_t sample : samples) {
    for (const VoxelTable::Voxel& v : VoxelTable::block_around(table.voxel_of(evaluated[sample]))) {
      table.insert(v);
    }
  }
  const VoxelMembers sorted = sort_into(table, map);
  const auto count_near = [&](std::size_t begin, std::size_t end) {
    double count = 0;
    for (std::size_t s = begin; s < end; ++s) {
      const Eigen::Vector3f& center = evaluated[samples[s]];
      table.for_each_around(table.voxel_of(center), [&](std::uint32_t near) {
        for (const std::uint32_t i : sorted.of(near)) {
          if ((map[i] - center).squaredNorm() <= kRadius * kRadius) ++count;
        }
      });
    }
    return count;
  };
  const double near = parallel_sum(samples.size(), kGrain / 8, 0.0, count_near);
  return near / static_cast<double>(samples.size()) / (std::numbers::pi * kRadius * kRadius);
}

}  // namespace fovea
