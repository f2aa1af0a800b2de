#include "fovea/geometry/voxel_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace fovea {
namespace {

/// 21 bits an axis: +-1 million voxels around the origin.
std::uint64_t voxel_key(const Eigen::Vector3f& p, float inverse_size) {
  const auto axis = [&](float value) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value * inverse_size)) +
                                      (1 << 20)) &
           0x1fffff;
  };
  return axis(p.x()) | axis(p.y()) << 21 | axis(p.z()) << 42;
}

}  // namespace

std::vector<std::uint32_t> voxel_sample(std::span<const Eigen::Vector3f> points, float size) {
  if (!(size > 0)) throw std::invalid_argument("the voxel size must be positive");
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keyed(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    keyed[i] = {voxel_key(points[i], 1 / size), i};
  }
  std::sort(keyed.begin(), keyed.end());

  std::vector<std::uint32_t> chosen;
  for (std::size_t begin = 0; begin < keyed.size();) {
    std::size_t end = begin;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    const Eigen::Vector3f& anchor = points[keyed[begin].second];  // keeps the sum precise
    for (; end < keyed.size() && keyed[end].first == keyed[begin].first; ++end) {
      sum += points[keyed[end].second] - anchor;
    }
    const Eigen::Vector3f mean = anchor + sum / static_cast<float>(end - begin);
    std::uint32_t best = keyed[begin].second;
    float best_distance = std::numeric_limits<float>::infinity();
    for (std::size_t i = begin; i < end; ++i) {
      const float distance = (points[keyed[i].second] - mean).squaredNorm();
      if (distance < best_distance) {
        best_distance = distance;
        best = keyed[i].second;
      }
    }
    chosen.push_back(best);
    begin = end;
  }
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
