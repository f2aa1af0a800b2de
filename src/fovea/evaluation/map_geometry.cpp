#include "fovea/evaluation/map_geometry.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fovea/core/parallel.h"
#include "fovea/evaluation/distribution.h"
#include "fovea/evaluation/voxel_moments.h"
#include "fovea/geometry/kd_tree.h"
#include "fovea/geometry/voxel_grid.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 512;

/// RMS distance of the patch's points to the plane of the block; negative where it is not flat.
float patch_thickness(const Moments& patch, const Moments& block) {
  const Eigen::Vector3d center = block.mean();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(block.spread_about(center));
  const Eigen::Vector3d spread = solver.eigenvalues().cwiseMax(0).cwiseSqrt();
  if (spread(0) > PlaneThickness::kFlat * spread(1) ||
      spread(1) < PlaneThickness::kFlat * spread(2)) {
    return -1;
  }
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  const double squared = normal.dot(patch.spread_about(center) * normal);
  return static_cast<float>(std::sqrt(std::max(0.0, squared)));
}

}  // namespace

PlaneThickness plane_thickness(const std::vector<Eigen::Vector3f>& map) {
  const VoxelMoments patches(map, PlaneThickness::kPatch);
  std::vector<float> thickness(patches.size(), -1);
  parallel_for(patches.size(), kGrain, [&](std::size_t patch) {
    if (patches.of(patch).count < PlaneThickness::kMinPoints) return;
    thickness[patch] = patch_thickness(patches.of(patch), patches.around(patch));
  });
  std::erase_if(thickness, [](float value) { return value < 0; });
  PlaneThickness result;
  result.patches = thickness.size();
  result.thickness = distribution(std::move(thickness)).median;
  return result;
}

ScanScores scan_scores(const std::vector<Eigen::Vector3f>& map,
                       const std::vector<Eigen::Vector3f>& scan,
                       const std::vector<float>& distances) {
  constexpr float kVoxel = 0.05f;
  const std::vector<std::uint32_t> samples = voxel_sample(map, kVoxel);
  std::vector<float> to_scan(samples.size());
  if (!scan.empty()) {
    const KdTree tree(scan);
    const float reach = static_cast<float>(ScanScores::kCentimetres.back()) / 100 + 0.01f;
    parallel_for(samples.size(), kGrain, [&](std::size_t i) {
      to_scan[i] = std::sqrt(tree.nearest(map[samples[i]], reach).squared_distance);
    });
  }
  ScanScores scores;
  scores.map_samples = samples.size();
  for (std::size_t k = 0; k < ScanScores::kCentimetres.size(); ++k) {
    const float bound = static_cast<float>(ScanScores::kCentimetres[k]) / 100;
    const double precision = scan.empty() ? Distribution::kNone : share_within(to_scan, bound);
    const double recall = share_within(distances, bound);
    scores.precision[k] = precision;
    scores.recall[k] = recall;
    scores.f_score[k] = precision + recall == 0 ? 0 : 2 * precision * recall / (precision + recall);
  }
  return scores;
}

}  // namespace fovea
