#include "fovea/drive/recordings/transform_course.h"

#include <iterator>
#include <utility>

namespace fovea {
namespace {

/// A frame far from the body, such as `odom` in `map`, may come later. Then it counts as still.
constexpr TimeNs kLongestWait = kNsPerSecond / 10;
/// A stamp further back or ahead than these counts once the next one continues it.
constexpr TimeNs kFarBack = kNsPerSecond / 2, kFarAhead = 10 * kNsPerSecond;

TimeNs latest_of(const TransformTree::Step& step) {
  return step.link.T_parent_child.rbegin()->first;
}

}  // namespace

TransformCourse::TransformCourse(const TransformTree& tree, const std::string& world,
                                 const std::string& body)
    : steps_(tree.steps(world, body)),
      nearest_(std::size_t(TransformTree::nearest_moving(steps_) - steps_.cbegin())) {
  for (const TransformTree::Step& step : steps_) moves_.push_back(step.link.moves());
  far_.resize(steps_.size());
}

std::vector<RecordedPose> TransformCourse::add(const std::vector<ros::Transform>& transforms) {
  for (const ros::Transform& transform : transforms) {
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const TransformTree::Step& step = steps_[k];
      if (transform.child_frame != step.child || transform.header.frame != step.parent) continue;
      add(k, {transform.header.stamp, transform.T_header_child});
    }
  }
  return known_poses();
}

void TransformCourse::add(std::size_t k, const TransformTree::TimedMotion& transform) {
  TransformTree::Link& link = steps_[k].link;
  const TimeNs latest = latest_of(steps_[k]);
  const auto earlier = std::exchange(far_[k], std::nullopt);
  const bool is_back = transform.time < latest - kFarBack;
  if (is_back || transform.time > latest + kFarAhead) {
    const bool continues = earlier && transform.time > earlier->time &&
                           (earlier->time < latest) == (transform.time < latest);
    if (!continues) {
      far_[k] = transform;
      return;
    }
    if (is_back) restart(k, transform.time);
    link.T_parent_child.insert_or_assign(earlier->time, earlier->T_a_b);
  }
  link.T_parent_child.insert_or_assign(transform.time, transform.T_a_b);
  limit(k);
  moves_[k] = moves_[k] || link.moves();
}

void TransformCourse::restart(std::size_t k, TimeNs time) {
  steps_[k].link.T_parent_child.clear();
  if (k != nearest_) return;
  latest_ = 0;
  for (std::size_t other = 0; other < steps_.size(); ++other) {
    auto& times = steps_[other].link.T_parent_child;
    if (times.empty() || times.rbegin()->first <= time + kFarBack) continue;
    const auto next = std::exchange(far_[other], std::nullopt);
    if (next && next->time <= time + kFarBack) {
      times = {{next->time, next->T_a_b}};
    } else {  // the last transform counts until one with a new stamp comes
      times = {{TimeNs(0), QuaternionMotion(times.rbegin()->second)}};
    }
  }
}

bool TransformCourse::is_known(TimeNs time) const {
  if (time + kLongestWait <= latest_of(steps_[nearest_])) return true;
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    if (moves_[k] && latest_of(steps_[k]) < time) return false;
  }
  return true;
}

std::vector<RecordedPose> TransformCourse::known_poses() {
  std::vector<RecordedPose> poses;
  const auto& times = steps_[nearest_].link.T_parent_child;
  for (auto entry = times.upper_bound(latest_); entry != times.end(); ++entry) {
    if (!is_known(entry->first)) break;
    poses.push_back({entry->first, TransformTree::motion_at(steps_, entry->first)});
    latest_ = entry->first;
  }
  forget_past();
  return poses;
}

void TransformCourse::limit(std::size_t k) {
  auto& times = steps_[k].link.T_parent_child;
  times.erase(times.begin(), times.lower_bound(latest_of(steps_[k]) - kMaxAge));
  while (times.size() > kMaxTransforms) times.erase(times.begin());
}

std::size_t TransformCourse::size() const {
  std::size_t size = 0;
  for (const TransformTree::Step& step : steps_) size += step.link.T_parent_child.size();
  return size;
}

void TransformCourse::forget_past() {
  for (TransformTree::Step& step : steps_) {
    auto& times = step.link.T_parent_child;
    const auto after = times.upper_bound(latest_);
    if (after != times.begin()) times.erase(times.begin(), std::prev(after));
  }
}

}  // namespace fovea
