// Moments of a cloud's points by voxels, for planes through small pieces of surface.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/geometry/voxel_table.h"

namespace fovea {

/// Sums over points, in doubles: no cancellation at kilometres.
struct Moments {
  std::size_t count = 0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();

  void add(const Eigen::Vector3d& p) {
    ++count;
    sum += p;
    squares += p * p.transpose();
  }
  void add(const Moments& other) {
    count += other.count;
    sum += other.sum;
    squares += other.squares;
  }
  Eigen::Vector3d mean() const { return sum / static_cast<double>(count); }
  /// Mean of (p - center)(p - center)^T.
  Eigen::Matrix3d spread_about(const Eigen::Vector3d& center) const {
    const auto n = static_cast<double>(count);
    const Eigen::Matrix3d cross = sum * center.transpose() / n;
    return squares / n - cross - cross.transpose() + center * center.transpose();
  }
};

class VoxelMoments {
 public:
  /// @param edge  of a voxel, m
  VoxelMoments(const std::vector<Eigen::Vector3f>& points, float edge);

  std::size_t size() const { return moments_.size(); }  ///< voxels with points
  /// Of one of the points.
  std::uint32_t voxel_of(const Eigen::Vector3f& point) const {
    return table_.find(table_.voxel_of(point));
  }
  const Moments& of(std::size_t voxel) const { return moments_[voxel]; }
  /// Of a voxel and its 26 neighbours.
  Moments around(std::size_t voxel) const;

 private:
  VoxelTable table_;
  std::vector<Moments> moments_;
};

}  // namespace fovea
