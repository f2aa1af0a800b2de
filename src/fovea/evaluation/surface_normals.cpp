#include "fovea/evaluation/surface_normals.h"

#include <Eigen/Eigenvalues>

#include "fovea/base/parallel.h"
#include "fovea/geometry/voxel_table.h"

namespace fovea {
namespace {

constexpr float kVoxelEdge = 0.1f;
constexpr std::uint32_t kMinPoints = 6;
constexpr double kFlat = 0.2;   // least variance over the middle one: a surface, not a heap
constexpr double kWide = 0.05;  // middle variance over the greatest: a surface, not a line
constexpr std::size_t kGrain = 1024;

/// Sums over the points of a voxel.
struct Moments {
  std::uint32_t points = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
};

Eigen::Vector3f normal_of(const Moments& total) {
  if (total.points < kMinPoints) return Eigen::Vector3f::Zero();
  const auto n = static_cast<double>(total.points);
  const Eigen::Vector3d mean = total.sum / n;
  const Eigen::Matrix3d covariance = total.products / n - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d& spread = solver.eigenvalues();  // increasing
  if (!(spread[0] < kFlat * spread[1] && spread[1] > kWide * spread[2])) {
    return Eigen::Vector3f::Zero();
  }
  return solver.eigenvectors().col(0).cast<float>();
}

}  // namespace

std::vector<Eigen::Vector3f> surface_normals(const std::vector<Eigen::Vector3f>& position) {
  VoxelTable table(kVoxelEdge);
  std::vector<std::uint32_t> voxel(position.size());
  std::vector<Moments> moments;
  for (std::size_t i = 0; i < position.size(); ++i) {
    voxel[i] = table.insert(table.voxel_of(position[i]));
    if (voxel[i] == moments.size()) moments.emplace_back();
    Moments& own = moments[voxel[i]];
    const Eigen::Vector3d p = position[i].cast<double>();  // doubles: no cancellation at kilometres
    ++own.points;
    own.sum += p;
    own.products += p * p.transpose();
  }
  std::vector<Eigen::Vector3f> normal(table.size());
  parallel_for(table.size(), kGrain, [&](std::size_t id) {
    Moments total;
    for (const VoxelTable::Voxel& v :
         VoxelTable::block_around(table.voxel(static_cast<std::uint32_t>(id)))) {
      const std::uint32_t neighbor = table.find(v);
      if (neighbor == VoxelTable::kNone) continue;
      total.points += moments[neighbor].points;
      total.sum += moments[neighbor].sum;
      total.products += moments[neighbor].products;
    }
    normal[id] = normal_of(total);
  });
  std::vector<Eigen::Vector3f> per_point(position.size());
  parallel_for(position.size(), kGrain, [&](std::size_t i) { per_point[i] = normal[voxel[i]]; });
  return per_point;
}

}  // namespace fovea
