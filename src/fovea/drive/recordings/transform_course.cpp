#include "fovea/drive/recordings/transform_course.h"

#include <iterator>

namespace fovea {
namespace {

/// A frame far from the body, such as `odom` in `map`, may come later. Then it counts as still.
constexpr TimeNs kLongestWait = kNsPerSecond / 10;

TimeNs latest_of(const TransformTree::Step& step) {
  return step.link.T_parent_child.rbegin()->first;
}

}  // namespace

TransformCourse::TransformCourse(const TransformTree& tree, const std::string& world,
                                 const std::string& body)
    : steps_(tree.steps(world, body)),
      nearest_(std::size_t(TransformTree::nearest_moving(steps_) - steps_.cbegin())) {
  for (const TransformTree::Step& step : steps_) moves_.push_back(step.link.moves());
}

std::vector<RecordedPose> TransformCourse::add(const std::vector<ros::Transform>& transforms) {
  for (const ros::Transform& transform : transforms) {
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      TransformTree::Step& step = steps_[k];
      if (transform.child_frame != step.child || transform.header.frame != step.parent) continue;
      step.link.T_parent_child.insert_or_assign(transform.header.stamp, transform.T_header_child);
      moves_[k] = moves_[k] || step.link.moves();
    }
  }
  return known_poses();
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

void TransformCourse::forget_past() {
  for (TransformTree::Step& step : steps_) {
    auto& times = step.link.T_parent_child;
    const auto after = times.upper_bound(latest_);
    if (after != times.begin()) times.erase(times.begin(), std::prev(after));
  }
}

}  // namespace fovea
