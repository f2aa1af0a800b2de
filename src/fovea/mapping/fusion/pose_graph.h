// The sparse least-squares problem behind fusion: poses, relative and absolute measurements.
#pragma once

#include <cstddef>
#include <vector>

#include "fovea/geometry/rigid_motion.h"

namespace fovea {

/// A measured motion between two nodes.
struct RelativePose {
  std::size_t from = 0, to = 0;
  RigidMotion T_from_to = RigidMotion::Identity();
  Twist sigma = Twist::Ones();  ///< standard deviations in the frame of `to`: rad, then m
  bool robust = false;          ///< may be wrong altogether: a Cauchy kernel bounds its pull
};

/// A measured pose.
struct AbsolutePose {
  std::size_t node = 0;
  RigidMotion T_local_node = RigidMotion::Identity();
  /// Standard deviations of rotation (rad, in the node's frame) and position (m, in local axes).
  Twist sigma = Twist::Ones();
  bool robust = false;
};

/// Poses T_local_node that agree best with all measurements: Levenberg-Marquardt on SE(3) with a
/// sparse Cholesky factorisation. What it finds depends on the order of calls alone.
class PoseGraph {
 public:
  /// @return the new node's number
  std::size_t add_node(const RigidMotion& T_local_node);
  void add(const RelativePose& measurement);
  void add(const AbsolutePose& measurement);

  /// Moves all poses alike.
  void move(const RigidMotion& T_new_old);

  const std::vector<RigidMotion>& poses() const { return poses_; }
  /// Squared error of a measurement in standard deviations, at the present poses.
  double squared_error(const RelativePose& measurement) const;

  /// Improves the poses from where they are, as far back as what is new may move them. Directions
  /// that no measurement tells stay as they are.
  void optimize();

 private:
  struct Equations;
  /// @param width  squared, of the robust kernel
  /// @param first  nodes before it stay, and what is measured of them alone does not count
  Equations linearize(double width, std::size_t first) const;
  double cost(const std::vector<RigidMotion>& poses, double width, std::size_t first) const;
  /// Largest squared error of the robust measurements since the last optimize(), but for navigation
  /// that is as far off as before.
  double worst_new_error() const;
  /// @param converged  a smaller step ends it, rad and m
  void descend(double width, double converged, std::size_t first);

  std::vector<RigidMotion> poses_;
  std::vector<RelativePose> relative_;
  std::vector<AbsolutePose> absolute_;
  std::size_t heeded_relative_ = 0, heeded_absolute_ = 0;  // at the last optimize()
};

}  // namespace fovea
