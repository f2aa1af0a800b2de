#include "fovea/pipeline/fusion.h"

#include <utility>

#include "fovea/mapping/fusion/submap_errors.h"

namespace fovea {
namespace {

/// Least length, so that a standing vehicle stays in its submap.
constexpr double kSubmapLength = 5;  // m
/// Path over a pause after which the track restarts: long enough for loop closures between both
/// sides.
constexpr double kRestartPath = 2500;  // m
/// Without navigation the first submap is fixed. If navigation begins later, the first submap is
/// almost free until then.
constexpr double kAnchor = 1e-4;
constexpr double kFreeRotation = 10, kFreeTranslation = 1e4;  // rad, m

Twist deviations(double rotation, double translation) {
  Twist sigma;
  sigma << Eigen::Vector3d::Constant(rotation), Eigen::Vector3d::Constant(translation);
  return sigma;
}

}  // namespace

Fusion::Fusion(const FusionOptions& options, const RegistrationOptions& registration,
               const MotionHistory& history)
    : options_(options),
      navigation_(options.enabled ? history.navigation() : nullptr, history.navigation_accuracy()),
      closer_(registration) {}

bool Fusion::is_due(TimeNs stamp, const RigidMotion& T_odom_lidar) const {
  if (submaps_.empty()) return true;
  if (!has_navigation_pose_ && navigation_.measurement(submaps_.size(), stamp)) return true;
  const Submap& submap = submaps_.back();
  const double moved = (T_odom_lidar.translation() - submap.T_odom_submap.translation()).norm();
  return seconds(stamp - submap.start) >= options_.submap_duration && moved >= kSubmapLength;
}

void Fusion::open_submap(const FrameResult& frame, const std::optional<AbsolutePose>& measured) {
  const RigidMotion& T_odom_lidar = frame.poses.T_odom_lidar;
  const std::size_t node = graph_.add_node(T_local_odom() * T_odom_lidar);
  if (measured && !std::exchange(has_navigation_pose_, true) && node > 0) {
    graph_.move(measured->T_local_node * graph_.poses().back().inverse());
    // Of a live drive, nothing has shown before that navigation begins.
    graph_.weaken_poses(deviations(kFreeRotation, kFreeTranslation));
  }
  if (node > 0) {
    const Submap& before = submaps_.back();
    graph_.add(RelativePose{node - 1, node, before.T_odom_submap.inverse() * T_odom_lidar,
                            frame.tracking.has_restarted
                                ? restart_deviations()
                                : odometry_deviations(path_ - before.start_path, weak_frames_)});
  } else if (!measured) {
    graph_.add(AbsolutePose{node, graph_.poses().back(),
                            navigation_.has_fix() ? deviations(kFreeRotation, kFreeTranslation)
                                                  : deviations(kAnchor, kAnchor)});
  }
  submaps_.push_back({T_odom_lidar, *frame.stamp, path_});
  weak_frames_ = 0;
  if (!options_.enabled) return;
  if (measured) graph_.add(*measured);
  is_solved_ = false;
  if (node == 0) apply_deferred();
}

void Fusion::apply_deferred() {
  if (!std::exchange(is_solved_, true)) graph_.optimize();
}

void Fusion::advance(const FrameResult& frame) {
  const RigidMotion& T_odom_lidar = frame.poses.T_odom_lidar;
  if (frame.tracking.has_restarted) {
    last_T_odom_lidar_.reset();
    path_ += kRestartPath;
    navigation_.restart();
  }
  if (last_T_odom_lidar_) {
    path_ += (T_odom_lidar.translation() - last_T_odom_lidar_->translation()).norm();
  }
  last_T_odom_lidar_ = T_odom_lidar;
  weak_frames_ += frame.tracking.is_weak() ? 1 : 0;
}

void Fusion::follow(const FrameResult& frame) {
  apply_deferred();
  advance(frame);
  const std::size_t node = submaps_.size();
  if (frame.poses.submap != int(node)) return;
  std::optional<AbsolutePose> measured;
  if (options_.enabled && frame.poses.T_local_lidar_navigation) {
    measured = navigation_.measurement(node, *frame.poses.T_local_lidar_navigation,
                                       frame.poses.navigation_accuracy.value_or(0));
  }
  open_submap(frame, measured);
}

void Fusion::track(FrameResult& frame) {
  apply_deferred();
  advance(frame);
  const RigidMotion& T_odom_lidar = frame.poses.T_odom_lidar;
  const std::string problem = navigation_.observe(frame.stamp.value(), T_odom_lidar);
  frame.poses.navigation_accuracy = navigation_.stated_accuracy(*frame.stamp);
  if (!problem.empty()) {
    frame.tracking.has_navigation_jumped = true;
    frame.note += (frame.note.empty() ? "" : "; ") + problem;
  }
  const bool had_navigation = has_navigation_pose_;
  if (frame.tracking.has_restarted || is_due(*frame.stamp, T_odom_lidar)) {
    open_submap(frame, navigation_.measurement(submaps_.size(), *frame.stamp));
  }
  frame.tracking.has_navigation_begun = has_navigation_pose_ && !had_navigation;
  frame.poses.submap = static_cast<int>(submaps_.size()) - 1;
  frame.poses.T_local_lidar = T_local_lidar(frame);
}

bool Fusion::is_scan_requested() const {
  return options_.enabled && options_.loop_closure && !closer_.has(submaps_.size() - 1);
}

std::vector<LoopCandidate> Fusion::candidates(const RigidMotion& T_local_lidar) const {
  std::vector<LoopCandidate> result;
  for (std::size_t id = 0; id + 1 < submaps_.size(); ++id) {
    result.push_back(
        {id, graph_.poses()[id].inverse() * T_local_lidar, path_ - submaps_[id].start_path});
  }
  return result;
}

void Fusion::add_scan_and_close_loops(FrameResult& frame,
                                      const std::vector<Eigen::Vector3f>& points_lidar) {
  if (!is_scan_requested()) return;
  if (const auto closure = closer_.find(points_lidar, candidates(frame.poses.T_local_lidar))) {
    frame.poses.revisit = Revisit{static_cast<int>(closure->submap), closure->T_submap_lidar};
  }
  replay(frame, points_lidar);
  frame.poses.T_local_lidar = T_local_lidar(frame);
}

void Fusion::replay(const FrameResult& frame, const std::vector<Eigen::Vector3f>& points_lidar) {
  if (!is_scan_requested()) return;
  const auto submap = static_cast<std::size_t>(frame.poses.submap);
  closer_.add(submap, points_lidar, T_submap_lidar(frame));
  if (frame.poses.revisit) close_loop(frame);
}

RigidMotion Fusion::T_submap_lidar(const FrameResult& frame) const {
  const auto submap = static_cast<std::size_t>(frame.poses.submap);
  return submaps_[submap].T_odom_submap.inverse() * frame.poses.T_odom_lidar;
}

void Fusion::close_loop(const FrameResult& frame) {
  const auto submap = static_cast<std::size_t>(frame.poses.submap);
  graph_.add(RelativePose{static_cast<std::size_t>(frame.poses.revisit->submap), submap,
                          frame.poses.revisit->T_submap_lidar * T_submap_lidar(frame).inverse(),
                          loop_deviations(), /*robust=*/true});
  is_solved_ = false;
  apply_deferred();
}

RigidMotion Fusion::T_local_odom() const {
  if (!options_.enabled || submaps_.empty()) return RigidMotion::Identity();
  return graph_.poses()[submaps_.size() - 1] * submaps_.back().T_odom_submap.inverse();
}

RigidMotion Fusion::T_local_lidar(const FrameResult& frame) const {
  if (!options_.enabled) return frame.poses.T_odom_lidar;
  const auto submap = static_cast<std::size_t>(frame.poses.submap);
  return graph_.poses()[submap] * T_submap_lidar(frame);
}

}  // namespace fovea
