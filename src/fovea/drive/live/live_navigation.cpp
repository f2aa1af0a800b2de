#include "fovea/drive/live/live_navigation.h"

#include <algorithm>
#include <cmath>

#include "fovea/drive/live/recorded_rows.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// Orientations further away from a position do not serve it (gnss_table.cpp).
constexpr TimeNs kOrientationReach = kNsPerSecond / 10;

/// m, in the window: positions of a standing receiver wander by less.
constexpr double kLeastWay = 5;

/// Largest distance from the first pose, m.
double way_of(const Trajectory& T_local_lidar) {
  const Eigen::Vector3d first = T_local_lidar.poses().front().T_local_body.translation();
  double way = 0;
  for (const StampedPose& pose : T_local_lidar.poses()) {
    way = std::max(way, (pose.T_local_body.translation() - first).norm());
  }
  return way;
}

}  // namespace

bool LiveNavigation::uses_orientations(const Inertia& inertia) const {
  return !inertia.empty() && inertia.records().back().R_enu_imu && !positions_.empty() &&
         !positions_.records().back().roll_pitch_yaw;
}

bool LiveNavigation::reaches(TimeNs time, TimeNs longest_step, const Inertia& inertia) const {
  if (!is_used_) return true;
  if (is_by_poses()) return poses_.has_reached(time, longest_step);
  if (!positions_.has_reached(time, longest_step)) return false;
  // A position gets its attitude from the orientations around it.
  return !uses_orientations(inertia) || inertia.has_reached(positions_.end_of(time), longest_step);
}

void LiveNavigation::pass(TimeNs time) {
  poses_.pass(time);
  positions_.pass(time);
}

NavigationTables LiveNavigation::tables(TimeNs until, const Inertia& inertia) const {
  NavigationTables tables;
  if (is_by_poses()) {
    tables.poses = pose_rows();
    const TimeNs end = poses_.end_of(until);
    for (const RecordedPose& pose : poses_.records()) {
      if (pose.time <= end) add_row(*tables.poses, pose);
    }
    return tables;
  }
  if (positions_.empty()) return tables;
  TimeNs end = positions_.end_of(until);
  if (uses_orientations(inertia)) {
    // The others wait for their orientations.
    const TimeNs known = inertia.records().back().time;
    if (end <= known + kOrientationReach) end = std::min(end, known);
  }
  tables.positions = position_rows();
  for (const RecordedPosition& position : positions_.records()) {
    if (position.time <= end) add_row(*tables.positions, position);
  }
  if (!inertia.empty()) {
    tables.orientations = orientation_rows();
    for (const RecordedInertia& record : inertia.records()) {
      add_orientation(*tables.orientations, record);
    }
  }
  tables.heading_before = heading_;
  return tables;
}

bool LiveNavigation::begin_with(const GenericNavigation& navigation) {
  // Positions without any fix place nothing.
  const bool is_usable = navigation.T_local_lidar && (is_by_poses() || navigation.origin);
  if (!is_usable) {
    problem_ = navigation.warnings.empty() ? "" : navigation.warnings.back();
    return false;
  }
  by_poses_ = is_by_poses();
  frame_ = navigation.frame;
  return true;
}

GenericNavigation LiveNavigation::begin(const LocalFrame& frame, TimeNs until,
                                        const Inertia& inertia) {
  given_ = frame_ = frame;
  if (!is_used_) return {};
  if (!empty()) {
    GenericNavigation navigation =
        convert_navigation(tables(until, inertia), name_, description_, frame);
    if (begin_with(navigation)) {
      last_pose_ = navigation.T_local_lidar->poses().back().time;
      return navigation;
    }
  }
  GenericNavigation none;
  none.notes.push_back(empty() ? "neither poses nor positions came: no navigation so far"
                               : "no navigation so far: " + problem_);
  return none;
}

void LiveNavigation::postpone(std::string problem) {
  by_poses_.reset();
  last_pose_.reset();
  frame_ = given_;
  problem_ = std::move(problem);
}

void LiveNavigation::try_to_begin(TimeNs stamp, const GenericNavigation& navigation,
                                  MotionData& data) {
  const auto& T_local_lidar = navigation.T_local_lidar;
  if (T_local_lidar && T_local_lidar->poses().front().time > stamp) return;  // a later frame
  if (!T_local_lidar || !T_local_lidar->at(stamp)) {
    problem_ = navigation.warnings.empty()
                   ? "poses or positions reach no scan, are their times of one clock?"
                   : navigation.warnings.back();
    return;
  }
  if (navigation.headings_by_way && way_of(*T_local_lidar) < kLeastWay) {
    problem_ = "positions without attitudes do not move: no heading is known";
    return;
  }
  if (!begin_with(navigation)) return;
  data.begins = NavigationOrigin{navigation.origin, description_.coordinates, frame_.world};
}

void LiveNavigation::take(TimeNs stamp, TimeNs until, const Inertia& inertia, MotionData& data) {
  if (!is_used_) return drop_before(until);
  LocalFrame frame = frame_;
  if (!by_poses_) frame.time = stamp;
  try {
    const GenericNavigation navigation =
        convert_navigation(tables(until, inertia), name_, description_, frame);
    if (!by_poses_ && !empty()) try_to_begin(stamp, navigation, data);
    if (by_poses_) add_new_poses(navigation, data);
  } catch (const InputError& error) {
    warn_once(error.what());
  }
  // Records that give no pose are not kept for longer.
  if (data.poses.empty()) return drop_before(until - kWindow);
  last_pose_ = data.poses.back().time;
  const Eigen::Matrix3d R =
      data.poses.back().T_local_body.linear() * description_.T_body_lidar.linear().transpose();
  heading_ = std::atan2(R(1, 0), R(0, 0));
  drop_before(*last_pose_ - kWindow);
}

void LiveNavigation::add_new_poses(const GenericNavigation& navigation, MotionData& data) {
  if (!navigation.T_local_lidar) return;
  const std::vector<StampedPose>& poses = navigation.T_local_lidar->poses();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (last_pose_ && poses[i].time <= *last_pose_) continue;
    data.poses.push_back(poses[i]);
    data.accuracy.push_back(navigation.accuracy[i]);
  }
}

void LiveNavigation::drop_before(TimeNs time) {
  poses_.drop_before(time);
  positions_.drop_before(time);
}

void LiveNavigation::warn_once(const std::string& text) {
  const auto& warnings = messages_.warnings;
  if (std::find(warnings.begin(), warnings.end(), text) == warnings.end()) messages_.warn(text);
}

Messages LiveNavigation::messages() const {
  Messages messages = messages_;
  if (is_used_ && !by_poses_ && !problem_.empty()) messages.warn("no navigation: " + problem_);
  return messages;
}

}  // namespace fovea
