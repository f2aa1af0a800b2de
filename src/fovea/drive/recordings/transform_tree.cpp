#include "fovea/drive/recordings/transform_tree.h"

#include <algorithm>

namespace fovea {

bool TransformTree::Link::moves() const {
  constexpr double kStill = 1e-3;  // m, rad
  return std::any_of(T_parent_child.begin(), T_parent_child.end(), [&](const auto& entry) {
    const QuaternionMotion& T = entry.second;
    return (T.translation - any().translation).norm() > kStill ||
           T.rotation.angularDistance(any().rotation) > kStill;
  });
}

QuaternionMotion TransformTree::Link::at(TimeNs time) const {
  const auto after = T_parent_child.lower_bound(time);
  if (after == T_parent_child.begin()) return after->second;
  const auto before = std::prev(after);
  if (after == T_parent_child.end()) return before->second;
  return interpolate(before->second, after->second,
                     seconds(time - before->first) / seconds(after->first - before->first));
}

void TransformTree::add(const std::string& parent, const std::string& child, TimeNs time,
                        const QuaternionMotion& T_parent_child, bool fixed) {
  links_[child][parent].T_parent_child.insert_or_assign(fixed ? 0 : time, T_parent_child);
}

const TransformTree::Links::value_type& TransformTree::best(const Links& links) {
  return *std::max_element(links.begin(), links.end(), [](const auto& a, const auto& b) {
    return a.second.T_parent_child.size() < b.second.T_parent_child.size();
  });
}

std::vector<std::string> TransformTree::ambiguous() const {
  std::vector<std::string> names;
  for (const auto& [name, links] : links_) {
    if (links.size() > 1) names.push_back(name);
  }
  return names;
}

std::vector<std::string> TransformTree::ancestors(const std::string& frame) const {
  std::vector<std::string> frames{frame};
  for (auto at = links_.find(frame); at != links_.end(); at = links_.find(frames.back())) {
    const std::string& parent = best(at->second).first;
    if (std::find(frames.begin(), frames.end(), parent) != frames.end()) break;  // a ring
    frames.push_back(parent);
  }
  return frames;
}

std::optional<TransformTree::Way> TransformTree::way(const std::string& a,
                                                     const std::string& b) const {
  std::vector<std::string> from_a = ancestors(a), from_b = ancestors(b);
  const auto common_a = std::find_if(from_a.begin(), from_a.end(), [&](const std::string& frame) {
    return std::find(from_b.begin(), from_b.end(), frame) != from_b.end();
  });
  if (common_a == from_a.end()) return std::nullopt;
  from_b.erase(std::find(from_b.begin(), from_b.end(), *common_a), from_b.end());
  from_a.erase(common_a, from_a.end());
  return Way{std::move(from_a), std::move(from_b)};
}

std::optional<QuaternionMotion> TransformTree::fixed(const std::string& a,
                                                     const std::string& b) const {
  const auto found = way(a, b);
  if (!found) return std::nullopt;
  // By the links' own numbers where one of them is all there is: none is multiplied by identity.
  std::optional<QuaternionMotion> T;
  const auto append = [&](const QuaternionMotion& next) { T = T ? *T * next : next; };
  for (const std::string& frame : found->from_a) append(link(frame).any().inverse());
  for (auto frame = found->from_b.rbegin(); frame != found->from_b.rend(); ++frame) {
    append(link(*frame).any());
  }
  return T.value_or(QuaternionMotion());
}

std::optional<std::string> TransformTree::moving(const std::string& a, const std::string& b) const {
  const auto found = way(a, b);
  if (!found) return std::nullopt;
  for (const auto& frames : {found->from_a, found->from_b}) {
    for (const std::string& frame : frames) {
      if (link(frame).moves()) return frame;
    }
  }
  return std::nullopt;
}

std::optional<std::string> TransformTree::world_of(const std::string& frame) const {
  const std::vector<std::string> frames = ancestors(frame);
  for (std::size_t i = frames.size() - 1; i > 0; --i) {
    // What only fixed links join to the rest is as good a world as its child, and further away.
    if (link(frames[i - 1]).moves()) return frames[i];
  }
  return std::nullopt;
}

std::vector<TransformTree::TimedMotion> TransformTree::course(const std::string& a,
                                                              const std::string& b) const {
  const std::vector<Step> way = steps(a, b);
  const auto nearest = nearest_moving(way);
  std::vector<TimedMotion> motions;
  if (nearest == way.end()) return motions;
  for (const auto& [time, unused] : nearest->link.T_parent_child) {
    motions.push_back({time, motion_at(way, time)});
  }
  return motions;
}

std::vector<TransformTree::Step> TransformTree::steps(const std::string& a,
                                                      const std::string& b) const {
  const std::vector<std::string> frames = ancestors(b);
  const auto world = std::find(frames.begin(), frames.end(), a);
  if (world == frames.end()) return {};
  std::vector<Step> steps;
  for (auto frame = frames.begin(); frame != world; ++frame) {
    steps.push_back({*(frame + 1), *frame, link(*frame)});
  }
  return steps;
}

std::vector<TransformTree::Step>::const_iterator TransformTree::nearest_moving(
    const std::vector<Step>& steps) {
  return std::find_if(steps.begin(), steps.end(),
                      [](const Step& step) { return step.link.moves(); });
}

QuaternionMotion TransformTree::motion_at(const std::vector<Step>& steps, TimeNs time) {
  QuaternionMotion T = steps.front().link.at(time);
  for (auto step = steps.begin() + 1; step != steps.end(); ++step) T = step->link.at(time) * T;
  return T;
}

void TransformTree::forget_past() {
  for (auto& [child, links] : links_) {
    for (auto& [parent, link] : links) {
      link.T_parent_child.erase(link.T_parent_child.begin(), std::prev(link.T_parent_child.end()));
    }
  }
}

}  // namespace fovea
