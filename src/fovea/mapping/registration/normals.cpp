#include "fovea/mapping/registration/normals.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <bit>

#include "fovea/base/parallel.h"
#include "fovea/geometry/kd_tree.h"
#include "fovea/geometry/point_grid.h"

namespace fovea {
namespace {

constexpr std::size_t kGrain = 256;

/// A neighbourhood is a line, and has no plane, if its second variance is below this share of its
/// first.
constexpr double kLineRatio = 1e-4;

/// Variances of points around one of them, which is near: squares of coordinates near 100 m would
/// cancel.
class Covariance {
 public:
  explicit Covariance(const Eigen::Vector3f& center) : center_(center) {}

  void add(const Eigen::Vector3f& point) {
    const Eigen::Vector3f p = point - center_;
    sum_ += p;
    diagonal_ += p.cwiseProduct(p);
    beside_ += Eigen::Vector3f(p.x() * p.y(), p.x() * p.z(), p.y() * p.z());
    ++count_;
  }

  /// Unit, towards the origin; zero where there is no plane.
  Eigen::Vector3f normal() const {
    if (count_ < 3) return Eigen::Vector3f::Zero();
    const double n = count_;
    const Eigen::Vector3d mean = sum_.cast<double>() / n;
    Eigen::Matrix3d covariance;
    covariance.diagonal() = diagonal_.cast<double>() / n;
    covariance(0, 1) = covariance(1, 0) = double(beside_[0]) / n;
    covariance(0, 2) = covariance(2, 0) = double(beside_[1]) / n;
    covariance(1, 2) = covariance(2, 1) = double(beside_[2]) / n;
    covariance -= mean * mean.transpose();

    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance);
    const Eigen::Vector3d& variances = solver.eigenvalues();
    if (!(variances[1] > kLineRatio * variances[2])) return Eigen::Vector3f::Zero();
    const Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>().normalized();
    return normal.dot(center_) > 0 ? Eigen::Vector3f(-normal) : normal;
  }

 private:
  Eigen::Vector3f center_, sum_ = Eigen::Vector3f::Zero(), diagonal_ = Eigen::Vector3f::Zero(),
                           beside_ = Eigen::Vector3f::Zero();
  int count_ = 0;
};

/// Points of some cells, and which of them are nearest to one.
class Neighborhood {
 public:
  explicit Neighborhood(std::size_t count) : nearest_(count) {}

  void clear() { points_.clear(); }
  void add(std::span<const Eigen::Vector3f> points) {
    points_.insert(points_.end(), points.begin(), points.end());
  }
  std::size_t size() const { return points_.size(); }

  /// Finds the nearest to `center`; false if there are too few.
  bool find(const Eigen::Vector3f& center) {
    if (points_.size() < nearest_.size()) return false;
    // Squared distance and number in one integer: floats that are not negative compare like their
    // bits.
    std::fill(nearest_.begin(), nearest_.end(), ~std::uint64_t{0});
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      const float squared = (points_[i] - center).squaredNorm();
      const std::uint64_t key = std::uint64_t{std::bit_cast<std::uint32_t>(squared)} << 32 | i;
      if (key >= nearest_.back()) continue;
      std::size_t place = nearest_.size() - 1;
      for (; place > 0 && nearest_[place - 1] > key; --place) nearest_[place] = nearest_[place - 1];
      nearest_[place] = key;
    }
    return true;
  }
  /// Of the farthest that was found.
  float squared_distance() const {
    return std::bit_cast<float>(static_cast<std::uint32_t>(nearest_.back() >> 32));
  }
  Eigen::Vector3f normal(const Eigen::Vector3f& center) const {
    Covariance covariance(center);
    for (const std::uint64_t key : nearest_) covariance.add(points_[key & 0xffffffff]);
    return covariance.normal();
  }

 private:
  std::vector<Eigen::Vector3f> points_;
  std::vector<std::uint64_t> nearest_;  // nearest first
};

/// Edge of the grids' cells over the points' spacing, and over that of the grid before: where
/// points are far apart, wider cells are looked at.
constexpr float kFinestCell = 2, kCoarser = 4;
constexpr int kLevels = 4;
constexpr std::size_t kCellGrain = 64;

/// Normals of the points not yet done whose neighbours all lie in the cells around.
void look_around(const PointGrid& grid, std::span<const Eigen::Vector3f> points, int neighbors,
                 std::vector<std::uint8_t>& done, std::vector<Eigen::Vector3f>& normals) {
  parallel_chunks(grid.cells(), kCellGrain, [&](std::size_t begin, std::size_t end) {
    Neighborhood neighborhood(static_cast<std::size_t>(neighbors));
    for (auto cell = static_cast<std::uint32_t>(begin); cell < end; ++cell) {
      neighborhood.clear();
      for (const std::uint32_t i : grid.points_of(cell)) {
        if (done[i] != 0) continue;
        if (neighborhood.size() == 0) {
          grid.for_each_around(cell, [&](auto near) { neighborhood.add(near); });
        }
        if (!neighborhood.find(points[i])) break;
        if (neighborhood.squared_distance() > grid.cell() * grid.cell()) continue;
        normals[i] = neighborhood.normal(points[i]);
        done[i] = 1;
      }
    }
  });
}

std::vector<Eigen::Vector3f> normals_by_grid(std::span<const Eigen::Vector3f> points, int neighbors,
                                             double spacing) {
  std::vector<Eigen::Vector3f> normals(points.size());
  std::vector<std::uint8_t> done(points.size(), 0);
  float cell = kFinestCell * static_cast<float>(spacing);
  for (int level = 0; level < kLevels; ++level, cell *= kCoarser) {
    look_around(PointGrid(points, cell), points, neighbors, done, normals);
  }
  // Far from everything.
  Neighborhood all(std::min(static_cast<std::size_t>(neighbors), points.size()));
  all.add(points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (done[i] == 0 && all.find(points[i])) normals[i] = all.normal(points[i]);
  }
  return normals;
}

std::vector<Eigen::Vector3f> normals_by_tree(std::span<const Eigen::Vector3f> points,
                                             int neighbors) {
  const KdTree tree(points);
  std::vector<Eigen::Vector3f> normals(points.size());
  parallel_chunks(points.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<KdTree::Neighbor> found;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest_k(points[i], static_cast<std::size_t>(neighbors), found);
      Covariance covariance(points[i]);
      for (const KdTree::Neighbor& neighbor : found) covariance.add(points[neighbor.index]);
      normals[i] = covariance.normal();
    }
  });
  return normals;
}

}  // namespace

std::vector<Eigen::Vector3f> estimate_normals(std::span<const Eigen::Vector3f> points,
                                              int neighbors, double spacing) {
  return spacing > 0 ? normals_by_grid(points, neighbors, spacing)
                     : normals_by_tree(points, neighbors);
}

}  // namespace fovea
