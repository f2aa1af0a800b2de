// Registration, navigation and places seen again, joined by moving submaps (docs/method.md 2.6).
#pragma once

#include <optional>
#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/mapping/fusion/loop_closure.h"
#include "fovea/mapping/fusion/pose_graph.h"
#include "fovea/pipeline/navigation_check.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

struct FusionOptions {
  bool enabled = true;         ///< false: submaps stay where they were made
  bool loop_closure = true;    ///< places seen again are registered
  double submap_duration = 2;  ///< s, at least; points of a submap keep to each other
  void validate() const;       ///< ConfigError that names the field
};

/// Poses of the submaps. Scans are registered in the frame `odom`, which never jumps; `local` is
/// where navigation and closed loops put the submaps, and `T_local_odom` follows the latest of
/// them.
///
/// Depends on the frames told so far alone: a run that resumes and tells them again goes on alike.
class Fusion {
 public:
  /// @param drive  must outlive the fusion
  Fusion(const FusionOptions& options, const RegistrationOptions& registration,
         const DriveInfo& drive);

  /// Takes the next frame's pose in odom, opens a submap if one is due or the track restarts, and
  /// sets record.submap and
  /// record.T_local_lidar; appends to record.note what is wrong with the navigation.
  void track(FrameRecord& record);
  /// Solves the graph with the submap that the last frame opened: until then that is where odometry
  /// puts it. The longer the drive, the longer it takes; track() does it first, unless it was done
  /// while nobody waited.
  void settle();

  /// Gives the scan of a frame just tracked, which was not held out: the first of a submap is kept
  /// and compared with earlier places. Sets record.revisit and record.T_local_lidar if that closes
  /// a loop.
  void look_around(FrameRecord& record, const std::vector<Eigen::Vector3f>& points_lidar);
  /// Whether look_around() waits for a scan of the present submap.
  bool wants_scan() const;

  /// The same as look_around() for a frame of an earlier run: what it found is in the record.
  void replay(const FrameRecord& record, const std::vector<Eigen::Vector3f>& points_lidar);

  RigidMotion T_local_odom() const;
  /// T_local_submap by number.
  const std::vector<RigidMotion>& submaps() const { return graph_.poses(); }
  /// Of any frame tracked, by what is known now.
  RigidMotion T_local_lidar(const FrameRecord& record) const;

 private:
  struct Submap {
    RigidMotion T_odom_submap;
    TimeNs start;
    double path;  // m driven before
  };
  bool is_due(TimeNs stamp, const RigidMotion& T_odom_lidar) const;
  void open_submap(TimeNs stamp, const RigidMotion& T_odom_lidar, bool restarts);
  /// Of the odometry from the submap before to a new one.
  /// @param length  m driven between their origins
  Twist odometry_deviations(double length, bool restarts) const;
  RigidMotion T_submap_lidar(const FrameRecord& record) const;
  void close_loop(const FrameRecord& record);
  std::vector<LoopCandidate> candidates(const RigidMotion& T_local_lidar) const;

  FusionOptions options_;
  NavigationCheck navigation_;
  PoseGraph graph_;
  bool is_solved_ = true;
  LoopCloser closer_;
  std::vector<Submap> submaps_;
  std::optional<RigidMotion> last_T_odom_lidar_;
  double path_ = 0;      // m
  int weak_frames_ = 0;  // of the present submap: registration knew less than six directions
};

}  // namespace fovea
