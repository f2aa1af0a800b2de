// Nearest neighbours among 3D points. Query in scan order: it is several times faster than
// shuffled.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "fovea/geometry/neighbor.h"
#include "fovea/platform.h"

namespace fovea {

/// kd-tree over float points (nanoflann). The points must outlive it; queries are thread-safe.
class KdTree {
 public:
  static constexpr std::size_t kLeafSize = 16, kLargeLeafSize = 64;

  /// @param leaf_size  most points of a leaf. Trees of kLargeLeafSize take half the memory. The
  ///                   results are the same.
  explicit KdTree(std::span<const Eigen::Vector3f> points, std::size_t leaf_size = kLeafSize);
  ~KdTree();
  KdTree(KdTree&&) noexcept;
  KdTree& operator=(KdTree&&) noexcept;

  using Neighbor = fovea::Neighbor;
  static constexpr float kAnyDistance = 1e18f;

  /// Nearest point within `max_distance`, of equally near ones that of the lowest index;
  /// squared_distance is infinite if there is none.
  Neighbor nearest(const Eigen::Vector3f& query, float max_distance = kAnyDistance) const;

  /// The nearest of the points without a mark.
  /// @param marks  one a point; 0: none
  Neighbor nearest_unmarked(const Eigen::Vector3f& query,
                            std::span<const std::uint8_t> marks) const;

  /// The k nearest points (fewer if there are fewer), nearest first, into `neighbors`.
  void nearest_k(const Eigen::Vector3f& query, std::size_t k,
                 std::vector<Neighbor>& neighbors) const;

 private:
  struct Index;
  std::unique_ptr<Index> index_;
};

}  // namespace fovea
