#include "fovea/mapping/registration/normals.h"

#include <Eigen/Eigenvalues>

#include "fovea/base/parallel.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 256;

/// A neighbourhood is a line, and has no plane, if its second variance is below this share of its
/// first.
constexpr double kLineRatio = 1e-4;

Eigen::Vector3f plane_normal(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& center,
                             std::span<const KdTree::Neighbor> neighbors) {
  if (neighbors.size() < 3) return Eigen::Vector3f::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const KdTree::Neighbor& neighbor : neighbors) {
    // Relative to the point itself: squares of coordinates near 100 m would cancel.
    const Eigen::Vector3d p = (points[neighbor.index] - center).cast<double>();
    sum += p;
    squares += p * p.transpose();
  }
  const double n = static_cast<double>(neighbors.size());
  const Eigen::Matrix3d covariance = squares / n - sum * sum.transpose() / (n * n);

  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.computeDirect(covariance);
  const Eigen::Vector3d& variances = solver.eigenvalues();
  if (!(variances[1] > kLineRatio * variances[2])) return Eigen::Vector3f::Zero();
  const Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>().normalized();
  return normal.dot(center) > 0 ? Eigen::Vector3f(-normal) : normal;
}

}  // namespace

std::vector<Eigen::Vector3f> estimate_normals(std::span<const Eigen::Vector3f> points,
                                              const KdTree& tree, int neighbors) {
  std::vector<Eigen::Vector3f> normals(points.size());
  parallel_chunks(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<KdTree::Neighbor> found;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest_k(points[i], static_cast<std::size_t>(neighbors), found);
      normals[i] = plane_normal(points, points[i], found);
    }
  });
  return normals;
}

}  // namespace fovea
