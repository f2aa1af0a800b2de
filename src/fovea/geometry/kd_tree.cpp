#include "fovea/geometry/kd_tree.h"

#include <bit>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>

namespace fovea {
namespace {

struct PointsAdaptor {
  std::span<const Eigen::Vector3f> points;
  std::size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(std::size_t i, std::size_t dim) const { return points[i][Eigen::Index(dim)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

/// Squared distances. Which child is looked into first shall be a branch, which the processor
/// foresees and reads ahead of. Clang makes a selection of it, which waits for the node: the
/// registration of variant E6 took 1.2 times as long.
struct SquaredDistance : nanoflann::L2_Simple_Adaptor<float, PointsAdaptor> {
  using L2_Simple_Adaptor::L2_Simple_Adaptor;
  float accum_dist(float a, float b, std::size_t) const {
    asm volatile("" : : "r"(std::bit_cast<std::uint32_t>(b)));
    return (a - b) * (a - b);
  }
};

using NanoflannTree =
    nanoflann::KDTreeSingleIndexAdaptor<SquaredDistance, PointsAdaptor, 3, std::uint32_t>;

/// nanoflann result set that keeps one point within a bound; of equally near ones the lowest index.
class NearestResult {
 public:
  using DistanceType = float;
  explicit NearestResult(float squared_bound) { set_bound(squared_bound); }

  const KdTree::Neighbor& best() const { return best_; }

  std::size_t size() const { return std::isfinite(best_.squared_distance) ? 1 : 0; }
  bool full() const { return true; }
  float worstDist() const { return limit_; }
  bool addPoint(float squared, std::uint32_t index) {
    if (squared < best_.squared_distance ||
        (squared == best_.squared_distance && index < best_.index)) {
      best_ = {index, squared};
      set_bound(squared);
    }
    return true;
  }

 private:
  /// nanoflann drops whatever is not below worstDist(), so that must lie just above the bound, or
  /// which of two equally near points is found would depend on the leaves they are in.
  void set_bound(float squared) {
    // As std::nextafter(), whose call takes 4 % of that registration.
    limit_ = std::isfinite(squared)
                 ? std::bit_cast<float>(std::bit_cast<std::uint32_t>(squared) + 1)
                 : squared;
  }

  KdTree::Neighbor best_{0, std::numeric_limits<float>::infinity()};
  float limit_ = 0;
};

/// The same for points without a mark.
class NearestUnmarked : public NearestResult {
 public:
  NearestUnmarked(float squared_bound, std::span<const std::uint8_t> marks)
      : NearestResult(squared_bound), marks_(marks) {}

  bool addPoint(float squared, std::uint32_t index) {
    return marks_[index] != 0 || NearestResult::addPoint(squared, index);
  }

 private:
  std::span<const std::uint8_t> marks_;
};

}  // namespace

struct KdTree::Index {
  PointsAdaptor adaptor;
  NanoflannTree tree;
  Index(std::span<const Eigen::Vector3f> points, std::size_t leaf_size)
      : adaptor{points}, tree(3, adaptor, nanoflann::KDTreeSingleIndexAdaptorParams(leaf_size)) {}
};

KdTree::KdTree(std::span<const Eigen::Vector3f> points, std::size_t leaf_size)
    : index_(std::make_unique<Index>(points, leaf_size)) {}
KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

KdTree::Neighbor KdTree::nearest(const Eigen::Vector3f& query, float max_distance) const {
  NearestResult result(max_distance * max_distance);
  if (!index_->adaptor.points.empty()) {
    index_->tree.findNeighbors(result, query.data(), nanoflann::SearchParams());
  }
  return result.best();
}

KdTree::Neighbor KdTree::nearest_unmarked(const Eigen::Vector3f& query,
                                          std::span<const std::uint8_t> marks) const {
  NearestUnmarked result(kAnyDistance * kAnyDistance, marks);
  if (!index_->adaptor.points.empty()) {
    index_->tree.findNeighbors(result, query.data(), nanoflann::SearchParams());
  }
  return result.best();
}

void KdTree::nearest_k(const Eigen::Vector3f& query, std::size_t k,
                       std::vector<Neighbor>& neighbors) const {
  static thread_local std::vector<std::uint32_t> indices;
  static thread_local std::vector<float> squared;
  indices.resize(k);
  squared.resize(k);
  const std::size_t found =
      k == 0 || index_->adaptor.points.empty()
          ? 0
          : index_->tree.knnSearch(query.data(), k, indices.data(), squared.data());
  neighbors.resize(found);
  for (std::size_t i = 0; i < found; ++i) neighbors[i] = {indices[i], squared[i]};
}

}  // namespace fovea
