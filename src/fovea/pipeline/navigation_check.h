// Whether GPS/INS can be believed: its motion beside that of the registered scans.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "fovea/geometry/trajectory.h"
#include "fovea/mapping/fusion/pose_graph.h"

namespace fovea {

/// Follows navigation frame by frame. Where its position jumps, freezes or comes back elsewhere
/// after an outage, nobody knows which of its solutions was right: for a minute it counts for less
/// by the distance it jumped, or until it jumps back.
class NavigationCheck {
 public:
  /// @param navigation  T_local_lidar, or null; must outlive the check
  /// @param accuracy    of each of its poses, see DriveInfo::navigation_accuracy
  NavigationCheck(const Trajectory* navigation, const std::vector<double>& accuracy)
      : navigation_(navigation), accuracy_(accuracy) {}

  /// Tells the pose that registration gave a frame.
  /// @return what is wrong with the navigation at this frame; empty if nothing is
  std::string observe(TimeNs stamp, const RigidMotion& T_local_lidar);

  /// The next frame's pose says nothing of the motion since the last one.
  void restart() {
    last_.reset();
    last_position_.reset();
    path_ = 0;
  }

  /// What navigation says of a node's pose, with the deviations that it deserves; empty in an
  /// outage.
  std::optional<AbsolutePose> measurement(std::size_t node, TimeNs stamp) const;

 private:
  double accuracy_at(TimeNs stamp) const;

  struct Known {
    RigidMotion T_local_navigation, T_local_lidar;
  };
  const Trajectory* navigation_;
  const std::vector<double>& accuracy_;
  std::optional<Known> last_;
  double path_ = 0;  // m since last_
  std::optional<Eigen::Vector3d> last_position_;
  struct Jump {
    TimeNs stamp;
    Eigen::Vector3d way;  // m
  };
  std::deque<Jump> jumps_;  // of the last minute
};

}  // namespace fovea
