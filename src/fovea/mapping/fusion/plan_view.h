// Occupied columns of a map, seen from above.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "fovea/rigid_motion.h"

namespace fovea {

/// Restricts a comparison of two maps to the space that both cover. Maps end a few meters beside
/// and above the road, so points that only one of them has are no evidence against one place.
class PlanView {
 public:
  /// @param points  m, z up, finite, within some 100 m of the origin
  explicit PlanView(std::span<const Eigen::Vector3f> points);

  /// The points that are in an occupied column, at most `height` m below or above its extent.
  std::vector<Eigen::Vector3f> covered(std::span<const Eigen::Vector3f> points,
                                       const RigidMotion& T_plan_points, double height) const;

 private:
  struct Column {
    float low = 1, high = 0;  // m; empty while low > high
  };
  bool covers(const Eigen::Vector3f& p, float height) const;

  Eigen::Vector2i first_ = Eigen::Vector2i::Zero(), size_ = Eigen::Vector2i::Zero();  // columns
  std::vector<Column> columns_;                                                       // row by row
};

}  // namespace fovea
