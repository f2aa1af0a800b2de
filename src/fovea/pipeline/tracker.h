// Where the vehicle is, scan by scan: motion prediction, registration, fusion. It looks at scans
// alone, never at the map, so that the next scan can be tracked while this one's colours are
// mapped.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/pipeline/fusion.h"
#include "fovea/pipeline/mapper_options.h"
#include "fovea/pipeline/motion_model.h"
#include "fovea/pipeline/pose_refiner.h"
#include "fovea/pipeline/scan_views.h"
#include "fovea/pipeline/stage_clock.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

/// Where poses come from.
enum class PoseSource {
  kRefine,
  kNavigation,
  kGiven,
  kGivenFirst,  ///< given for the first frames; those after them are registered
};

/// All that mapping a frame needs to know of its tracking. Later frames do not change it.
struct TrackedFrame {
  FrameRecord record;
  /// Motion compensated; empty where only foveal regions are mapped: `views` has those.
  PointCloud scan_lidar;
  std::optional<SweepMotion> motion;  ///< of the LiDAR
  ScanViews views;                    ///< of the scan, unless it is held out
  /// T_local_submap of all submaps, and the motion that puts the latest into local, as of this
  /// frame.
  std::vector<RigidMotion> submaps;
  RigidMotion T_local_odom = RigidMotion::Identity();
  StageClock clock;  ///< goes on with the frame
};

class Tracker {
 public:
  /// @param drive  must outlive the tracker
  Tracker(const DriveInfo& drive, const MapperOptions& options, PoseSource pose_source);

  /// See Mapper::begin_with.
  void begin_with(const std::optional<Twist>& velocity) { motion_model_.begin_with(velocity); }
  /// See Mapper::follows_pause and Mapper::begins.
  bool follows_pause(TimeNs stamp) const { return motion_model_.follows_pause(stamp); }
  bool begins() const { return motion_model_.begins(); }

  /// What is to be made of a scan that needs no pose.
  using View = std::function<ScanViews(const PointCloud& scan_lidar,
                                       const std::optional<SweepMotion>& motion)>;

  /// The next frame's pose; see Mapper::process.
  /// @param view  runs while the scan is registered, not at all if the frame is held out
  TrackedFrame track(const Frame& frame, bool held_out,
                     const std::optional<RigidMotion>& given_pose, const View& view);

  /// Makes the last frame's scan a target of later ones, if it is to be one, and moves submaps to
  /// where all agree. track() does so first, unless it was done while nobody waited.
  void settle();

  /// Follows the next frame of an earlier run, which was not skipped.
  void follow(const FrameRecord& record);
  /// Whether a frame just followed that was not held out has to be given to replay().
  bool wants_scan() const { return fusion_.is_scan_requested(); }
  /// Whether it is a target of later scans, for which that has to be, too, from first_target() on.
  bool is_target() const { return is_target_; }
  /// Takes the compensated scan of a frame just followed, as a target and a place to come back to.
  void replay(const PointCloud& scan_lidar, const FrameRecord& record);
  /// The number of the first frame of an earlier run that registration still depends on.
  int first_target(const std::vector<FrameRecord>& records) const;

  PointCloud compensated(const PointCloud& scan, const std::optional<SweepMotion>& motion) const;
  /// T_local_submap by number.
  const std::vector<RigidMotion>& submaps() const { return fusion_.submaps(); }
  RigidMotion T_local_odom() const { return fusion_.T_local_odom(); }

 private:
  /// A frame's scan as it is mapped, what it shows, and what registration said of it.
  struct Placed {
    PointCloud scan_lidar;
    std::optional<SweepMotion> motion;
    ScanViews views;
    RefinedPose refined;
  };
  /// @param view  of each guess's scan, while that is registered; may be empty
  Placed place(const Frame& frame, const MotionPrediction& motion,
               const std::optional<RigidMotion>& given_pose, StageClock& clock,
               const View& view) const;
  RefinedPose locate(const PointCloud& scan_lidar, const MotionPrediction& motion,
                     const MotionGuess& guess, const std::optional<RigidMotion>& given_pose,
                     StageClock& clock) const;
  /// Searches for the pose of a scan that does not fit where it was registered. Notes in the record
  /// whether it was found.
  void find_again(Placed& placed, const MotionPrediction& motion, FrameRecord& record,
                  StageClock& clock);
  /// The pose of the first scan after a pause, where registration around the guess has not
  /// confirmed one: by a search in the local map, or else the guess, from which the track restarts.
  void find_after_pause(Placed& placed, const MotionGuess& guess, FrameRecord& record,
                        StageClock& clock);
  void count_lost(const FrameRecord& record);
  /// Later scans are elsewhere: forgets those so far.
  void restart();
  bool compensates() const;
  bool registers() const;

  const DriveInfo& drive_;
  bool maps_whole_scans_, compensate_motion_;
  PoseSource pose_source_;
  MotionModel motion_model_;
  PoseRefiner refiner_;
  Fusion fusion_;
  Keyframes keyframes_;
  bool is_target_ = false;  // the frame followed last
  int lost_frames_ = 0;     // that follow each other, up to the last one
  std::optional<TimeNs> last_stamp_;
  struct Target {
    RegistrationCloud cloud_lidar;
    RigidMotion T_odom_lidar;
  };
  std::optional<Target> next_target_;
  StageClock settling_;  // time that counts for the next frame
};

}  // namespace fovea
