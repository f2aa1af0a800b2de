#include "fovea/pipeline/tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fovea/core/median.h"
#include "fovea/pipeline/scan_geometry.h"

namespace fovea {
namespace {

/// After this number of lost frames in a row, the pose error exceeds the extent of the local map.
constexpr int kLostFrames = 3;
/// Fastest vehicle, m/s.
constexpr double kFastest = 60;
/// Largest error of navigation, in its standard deviations.
constexpr double kSigmas = 5;
/// Largest error of navigation's motion over a pause, m.
constexpr double kNavigationReach = 5;

/// Poses that are given are not corrected.
FusionOptions fusion_options(const MapperOptions& options, PoseSource pose_source) {
  FusionOptions fusion = options.fusion;
  fusion.enabled = fusion.enabled && pose_source == PoseSource::kRefine;
  return fusion;
}

/// Whether an image is taken at another time than is usual for its camera.
bool has_image_offset(const Frame& frame) {
  return std::any_of(frame.image_offsets.begin(), frame.image_offsets.end(),
                     [](double offset) { return offset != 0; });
}

/// Median of the accuracy that navigation states where it has a fix (m); 0 if it states none.
double stated_accuracy(const DriveInfo& drive) {
  std::vector<double> stated;
  for (const double accuracy : drive.navigation_accuracy) {
    if (accuracy > 0 && std::isfinite(accuracy)) stated.push_back(accuracy);
  }
  return median_of(std::move(stated));
}

/// Whether a mapped scan is a target of later ones. A lost scan is none, since its pose is wrong.
/// After kLostFrames lost scans, lost scans become targets too.
/// @param lost_before  lost frames just before
bool becomes_target(Keyframes& keyframes, const FrameResult& frame, int lost_before) {
  if (frame.tracking.is_lost && lost_before < kLostFrames) return false;
  return keyframes.add_if_due(frame.poses.T_odom_lidar, frame.tracking.overlap());
}

PoseEvidence evidence_of(const TrackingStats& tracking) {
  if (tracking.is_lost || tracking.has_restarted) return PoseEvidence::kNone;
  if (!tracking.registration) return PoseEvidence::kFirm;  // the pose is given
  if (!tracking.registration->alignment) return PoseEvidence::kNone;
  const AlignmentStats& alignment = *tracking.registration->alignment;
  if (alignment.has_failed) return PoseEvidence::kNone;
  return alignment.degenerate_directions > 0 ? PoseEvidence::kWeak : PoseEvidence::kFirm;
}

}  // namespace

Tracker::Tracker(const DriveInfo& drive, const MapperOptions& options, PoseSource pose_source,
                 InitialVelocity initial_velocity)
    : drive_(drive),
      history_(drive),
      compensate_motion_(options.compensate_motion),
      pose_source_(pose_source),
      initial_velocity_(std::move(initial_velocity)),
      motion_model_(history_, {.doubt = fusion_options(options, pose_source).enabled,
                               .stated_accuracy = stated_accuracy(drive),
                               .sweep_rest = from_seconds(drive.sweep.end_time()),
                               .navigation_is_level = drive.origin.has_value()}),
      refiner_(options.refinement),
      fusion_(fusion_options(options, pose_source), options.refinement.registration, history_),
      keyframes_(refiner_.keyframes()) {}

TrackedScan Tracker::track(const Frame& frame, const FrameTask& task) {
  TrackedScan tracked;
  tracked.task = task;
  tracked.result = started_result(frame, task.held_out);
  FrameResult& result = tracked.result;
  apply_deferred();

  history_.add(frame.motion);
  const MotionPrediction motion = predict(frame);
  result.poses.T_local_lidar_navigation = motion.T_local_lidar_navigation;
  PlacedScan placed = place(frame, motion, task);
  RefinedPose& refined = placed.refined;
  // A search starts at the first guess, even if the scan fits best at the second one.
  if (motion.after_pause && registers() && !task.given_pose) {
    search_after_pause(refined, motion.guesses.front(), result);
  } else if (refined.lost) {
    search_lost(refined, motion.guesses.front(), result);
  }
  result.tracking.registration = refined.stats;
  const bool has_sweep_motion = compensate_motion_ && !drive_.sweep_compensated;
  if (has_sweep_motion || drive_.has_image_delays() || has_image_offset(frame))
    result.poses.motion = placed.motion;
  result.note = refined.note;
  result.poses.T_odom_lidar = refined.T_odom_lidar;
  const bool had_fault = !motion_model_.fault_of_imu().empty();
  motion_model_.update(frame.stamp, refined.T_odom_lidar, evidence_of(result.tracking));
  if (const std::string fault = motion_model_.fault_of_imu(); !fault.empty() && !had_fault) {
    result.note = "the turns of the IMU are not those of the scans, it is not used: " + fault;
    result.tracking.has_imu_dropped = true;
  }
  // The submap gives the pose in local. A loop closure may then correct it.
  fusion_.track(result);
  if (!task.held_out) {
    fusion_.add_scan_and_close_loops(result, refined.cloud.points);
    if (registers() && becomes_target(keyframes_, result, lost_frames_)) {
      tracked.target_lidar = refined.cloud.points;
      next_target_ = {std::move(refined.cloud), refined.T_odom_lidar};  // see apply_deferred()
    }
  }
  count_lost(result);
  last_stamp_ = frame.stamp;

  tracked.scan_lidar = std::move(placed.scan_lidar);
  tracked.submaps = fusion_.submaps();
  tracked.T_local_odom = fusion_.T_local_odom();
  result.clock.lap("register");
  return tracked;
}

MotionPrediction Tracker::predict(const Frame& frame) {
  motion_model_.begin_if_needed(frame.stamp, frame.index, initial_velocity_);
  return motion_model_.predict(frame.stamp, sweep_span(frame.scan, drive_));
}

Tracker::PlacedScan Tracker::place(const Frame& frame, const MotionPrediction& motion,
                                   const FrameTask& task) const {
  std::optional<PlacedScan> best;
  for (const MotionGuess& guess : motion.guesses) {
    PlacedScan placed{compensated(frame.scan, guess.motion), guess.motion, {}};
    placed.refined = locate(placed.scan_lidar, motion, guess, task);
    const bool was_lost = !best || best->refined.lost;
    const double gain = was_lost || placed.refined.lost ? 1 : motion.least_gain;
    if (!best || placed.refined.fit > gain * best->refined.fit) best = std::move(placed);
  }
  return std::move(*best);
}

RefinedPose Tracker::locate(const PointCloud& scan_lidar, const MotionPrediction& motion,
                            const MotionGuess& guess, const FrameTask& task) const {
  RefinedPose refined;
  // Poses in local: without fusion, odom and local are the same.
  if (pose_source_ == PoseSource::kNavigation) {
    refined.T_odom_lidar = motion.T_local_lidar_navigation.value_or(guess.T_odom_lidar);
  } else if (task.given_pose) {
    if (registers()) refined.cloud = refiner_.prepare(scan_lidar);
    refined.T_odom_lidar = *task.given_pose;
  } else {
    refined = refiner_.refine(scan_lidar, guess.T_odom_lidar, guess.sigma, guess.by_navigation);
  }
  return refined;
}

void Tracker::search_lost(RefinedPose& refined, const MotionGuess& guess,
                          FrameResult& result) const {
  // Not every frame of a drive that stays lost: a search takes half a second.
  constexpr int kEvery = 10;
  if (lost_frames_ < kLostFrames || lost_frames_ % kEvery == 0) {
    const double elapsed = last_stamp_ ? seconds(*result.stamp - *last_stamp_) : 0;
    const double reach = guess.sigma && guess.by_navigation
                             ? kSigmas * guess.sigma->tail<3>().maxCoeff()
                             : kFastest * elapsed;
    refined = refiner_.search(std::move(refined), guess.T_odom_lidar, reach);
  }
  if (!refined.lost) return;
  result.tracking.is_lost = true;
  refined.T_odom_lidar = guess.T_odom_lidar;
}

void Tracker::search_after_pause(RefinedPose& refined, const MotionGuess& guess,
                                 FrameResult& result) {
  if (refined.is_confirmed) return;
  const double paused = seconds(*result.stamp - *last_stamp_);
  const double reach = guess.by_navigation ? kNavigationReach : kFastest * paused;
  refined = refiner_.search(std::move(refined), guess.T_odom_lidar, reach);
  if (refined.is_confirmed) return;
  refined.lost = false;
  refined.T_odom_lidar = guess.T_odom_lidar;
  refined.note = fmt::format(
      "the track restarts after a pause of {:.1f} s, {}", paused,
      guess.by_navigation ? "where navigation has it" : "at the last pose before the pause");
  result.tracking.has_restarted = true;
  result.tracking.is_pose_unknown = !guess.by_navigation;
  restart();
}

void Tracker::restart() {
  refiner_.restart();
  keyframes_.restart();
}

void Tracker::count_lost(const FrameResult& frame) {
  lost_frames_ = frame.tracking.is_lost ? lost_frames_ + 1 : 0;
}

void Tracker::apply_deferred() {
  fusion_.apply_deferred();
  if (!next_target_) return;
  refiner_.keep(std::move(next_target_->cloud_lidar), next_target_->T_odom_lidar);
  next_target_.reset();
}

PointCloud Tracker::compensated(const PointCloud& scan,
                                const std::optional<SweepMotion>& motion) const {
  return deskewed(scan, compensate_motion_ ? motion : std::nullopt, drive_);
}

bool Tracker::registers() const {
  return pose_source_ == PoseSource::kRefine || pose_source_ == PoseSource::kGivenFirst;
}

void Tracker::follow(const FrameResult& frame) {
  follow_motion(frame);
  FrameResult tracked = frame;
  fusion_.track(tracked);
  follow_target(frame);
}

void Tracker::follow_live(const FrameResult& frame) {
  follow_motion(frame);
  fusion_.follow(frame);
  follow_target(frame);
}

void Tracker::follow_motion(const FrameResult& frame) {
  motion_model_.begin_if_needed(*frame.stamp, frame.index, initial_velocity_);
  motion_model_.update(*frame.stamp, frame.poses.T_odom_lidar, evidence_of(frame.tracking));
  if (frame.tracking.has_restarted) restart();
}

void Tracker::follow_target(const FrameResult& frame) {
  is_target_ = frame.status == FrameStatus::kMapped && registers() &&
               becomes_target(keyframes_, frame, lost_frames_);
  followed_frame_ = frame.index;
  count_lost(frame);
  last_stamp_ = frame.stamp;
}

int Tracker::first_target(const std::vector<FrameResult>& frames) const {
  Keyframes keyframes = refiner_.keyframes();
  std::vector<int> targets;
  int lost = 0;
  int restart_index = 0;
  for (const FrameResult& frame : frames) {
    if (frame.tracking.has_restarted) {
      keyframes.restart();
      targets.clear();
      restart_index = frame.index;
    }
    if (frame.status == FrameStatus::kMapped && becomes_target(keyframes, frame, lost)) {
      targets.push_back(frame.index);
    }
    lost = frame.tracking.is_lost ? lost + 1 : 0;
  }
  const auto memory = static_cast<std::size_t>(refiner_.memory());
  return targets.size() <= memory ? restart_index : targets[targets.size() - memory];
}

void Tracker::replay(const PointCloud& scan_lidar, const FrameResult& frame) {
  if (!is_target_ && !fusion_.is_scan_requested()) return;
  RegistrationCloud cloud = refiner_.prepare(scan_lidar);
  fusion_.replay(frame, cloud.points);
  if (is_target_) refiner_.keep(std::move(cloud), frame.poses.T_odom_lidar);
}

}  // namespace fovea
