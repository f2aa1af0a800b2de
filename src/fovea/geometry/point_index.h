// Nearest neighbours among 3D points, by what is fastest for them.
#pragma once

#include <span>
#include <variant>

#include "fovea/geometry/kd_tree.h"
#include "fovea/geometry/point_grid.h"

namespace fovea {

/// Without a spacing the points must outlive it; queries are thread-safe while nothing changes.
class PointIndex {
 public:
  /// @param spacing  about which the points lie apart at least (m), as thinned ones do; 0: some lie
  /// much closer than others
  explicit PointIndex(std::span<const Eigen::Vector3f> points, double spacing = 0)
      : index_(make(points, spacing)) {}

  /// Nearest point within `max_distance`, of equally near ones always the same; squared_distance is
  /// infinite if there is none.
  Neighbor nearest(const Eigen::Vector3f& query, float max_distance) const {
    return std::visit([&](const auto& index) { return index.nearest(query, max_distance); },
                      index_);
  }

  /// One more point, or one less, just as it was: of an index with a spacing only.
  void insert(std::uint32_t index, const Eigen::Vector3f& p) {
    std::get<PointGrid>(index_).insert(index, p);
  }
  void erase(std::uint32_t index, const Eigen::Vector3f& p) {
    std::get<PointGrid>(index_).erase(index, p);
  }

 private:
  /// Edge of the grid's cells over the spacing: the fastest (docs/performance.md).
  static constexpr double kCell = 4;
  using Index = std::variant<KdTree, PointGrid>;

  static Index make(std::span<const Eigen::Vector3f> points, double spacing) {
    if (spacing > 0) return PointGrid(points, static_cast<float>(kCell * spacing));
    return KdTree(points);
  }
  Index index_;
};

}  // namespace fovea
