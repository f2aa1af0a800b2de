#include "fovea/pipeline/tracker.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "fovea/base/median.h"
#include "fovea/base/parallel.h"
#include "fovea/pipeline/point_counts.h"
#include "fovea/sensor/motion_compensation.h"

namespace fovea {
namespace {

/// Poses that are given are not corrected, nor those of the paper's pairwise chain.
bool fuses(const MapperOptions& options, PoseSource pose_source) {
  return options.fusion.enabled && pose_source == PoseSource::kRefine &&
         options.refinement.target == RegistrationTarget::kLocalMap;
}

FusionOptions fusion_options(const MapperOptions& options, PoseSource pose_source) {
  FusionOptions fusion = options.fusion;
  fusion.enabled = fuses(options, pose_source);
  return fusion;
}

/// After as many frames that were lost, the local map is out of reach.
constexpr int kLostFrames = 3;
/// Fastest vehicle, m/s.
constexpr double kFastest = 60;
/// Largest error of navigation, in its standard deviations.
constexpr double kSigmas = 5;
/// Largest error of navigation's motion over a pause, m.
constexpr double kNavigationReach = 5;

/// Median of the accuracy that navigation states where it has a fix (m); 0 if it states none.
double stated_accuracy(const DriveInfo& drive) {
  std::vector<double> stated;
  for (const double accuracy : drive.navigation_accuracy) {
    if (accuracy > 0 && std::isfinite(accuracy)) stated.push_back(accuracy);
  }
  return median_of(std::move(stated));
}

/// Whether a scan that is mapped is a target of those after it. All that says so is in its record:
/// a run that resumes chooses the same.
///
/// A lost scan is none, since its pose is wrong; but where the scans before it were lost, too, the
/// local map is out of reach, and starts again.
/// @param lost_before  frames lost just before
bool takes(Keyframes& keyframes, const FrameRecord& record, int lost_before) {
  if (record.has("registration_lost") && lost_before < kLostFrames) return false;
  const auto pairs = record.figures.find("registration_pairs");
  const bool registered = pairs != record.figures.end() && record.has("registration_points");
  const double overlap = registered ? pairs->second / record.figures.at("registration_points") : 1;
  return keyframes.is_keyframe(record.T_odom_lidar, overlap);
}

}  // namespace

Tracker::Tracker(const DriveInfo& drive, const MapperOptions& options, PoseSource pose_source)
    : drive_(drive),
      maps_whole_scans_(!options.foveal_enabled),
      compensate_motion_(options.compensate_motion),
      pose_source_(pose_source),
      motion_model_(drive.navigation ? &*drive.navigation : nullptr,
                    {.interpolate = options.interpolate_navigation,
                     .doubt = fuses(options, pose_source),
                     .stated_accuracy = stated_accuracy(drive),
                     .sweep_rest = from_seconds(drive.sweep.end_time())}),
      refiner_(options.refinement, drive.calibration.cameras),
      fusion_(fusion_options(options, pose_source), options.refinement.registration, drive),
      keyframes_(refiner_.keyframes()) {}

TrackedFrame Tracker::track(const Frame& frame, bool held_out,
                            const std::optional<RigidMotion>& given_pose, const View& view) {
  settle();
  TrackedFrame tracked;
  StageClock& clock = tracked.clock;
  clock.add(std::exchange(settling_, {}));
  FrameRecord& record = tracked.record;
  record.index = frame.index;
  record.stamp = frame.stamp;
  record.status = held_out ? FrameStatus::kHeldOut : FrameStatus::kMapped;
  count_points(frame, record);

  // Where are we, and how do we move?
  const MotionPrediction motion = motion_model_.predict(frame.stamp);
  record.T_local_lidar_navigation = motion.T_local_lidar_navigation;

  // Pose refinement, and what needs no pose.
  Placed placed = place(frame, motion, given_pose, clock, held_out ? View() : view);
  if (motion.after_pause && registers() && refiner_.confirms_poses()) {
    find_after_pause(placed, motion.guesses.front(), record, clock);
  } else if (placed.refined.lost) {
    find_again(placed, motion, record, clock);
  }
  if (compensates() || drive_.has_image_delays()) record.motion = placed.motion;
  record.note = placed.refined.note;
  record.figures.merge(placed.refined.figures);
  record.T_odom_lidar = placed.refined.T_odom_lidar;
  motion_model_.update(frame.stamp, record.T_odom_lidar);
  clock.time("register", [&] {
    fusion_.track(record);
    if (!held_out) fusion_.close_loops(record, placed.refined.cloud.points);
  });
  if (!held_out && registers() && takes(keyframes_, record, lost_frames_)) {
    next_target_ = {std::move(placed.refined.cloud), record.T_odom_lidar};
  }

  count_lost(record);

  tracked.views = std::move(placed.views);
  if (maps_whole_scans_) tracked.scan_lidar = std::move(placed.scan_lidar);
  tracked.motion = placed.motion;
  tracked.submaps = fusion_.submaps();
  tracked.T_local_odom = fusion_.T_local_odom();
  return tracked;
}

void Tracker::find_again(Placed& placed, const MotionPrediction& motion, FrameRecord& record,
                         StageClock& clock) {
  const MotionGuess& guess = motion.guesses.front();
  // Not every frame of a drive that stays lost: a search takes half a second.
  constexpr int kEvery = 10;
  if (lost_frames_ < kLostFrames || lost_frames_ % kEvery == 0) {
    const double elapsed = last_stamp_ ? seconds(*record.stamp - *last_stamp_) : 0;
    const double reach =
        guess.sigma ? kSigmas * guess.sigma->tail<3>().maxCoeff() : kFastest * elapsed;
    placed.refined = refiner_.search(std::move(placed.refined), guess.T_odom_lidar, reach, clock);
  }
  if (!placed.refined.lost) return;
  record.figures["registration_lost"] = 1;
  placed.refined.T_odom_lidar = guess.T_odom_lidar;
}

void Tracker::find_after_pause(Placed& placed, const MotionGuess& guess, FrameRecord& record,
                               StageClock& clock) {
  if (placed.refined.is_confirmed) return;
  const double paused = seconds(*record.stamp - *last_stamp_);
  const double reach = guess.by_navigation ? kNavigationReach : kFastest * paused;
  placed.refined = refiner_.search(std::move(placed.refined), guess.T_odom_lidar, reach, clock);
  if (placed.refined.is_confirmed) return;
  placed.refined.lost = false;
  placed.refined.T_odom_lidar = guess.T_odom_lidar;
  placed.refined.note = fmt::format(
      "the track restarts after a pause of {:.1f} s, {}", paused,
      guess.by_navigation ? "where navigation has it" : "at the last pose before the pause");
  record.figures["track_restarted"] = 1;
  if (!guess.by_navigation) record.figures["pose_unknown"] = 1;
  restart();
}

void Tracker::restart() {
  refiner_.restart();
  keyframes_.restart();
}

void Tracker::count_lost(const FrameRecord& record) {
  lost_frames_ = record.has("registration_lost") ? lost_frames_ + 1 : 0;
  last_stamp_ = record.stamp;
}

void Tracker::settle() {
  settling_.time("register", [&] { fusion_.apply_deferred(); });
  if (!next_target_) return;
  refiner_.keep(std::move(next_target_->cloud_lidar), next_target_->T_odom_lidar, settling_);
  next_target_.reset();
}

PointCloud Tracker::compensated(const PointCloud& scan,
                                const std::optional<SweepMotion>& motion) const {
  PointCloud scan_lidar = scan;
  if (motion && compensates()) compensate_sweep(scan_lidar, *motion, drive_.sweep);
  // No stage uses these. Interpolated points have neither.
  scan_lidar.time.clear();
  scan_lidar.ring.clear();
  return scan_lidar;
}

Tracker::Placed Tracker::place(const Frame& frame, const MotionPrediction& motion,
                               const std::optional<RigidMotion>& given_pose, StageClock& clock,
                               const View& view) const {
  std::optional<Placed> best;
  for (const MotionGuess& guess : motion.guesses) {
    Placed placed;
    placed.motion = guess.motion;
    placed.scan_lidar =
        clock.time("register", [&] { return compensated(frame.scan, guess.motion); });
    // Where it is doubted which of two scans it will be, both are looked at.
    run_both([&] { placed.refined = locate(placed.scan_lidar, motion, guess, given_pose, clock); },
             [&] {
               if (view) placed.views = view(placed.scan_lidar, placed.motion);
             });
    if (!best || placed.refined.fit > best->refined.fit) best = std::move(placed);
  }
  return std::move(*best);
}

RefinedPose Tracker::locate(const PointCloud& scan_lidar, const MotionPrediction& motion,
                            const MotionGuess& guess, const std::optional<RigidMotion>& given_pose,
                            StageClock& clock) const {
  RefinedPose refined;
  if (pose_source_ == PoseSource::kNavigation) {
    refined.T_odom_lidar = motion.T_local_lidar_navigation.value_or(guess.T_odom_lidar);
  } else if (given_pose) {
    if (registers()) refined.cloud = refiner_.prepare(scan_lidar, clock);
    refined.T_odom_lidar = *given_pose;
  } else {
    refined = refiner_.refine(scan_lidar, guess.T_odom_lidar, clock, guess.sigma);
  }
  return refined;
}

bool Tracker::compensates() const { return compensate_motion_ && !drive_.sweep_compensated; }

bool Tracker::registers() const {
  return pose_source_ == PoseSource::kRefine || pose_source_ == PoseSource::kGivenFirst;
}

void Tracker::follow(const FrameRecord& record) {
  motion_model_.update(record.stamp.value(), record.T_odom_lidar);
  if (record.has("track_restarted")) restart();
  FrameRecord tracked = record;
  fusion_.track(tracked);
  is_target_ = record.status == FrameStatus::kMapped && registers() &&
               takes(keyframes_, record, lost_frames_);
  count_lost(record);
}

int Tracker::first_target(const std::vector<FrameRecord>& records) const {
  Keyframes keyframes = refiner_.keyframes();
  std::vector<int> targets;
  int lost = 0;
  int restart_index = 0;
  for (const FrameRecord& record : records) {
    if (record.has("track_restarted")) {
      keyframes.restart();
      targets.clear();
      restart_index = record.index;
    }
    if (record.status == FrameStatus::kMapped && takes(keyframes, record, lost)) {
      targets.push_back(record.index);
    }
    if (record.status != FrameStatus::kSkipped)
      lost = record.has("registration_lost") ? lost + 1 : 0;
  }
  const auto memory = static_cast<std::size_t>(refiner_.memory());
  return targets.size() <= memory ? restart_index : targets[targets.size() - memory];
}

void Tracker::replay(const PointCloud& scan_lidar, const FrameRecord& record) {
  if (!is_target_ && !wants_scan()) return;
  StageClock unused;
  RegistrationCloud cloud = refiner_.prepare(scan_lidar, unused);
  fusion_.replay(record, cloud.points);
  if (is_target_) refiner_.keep(std::move(cloud), record.T_odom_lidar, unused);
}

}  // namespace fovea
