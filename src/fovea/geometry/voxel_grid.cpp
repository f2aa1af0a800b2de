#include "fovea/geometry/voxel_grid.h"

#include <limits>
#include <stdexcept>

#include "fovea/geometry/voxel_table.h"

namespace fovea {
namespace {

struct VoxelMean {
  Eigen::Vector3f anchor;                         // its first point
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();  // of offsets from the anchor, for precision
  std::uint32_t count = 0;
  std::uint32_t nearest = 0;  // index of the point nearest to the mean
  float squared_distance = std::numeric_limits<float>::infinity();
};

/// Consecutive points in one voxel. In the order of a sweep most points are part of such a run.
struct Run {
  std::uint32_t voxel, begin, end;
};

std::vector<Run> runs_in_voxels(std::span<const Eigen::Vector3f> points, VoxelTable& table) {
  std::vector<Run> runs;
  runs.reserve(points.size() / 2);
  for (std::uint32_t begin = 0, end = 0; begin < points.size(); begin = end) {
    const VoxelTable::Voxel own = table.voxel_of(points[begin]);
    for (end = begin + 1; end < points.size() && table.voxel_of(points[end]) == own;) ++end;
    runs.push_back({table.insert(own), begin, end});
  }
  return runs;
}

}  // namespace

std::vector<std::uint32_t> voxel_sample(std::span<const Eigen::Vector3f> points, float size) {
  if (!(size > 0)) throw std::invalid_argument("the voxel size must be positive");
  VoxelTable table(size);
  std::vector<VoxelMean> means;
  means.reserve(points.size() / 4);
  const std::vector<Run> runs = runs_in_voxels(points, table);
  for (const Run& run : runs) {
    if (run.voxel == means.size()) means.push_back({.anchor = points[run.begin]});
    VoxelMean& mean = means[run.voxel];
    const Eigen::Vector3f anchor = mean.anchor;
    Eigen::Vector3f sum = mean.sum;
    for (std::uint32_t i = run.begin; i < run.end; ++i) sum += points[i] - anchor;
    mean.sum = sum;
    mean.count += run.end - run.begin;
  }
  for (VoxelMean& mean : means) mean.sum = mean.anchor + mean.sum / static_cast<float>(mean.count);
  for (const Run& run : runs) {
    VoxelMean& mean = means[run.voxel];
    const Eigen::Vector3f center = mean.sum;
    std::uint32_t nearest = mean.nearest;
    float least = mean.squared_distance;
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const float squared = (points[i] - center).squaredNorm();
      if (squared < least) {
        least = squared;
        nearest = i;
      }
    }
    mean.nearest = nearest;
    mean.squared_distance = least;
  }
  std::vector<std::uint8_t> is_chosen(points.size(), 0);
  for (const VoxelMean& mean : means) is_chosen[mean.nearest] = 1;
  // Branch-free compaction.
  std::vector<std::uint32_t> chosen(means.size() + 1);
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    chosen[count] = i;
    count += is_chosen[i];
  }
  chosen.resize(count);
  return chosen;
}

std::vector<Eigen::Vector3f> voxel_thinned(std::vector<Eigen::Vector3f> points, float size) {
  if (size == 0) return points;
  std::vector<Eigen::Vector3f> chosen;
  for (const std::uint32_t i : voxel_sample(points, size)) chosen.push_back(points[i]);
  return chosen;
}

}  // namespace fovea
