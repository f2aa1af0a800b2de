// Where the vehicle is, scan by scan: motion prediction, registration, fusion. Uses scans alone,
// never the map, so that the next scan is tracked while this one is mapped.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fovea/pipeline/fusion.h"
#include "fovea/pipeline/incremental_mapper.h"
#include "fovea/pipeline/mapper_options.h"
#include "fovea/pipeline/motion_history.h"
#include "fovea/pipeline/motion_model.h"
#include "fovea/pipeline/pose_refiner.h"

namespace fovea {

class Tracker {
 public:
  using InitialVelocity = std::function<std::optional<Twist>(int frame)>;

  /// @param drive             must outlive the tracker
  /// @param initial_velocity  see MapperServices
  Tracker(const DriveInfo& drive, const MapperOptions& options, PoseSource pose_source,
          InitialVelocity initial_velocity);

  /// The next frame's pose.
  TrackedScan track(const Frame& frame, const FrameTask& task);

  /// Makes the last scan a target of later ones, if it is a keyframe, and optimizes the submaps.
  void apply_deferred();

  /// Enters the next frame of an earlier run, which was not skipped.
  void follow(const FrameResult& frame);
  /// The same of a live drive, whose navigation of that time is only in the frames.
  void follow_live(const FrameResult& frame);
  /// Whether the frame just followed has to be given to replay(): as a registration target, from
  /// first_target() on, or as a place to come back to.
  bool needs_scan(int first_target) const {
    return (is_target_ && followed_frame_ >= first_target) || fusion_.is_scan_requested();
  }
  /// Enters the deskewed scan of the frame just followed.
  void replay(const PointCloud& scan_lidar, const FrameResult& frame);
  /// Number of the first frame of an earlier run whose scan registration still depends on.
  int first_target(const std::vector<FrameResult>& frames) const;

  PointCloud compensated(const PointCloud& scan, const std::optional<SweepMotion>& motion) const;
  /// T_local_submap by number.
  const std::vector<RigidMotion>& submaps() const { return fusion_.submaps(); }
  RigidMotion T_local_odom() const { return fusion_.T_local_odom(); }

 private:
  /// A scan placed by one guess of its motion.
  struct PlacedScan {
    PointCloud scan_lidar;
    std::optional<SweepMotion> motion;
    RefinedPose refined;
  };
  MotionPrediction predict(const Frame& frame);
  PlacedScan place(const Frame& frame, const MotionPrediction& motion, const FrameTask& task) const;
  RefinedPose locate(const PointCloud& scan_lidar, const MotionPrediction& motion,
                     const MotionGuess& guess, const FrameTask& task) const;
  /// Searches for the pose of a scan that does not fit where it was registered.
  void search_lost(RefinedPose& refined, const MotionGuess& guess, FrameResult& result) const;
  /// The pose of the first scan after a pause: by a search in the local map if registration has not
  /// confirmed it, or else the guess, from which the track restarts.
  void search_after_pause(RefinedPose& refined, const MotionGuess& guess, FrameResult& result);
  void count_lost(const FrameResult& frame);
  void follow_motion(const FrameResult& frame);
  void follow_target(const FrameResult& frame);
  void restart();
  bool registers() const;

  const DriveInfo& drive_;
  MotionHistory history_;
  bool compensate_motion_;
  PoseSource pose_source_;
  InitialVelocity initial_velocity_;
  MotionModel motion_model_;
  PoseRefiner refiner_;
  Fusion fusion_;
  Keyframes keyframes_;
  bool is_target_ = false;  // the frame followed last
  int followed_frame_ = 0;
  int lost_frames_ = 0;  // in a row, up to the last one
  std::optional<TimeNs> last_stamp_;
  struct Target {
    RegistrationCloud cloud_lidar;
    RigidMotion T_odom_lidar;
  };
  std::optional<Target> next_target_;
};

}  // namespace fovea
