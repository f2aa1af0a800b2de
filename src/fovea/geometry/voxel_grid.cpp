#include "fovea/geometry/voxel_grid.h"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "fovea/geometry/voxel_table.h"

namespace fovea {
namespace {

struct VoxelMean {
  Eigen::Vector3f anchor;                         // its first point, which keeps the sum precise
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();  // of what the others are off it
  std::uint32_t count = 0;
  std::uint32_t nearest = 0;  // point to the mean
  float squared_distance = std::numeric_limits<float>::infinity();
};

}  // namespace

std::vector<std::uint32_t> voxel_sample(std::span<const Eigen::Vector3f> points, float size) {
  if (!(size > 0)) throw std::invalid_argument("the voxel size must be positive");
  VoxelTable table(size);
  std::vector<VoxelMean> means;
  std::vector<std::uint32_t> voxel(points.size());
  VoxelTable::Voxel last = VoxelTable::Voxel::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    // Points in the order of a sweep mostly share a voxel with the one before.
    const VoxelTable::Voxel own = table.voxel_of(points[i]);
    voxel[i] = i > 0 && own == last ? voxel[i - 1] : table.insert(own);
    last = own;
    if (voxel[i] == means.size()) means.push_back({.anchor = points[i]});
    VoxelMean& mean = means[voxel[i]];
    mean.sum += points[i] - mean.anchor;
    ++mean.count;
  }
  for (VoxelMean& mean : means) mean.sum = mean.anchor + mean.sum / static_cast<float>(mean.count);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    VoxelMean& mean = means[voxel[i]];
    const float squared = (points[i] - mean.sum).squaredNorm();
    if (squared < mean.squared_distance) {
      mean.squared_distance = squared;
      mean.nearest = i;
    }
  }
  std::vector<std::uint32_t> chosen;
  chosen.reserve(means.size());
  for (const VoxelMean& mean : means) chosen.push_back(mean.nearest);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::vector<Eigen::Vector3f> voxel_thinned(std::vector<Eigen::Vector3f> points, float size) {
  if (size == 0) return points;
  std::vector<Eigen::Vector3f> chosen;
  for (const std::uint32_t i : voxel_sample(points, size)) chosen.push_back(points[i]);
  return chosen;
}

}  // namespace fovea
