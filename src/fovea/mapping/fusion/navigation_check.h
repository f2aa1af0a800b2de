// Compares the motion of GPS/INS with that of registered scans.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "fovea/mapping/fusion/pose_graph.h"
#include "fovea/trajectory.h"

namespace fovea {

/// Checks navigation frame by frame. Its position may jump, freeze, or return elsewhere after an
/// outage. The standard deviation then includes the distance of the jump for a minute, or until it
/// jumps back.
class NavigationCheck {
 public:
  /// @param navigation  T_local_lidar, or null; must outlive the check. Empty: it may begin later
  /// @param accuracy    of each of its poses, see DriveInfo::navigation_accuracy
  NavigationCheck(const Trajectory* navigation, const std::vector<double>& accuracy)
      : navigation_(navigation), accuracy_(accuracy) {}

  /// Adds the registered pose of a frame.
  /// @return the fault of navigation at this frame; empty if there is none
  std::string observe(TimeNs stamp, const RigidMotion& T_local_lidar);

  /// Makes the motion to the next frame unknown.
  void restart() {
    last_.reset();
    last_position_.reset();
    path_ = 0;
  }

  /// Standard deviation of the position at a time as it is stated, m; infinite without a fix. Empty
  /// if nothing is stated.
  std::optional<double> stated_accuracy(TimeNs stamp) const;

  /// Whether any position has a fix.
  bool has_fix() const;

  /// The pose of a node by navigation, with standard deviations that include its faults; empty in
  /// an outage.
  std::optional<AbsolutePose> measurement(std::size_t node, TimeNs stamp) const;
  /// The same of a pose that is known.
  /// @param stated  its accuracy, m: 0 where nothing is stated, infinite without a fix
  std::optional<AbsolutePose> measurement(std::size_t node, const RigidMotion& T_local_lidar,
                                          double stated) const;

 private:
  double accuracy_at(TimeNs stamp) const;

  struct Known {
    RigidMotion T_local_navigation, T_local_lidar;
  };
  const Trajectory* navigation_;
  const std::vector<double>& accuracy_;
  std::optional<Known> last_;
  double path_ = 0;          // m since last_
  bool is_located_ = false;  // a position with a fix was observed
  std::optional<Eigen::Vector3d> last_position_;
  struct Jump {
    TimeNs stamp;
    Eigen::Vector3d offset;  // m
  };
  std::deque<Jump> jumps_;  // of the last minute
};

}  // namespace fovea
