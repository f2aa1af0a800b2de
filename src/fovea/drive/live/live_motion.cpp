#include "fovea/drive/live/live_motion.h"

#include <algorithm>
#include <cmath>

#include "fovea/core/errors.h"
#include "fovea/drive/live/recorded_rows.h"
#include "fovea/drive/navigation/imu_table.h"

namespace fovea {
namespace {

/// Navigation is converted in a window: it shows positions that are far from the others.
constexpr TimeNs kWindow = 10 * kNsPerSecond;
/// Orientations further away from a position do not serve it (gnss_table.cpp).
constexpr TimeNs kOrientationReach = kNsPerSecond / 10;

/// The time of the first record at `until` or later; that of the last one if there is none.
template <class Record>
TimeNs end_of(const RecordWindow<Record>& window, TimeNs until) {
  const auto& records = window.records();
  const auto at = std::lower_bound(records.begin(), records.end(), until,
                                   [](const Record& r, TimeNs time) { return r.time < time; });
  if (at != records.end()) return at->time;
  return records.empty() ? until : records.back().time;
}

/// Whether a sensor need not be waited for, to have its records up to a time.
bool has_reached(const SensorStamps& stamps, TimeNs time, TimeNs longest_step) {
  if (!stamps.last()) return true;
  const TimeNs gap = time - *stamps.last();
  return gap <= 0 || stamps.has_stopped(time) || stamps.usual_step().value_or(0) >= longest_step;
}

}  // namespace

LiveMotion::LiveMotion(const DriveDescription& description, const DriveOptions& options,
                       std::filesystem::path name, double longest_step)
    : description_(description),
      options_(options),
      name_(std::move(name)),
      longest_step_(from_seconds(longest_step)) {}

bool LiveMotion::uses_orientations() const {
  return !inertia_.empty() && inertia_.records().back().R_enu_imu && !positions_.empty() &&
         !positions_.records().back().roll_pitch_yaw;
}

bool LiveMotion::reaches(TimeNs time) const {
  const auto reached = [&](const auto& window) {
    return has_reached(window.stamps(), time, longest_step_);
  };
  const bool uses_navigation = has_begun_ ? has_navigation_ : options_.use_navigation;
  const bool uses_imu = has_begun_ ? has_imu_ : options_.use_imu && description_.imu.has_value();
  const bool uses_wheels = has_begun_ ? has_wheels_ : options_.use_imu;
  if (uses_wheels && !reached(wheels_)) return false;
  if (uses_imu && !reached(inertia_)) return false;
  if (!uses_navigation) return true;
  if (has_begun_ ? by_poses_ : !poses_.empty()) return reached(poses_);
  if (!reached(positions_)) return false;
  // A position gets its attitude from the orientations around it.
  return !uses_orientations() ||
         has_reached(inertia_.stamps(), end_of(positions_, time), longest_step_);
}

void LiveMotion::pass(TimeNs time) {
  poses_.pass(time);
  positions_.pass(time);
  inertia_.pass(time);
  wheels_.pass(time);
}

NavigationTables LiveMotion::tables(TimeNs until) const {
  NavigationTables tables;
  if (has_begun_ ? by_poses_ : !poses_.empty()) {
    tables.poses = pose_rows();
    const TimeNs end = end_of(poses_, until);
    for (const RecordedPose& pose : poses_.records()) {
      if (pose.time <= end) add_row(*tables.poses, pose);
    }
    return tables;
  }
  if (positions_.empty()) return tables;
  TimeNs end = end_of(positions_, until);
  if (uses_orientations()) {
    // The others wait for their orientations.
    const TimeNs known = inertia_.records().back().time;
    if (end <= known + kOrientationReach) end = std::min(end, known);
  }
  tables.positions = position_rows();
  for (const RecordedPosition& position : positions_.records()) {
    if (position.time <= end) add_row(*tables.positions, position);
  }
  if (!inertia_.empty()) {
    tables.orientations = orientation_rows();
    for (const RecordedInertia& inertia : inertia_.records()) {
      add_orientation(*tables.orientations, inertia);
    }
  }
  tables.heading_before = heading_;
  return tables;
}

FirstMotion LiveMotion::begin(const LocalFrame& frame, TimeNs until) {
  FirstMotion first;
  frame_ = frame;
  by_poses_ = !poses_.empty();
  if (options_.use_navigation && !has_navigation()) {
    first.notes.push_back("neither poses nor positions came: no navigation");
  } else if (options_.use_navigation) {
    GenericNavigation navigation = convert_navigation(tables(until), name_, description_, frame);
    first.append(navigation);
    has_navigation_ = navigation.T_local_lidar.has_value();
    if (has_navigation_) {
      frame_ = navigation.frame;
      first.origin = navigation.origin;
      last_pose_ = navigation.T_local_lidar->poses().back().time;
      first.navigation = std::move(navigation.T_local_lidar);
      first.accuracy = std::move(navigation.accuracy);
    }
  }
  has_begun_ = true;
  if (!options_.use_imu) return first;
  if (description_.imu && !inertia_.empty()) {
    CsvRows rows = inertia_rows();
    const TimeNs end = end_of(inertia_, until);
    for (const RecordedInertia& inertia : inertia_.records()) {
      if (inertia.time <= end) add_inertia(rows, inertia);
    }
    ImuTable table = convert_imu(std::move(rows), name_ / "imu.csv", *description_.imu);
    first.append(table);
    has_imu_ = table.imu.has_value();
    force_scale_ = table.force_scale;
    last_imu_ = end;
    first.imu = std::move(table.imu);
  }
  MotionData data;
  has_wheels_ = !wheels_.empty();
  take_wheels(until, data);
  has_wheels_ = !data.wheels.empty();
  if (has_wheels_) {
    first.wheels = WheelData{description_.wheels.T_lidar_body, description_.wheels.sigma,
                             std::move(data.wheels)};
  }
  return first;
}

MotionData LiveMotion::take(TimeNs until) {
  MotionData data;
  take_poses(until, data);
  take_imu(until, data);
  take_wheels(until, data);
  return data;
}

void LiveMotion::warn_once(const std::string& text) {
  const auto& warnings = messages_.warnings;
  if (std::find(warnings.begin(), warnings.end(), text) == warnings.end()) messages_.warn(text);
}

void LiveMotion::take_poses(TimeNs until, MotionData& data) {
  if (!has_navigation_) {
    poses_.drop_before(until);
    positions_.drop_before(until);
    return;
  }
  try {
    const GenericNavigation navigation =
        convert_navigation(tables(until), name_, description_, frame_);
    if (!navigation.T_local_lidar) return;
    const std::vector<StampedPose>& poses = navigation.T_local_lidar->poses();
    for (std::size_t i = 0; i < poses.size(); ++i) {
      if (last_pose_ && poses[i].time <= *last_pose_) continue;
      data.poses.push_back(poses[i]);
      data.accuracy.push_back(navigation.accuracy[i]);
    }
  } catch (const InputError& error) {
    warn_once(error.what());
  }
  if (data.poses.empty()) {
    // Records that give no pose are not kept for longer.
    poses_.drop_before(until - kWindow);
    positions_.drop_before(until - kWindow);
    if (!has_imu_) inertia_.drop_before(until - kWindow);
    return;
  }
  last_pose_ = data.poses.back().time;
  const Eigen::Matrix3d R =
      data.poses.back().T_local_body.linear() * description_.T_body_lidar.linear().transpose();
  heading_ = std::atan2(R(1, 0), R(0, 0));
  poses_.drop_before(*last_pose_ - kWindow);
  positions_.drop_before(*last_pose_ - kWindow);
  if (!has_imu_) inertia_.drop_before(*last_pose_ - kWindow);
}

void LiveMotion::take_imu(TimeNs until, MotionData& data) {
  if (!has_imu_) return;
  const TimeNs end = end_of(inertia_, until);
  for (const RecordedInertia& inertia : inertia_.records()) {
    if (inertia.time > end) break;
    if (last_imu_ && inertia.time <= *last_imu_) continue;
    last_imu_ = inertia.time;
    ImuSample sample =
        imu_sample(inertia.time, inertia.angular_velocity, inertia.acceleration, *description_.imu);
    if (why_unusable(sample) != nullptr) continue;
    sample.force *= force_scale_;
    data.imu.push_back(sample);
  }
  if (last_imu_) inertia_.drop_before(*last_imu_ - kWindow);
}

void LiveMotion::take_wheels(TimeNs until, MotionData& data) {
  if (!has_wheels_) return;
  const TimeNs end = end_of(wheels_, until);
  for (const WheelSpeed& wheel : wheels_.records()) {
    if (wheel.time > end) break;
    if (last_wheel_ && wheel.time <= *last_wheel_) continue;
    last_wheel_ = wheel.time;
    if (is_wheel_speed(wheel.speed)) data.wheels.push_back(wheel);
  }
  if (last_wheel_) wheels_.drop_before(*last_wheel_);
}

}  // namespace fovea
