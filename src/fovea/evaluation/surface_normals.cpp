#include "fovea/evaluation/surface_normals.h"

#include <Eigen/Eigenvalues>

#include "fovea/core/parallel.h"
#include "fovea/evaluation/voxel_moments.h"

namespace fovea {
namespace {

constexpr float kVoxelEdge = 0.1f;
constexpr std::size_t kMinPoints = 6;
constexpr double kFlat = 0.2;   // least variance over the middle one: a surface, not a heap
constexpr double kWide = 0.05;  // middle variance over the greatest: a surface, not a line
constexpr std::size_t kGrain = 1024;

Eigen::Vector3f normal_of(const Moments& total) {
  if (total.count < kMinPoints) return Eigen::Vector3f::Zero();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(total.spread_about(total.mean()));
  const Eigen::Vector3d& spread = solver.eigenvalues();  // increasing
  if (!(spread[0] < kFlat * spread[1] && spread[1] > kWide * spread[2])) {
    return Eigen::Vector3f::Zero();
  }
  return solver.eigenvectors().col(0).cast<float>();
}

}  // namespace

std::vector<Eigen::Vector3f> surface_normals(const std::vector<Eigen::Vector3f>& position) {
  const VoxelMoments voxels(position, kVoxelEdge);
  std::vector<Eigen::Vector3f> normal(voxels.size());
  parallel_for(normal.size(), kGrain,
               [&](std::size_t voxel) { normal[voxel] = normal_of(voxels.around(voxel)); });
  std::vector<Eigen::Vector3f> per_point(position.size());
  parallel_for(position.size(), kGrain,
               [&](std::size_t i) { per_point[i] = normal[voxels.voxel_of(position[i])]; });
  return per_point;
}

}  // namespace fovea
