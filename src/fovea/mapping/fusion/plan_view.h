// Where there is anything, seen from above.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fovea/geometry/rigid_motion.h"

namespace fovea {

/// Maps end a few metres beside the road and above it: what one has and the other has not says
/// nothing against their being one place.
class PlanView {
 public:
  /// @param points  m, z up, finite, within some 100 m of the origin
  explicit PlanView(std::span<const Eigen::Vector3f> points);

  /// Those of other points in whose column there is something, not more than `height` m below or
  /// above all of that.
  std::vector<Eigen::Vector3f> covered(std::span<const Eigen::Vector3f> points,
                                       const RigidMotion& T_plan_points, double height) const;

 private:
  struct Column {
    float low = 1, high = 0;  // m; nothing there while low > high
  };
  bool covers(const Eigen::Vector3f& p, float height) const;

  Eigen::Vector2i first_ = Eigen::Vector2i::Zero(), size_ = Eigen::Vector2i::Zero();  // columns
  std::vector<Column> columns_;                                                       // row by row
};

}  // namespace fovea
