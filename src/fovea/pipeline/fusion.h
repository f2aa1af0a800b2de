// Fusion of registration, navigation and loop closures in a graph of submaps (docs/method.md 2.6).
#pragma once

#include <optional>
#include <vector>

#include "fovea/mapping/fusion/loop_closure.h"
#include "fovea/mapping/fusion/navigation_check.h"
#include "fovea/mapping/fusion/pose_graph.h"
#include "fovea/pipeline/frame_result.h"
#include "fovea/pipeline/motion_history.h"

namespace fovea {

struct FusionOptions {
  bool enabled = true;         ///< false: submaps never move
  bool loop_closure = true;    ///< registers revisited places
  double submap_duration = 2;  ///< s, at least; the points of a submap move together
};

/// Poses of the submaps. Scans are registered in the frame `odom`, which never jumps. Navigation
/// and loop closures move the submaps in `local`; `T_local_odom` follows the latest submap.
///
/// Depends only on the frames so far: a resumed run that replays them has the same result.
class Fusion {
 public:
  /// @param history  must outlive the fusion
  Fusion(const FusionOptions& options, const RegistrationOptions& registration,
         const MotionHistory& history);

  /// Adds the next frame by its pose in odom, and opens a submap if one is due or the track
  /// restarts. Sets the frame's submap and T_local_lidar; appends faults of navigation to its note.
  void track(FrameResult& frame);
  /// Adds a frame of an earlier run of a live drive, whose submap and navigation are known.
  void follow(const FrameResult& frame);
  /// Deferred work: solves the graph with the submap that the last frame opened. The run time
  /// grows with the drive. track() does this first if it was not called.
  void apply_deferred();

  /// Keeps the first scan of a submap and searches for a loop closure. Sets the frame's revisit
  /// and T_local_lidar if it finds one.
  /// @param frame  just tracked, not held out
  void add_scan_and_close_loops(FrameResult& frame,
                                const std::vector<Eigen::Vector3f>& points_lidar);
  /// Whether the present submap has no scan yet.
  bool is_scan_requested() const;

  /// add_scan_and_close_loops() for a frame of an earlier run, whose revisit is known.
  void replay(const FrameResult& frame, const std::vector<Eigen::Vector3f>& points_lidar);

  RigidMotion T_local_odom() const;
  /// T_local_submap by number.
  const std::vector<RigidMotion>& submaps() const { return graph_.poses(); }
  /// Current pose of a tracked frame in local.
  RigidMotion T_local_lidar(const FrameResult& frame) const;

 private:
  struct Submap {
    RigidMotion T_odom_submap;
    TimeNs start;
    double start_path;  // m
  };
  bool is_due(TimeNs stamp, const RigidMotion& T_odom_lidar) const;
  /// Adds the path to a frame.
  void advance(const FrameResult& frame);
  /// @param measured  the frame's pose by navigation
  void open_submap(const FrameResult& frame, const std::optional<AbsolutePose>& measured);
  RigidMotion T_submap_lidar(const FrameResult& frame) const;
  void close_loop(const FrameResult& frame);
  std::vector<LoopCandidate> candidates(const RigidMotion& T_local_lidar) const;

  FusionOptions options_;
  NavigationCheck navigation_;
  PoseGraph graph_;
  bool is_solved_ = true;
  bool has_navigation_pose_ = false;  // of any submap
  LoopCloser closer_;
  std::vector<Submap> submaps_;
  std::optional<RigidMotion> last_T_odom_lidar_;
  double path_ = 0;      // m
  int weak_frames_ = 0;  // of the present submap: registration was degenerate or failed
};

}  // namespace fovea
