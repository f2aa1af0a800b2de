// Pose graph: sparse least squares over poses, with relative and absolute measurements.
#pragma once

#include <cstddef>
#include <vector>

#include "fovea/rigid_motion.h"

namespace fovea {

/// A measured motion between two nodes.
struct RelativePose {
  std::size_t from = 0, to = 0;
  RigidMotion T_from_to = RigidMotion::Identity();
  Twist sigma = Twist::Ones();  ///< standard deviations in the frame of `to`: rad, then m
  bool robust = false;          ///< may be an outlier: a Cauchy kernel limits its weight
};

/// A measured pose.
struct AbsolutePose {
  std::size_t node = 0;
  RigidMotion T_local_node = RigidMotion::Identity();
  /// Standard deviations of rotation (rad, in the node's frame) and position (m, in local axes).
  Twist sigma = Twist::Ones();
  bool robust = false;
};

/// A measured position of a point that is fixed to a node.
struct PointPosition {
  std::size_t node = 0;
  Eigen::Vector3d p_node = Eigen::Vector3d::Zero(), p_local = Eigen::Vector3d::Zero();  ///< m
  double sigma = 1;  ///< standard deviation of each coordinate, m
};

/// Finds the poses T_local_node that fit all measurements best: Levenberg-Marquardt on SE(3) with a
/// sparse Cholesky factorization. The result depends only on the order of calls.
class PoseGraph {
 public:
  /// @return the new node's number
  std::size_t add_node(const RigidMotion& T_local_node);
  void add(const RelativePose& measurement);
  void add(const AbsolutePose& measurement);
  void add(const PointPosition& measurement);

  /// Moves all poses by one motion.
  void move(const RigidMotion& T_new_old);
  /// Sets the standard deviations of the measured poses so far.
  void weaken_poses(const Twist& sigma);

  const std::vector<RigidMotion>& poses() const { return poses_; }
  /// Squared error of a measurement in standard deviations at the present poses.
  double squared_error(const RelativePose& measurement) const;

  /// Improves the poses, as far back as new measurements may move them. Directions without a
  /// measurement do not change.
  void optimize();

 private:
  struct Equations;
  /// Calls f(term, robust) for the measurements of any node from `first` on.
  template <class F>
  void for_each_term(const std::vector<RigidMotion>& poses, std::size_t first, F&& f) const;
  /// @param width  squared, of the robust kernel
  /// @param first  nodes before it are fixed; measurements between fixed nodes do not count
  Equations linearize(double width, std::size_t first) const;
  double cost(const std::vector<RigidMotion>& poses, double width, std::size_t first) const;
  /// Largest squared error of the robust measurements since the last optimize(), without navigation
  /// whose error has not grown.
  double worst_new_error() const;
  /// @param converged  largest last step, rad and m
  void descend(double width, double converged, std::size_t first);

  std::vector<RigidMotion> poses_;
  std::vector<RelativePose> relative_;
  std::vector<AbsolutePose> absolute_;
  std::vector<PointPosition> positions_;
  // At the last optimize().
  std::size_t used_relative_ = 0, used_absolute_ = 0, used_positions_ = 0;
};

}  // namespace fovea
