#include "fovea/evaluation/seams.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "fovea/core/median.h"
#include "fovea/evaluation/distribution.h"
#include "fovea/geometry/voxel_members.h"

namespace fovea {
namespace {

constexpr float kReach = 0.03f;            // m
constexpr std::size_t kLeastPlaces = 100;  // of a pair of views

using View = std::pair<int, int>;  // frame, camera
using Steps = std::array<std::vector<double>, 3>;

/// Mean codes of the points of each view.
std::map<View, Eigen::Array3d> colors_by_view(const PointCloud& points,
                                              std::span<const std::uint32_t> indices) {
  std::map<View, std::pair<Eigen::Array3d, int>> sums;
  for (const std::uint32_t i : indices) {
    auto& [sum, count] =
        sums.try_emplace({points.frame[i], points.camera[i]}, Eigen::Array3d::Zero(), 0)
            .first->second;
    sum += codes_of(points.color[i]).cast<double>();
    ++count;
  }
  std::map<View, Eigen::Array3d> means;
  for (const auto& [view, sum] : sums) means[view] = sum.first / sum.second;
  return means;
}

}  // namespace

SeamFigures find_seams(const PointCloud& points) {
  VoxelTable table(kReach);
  std::vector<std::uint32_t> voxel(points.size(), VoxelTable::kNone);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points.camera[i] == kNoCamera || points.frame[i] < 0) continue;
    voxel[i] = table.insert(table.voxel_of(points.position[i]));
  }
  const VoxelMembers members(voxel, table.size());
  std::map<std::pair<View, View>, Steps> steps;
  for (std::size_t v = 0; v < table.size(); ++v) {
    const auto colors = colors_by_view(points, members.of(v));
    for (auto a = colors.begin(); a != colors.end(); ++a) {
      for (auto b = std::next(a); b != colors.end(); ++b) {
        Steps& of_pair = steps[{a->first, b->first}];
        for (std::size_t c = 0; c < 3; ++c) {
          of_pair[c].push_back(b->second[Eigen::Index(c)] - a->second[Eigen::Index(c)]);
        }
      }
    }
  }
  SeamFigures figures;
  std::vector<float> sizes;
  for (auto& [views, of_pair] : steps) {
    if (of_pair[0].size() < kLeastPlaces) continue;
    ++figures.pairs;
    for (std::vector<double>& of_channel : of_pair) {
      const double codes = std::abs(median_of(std::move(of_channel)));
      sizes.push_back(static_cast<float>(100 * (std::exp2(codes / kColorCodesPerStop) - 1)));
    }
  }
  figures.p95_percent = distribution(std::move(sizes)).p95;
  return figures;
}

}  // namespace fovea
