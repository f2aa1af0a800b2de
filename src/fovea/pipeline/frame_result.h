// Result of one frame.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/map/frame_record.h"
#include "fovea/mapping/radiometry.h"
#include "fovea/pipeline/stage_clock.h"

namespace fovea {

/// Poses of a frame. The members have the meaning of those in FrameRecord.
struct FramePoses {
  RigidMotion T_local_lidar = RigidMotion::Identity();
  std::optional<RigidMotion> T_local_lidar_navigation;
  RigidMotion T_odom_lidar = RigidMotion::Identity();
  int submap = -1;
  std::optional<Revisit> revisit;
  std::optional<SweepMotion> motion;
  /// m, standard deviation that navigation states of its position; infinite without a fix.
  std::optional<double> navigation_accuracy = {};
};

/// Points of the scan.
struct ScanStats {
  std::size_t points = 0;  ///< usable
  DroppedPoints dropped;
};

/// Alignment of a scan to its target.
struct AlignmentStats {
  int iterations = 0;
  std::size_t pairs = 0;
  double rms_m = 0;
  int degenerate_directions = 0;
  bool has_failed = false;  ///< the first guess is kept
  double correction_m = 0, correction_rad = 0;
};

struct RegistrationStats {
  std::size_t points = 0;
  std::optional<AlignmentStats> alignment;  ///< absent where there is no target yet
  std::optional<double> vertical_fit;       ///< share, with the local map (VerticalFit)
  /// See pose_covariance(); absent where the first guess is kept.
  std::optional<Eigen::Matrix<double, 6, 6>> covariance;

  /// Share of the points that have a counterpart; 1 without an alignment or without points.
  double overlap() const;
};

/// Decisions of tracking that later frames depend on.
struct TrackingStats {
  std::optional<RegistrationStats> registration;  ///< absent where poses are given
  bool is_lost = false;        ///< the scan does not lie on the surfaces of the local map
  bool has_restarted = false;  ///< the motion during the pause is unknown
  bool is_pose_unknown = false;
  bool has_navigation_jumped = false;
  bool has_navigation_begun = false;  ///< its first pose: it has moved the submaps before
  bool has_imu_dropped = false;       ///< from the next frame on the IMU is not used

  /// Share of the registered points that have a counterpart; 1 where nothing was registered.
  double overlap() const;
  /// Whether registration has not determined all six directions of the motion.
  bool is_weak() const;
};

/// Points of the foveal regions, over all cameras.
struct FovealStats {
  std::size_t measured = 0;
  std::size_t upsampled = 0;  ///< points for the map: measured ones and those between them
  std::size_t oblique = 0;    ///< dropped: seen at more than the incidence limit
  std::size_t occluding = 0;  ///< dropped: they would hide the map
};

/// Verdicts of the paper's ray filter on the points that would not hide the map.
struct RayFilterStats {
  std::size_t map_points = 0;  ///< in the foveal region
  std::size_t visible = 0, occluded = 0, shared = 0;
};

/// Points of moving objects.
struct DynamicStats {
  std::size_t removed = 0;  ///< map points in space observed as free
  std::size_t dropped = 0;  ///< new points where other scans saw free space
};

/// Colors of the map from a frame's images.
struct ColorStats {
  std::size_t recolored = 0;      ///< map points in view again
  std::size_t compared = 0;       ///< map points, with the images before they are fused
  double error = 0;               ///< mean difference of the compared points, percent
  std::vector<ViewRecord> views;  ///< of each camera's image; as in the file, without stamps
};

struct FrameResult {
  int index = 0;
  std::optional<TimeNs> stamp;
  FrameStatus status = FrameStatus::kMapped;
  std::string note;
  FramePoses poses;
  ScanStats scan;
  TrackingStats tracking;
  int blank_images = 0;
  bool skips_texture = false;  ///< see FrameTask
  // Absent if the mapper lacks the stage.
  std::optional<FovealStats> foveal;
  std::optional<std::size_t> hidden;  ///< foveal points that other points of the scan hide
  std::optional<RayFilterStats> ray_filter;
  std::optional<DynamicStats> dynamic;
  std::optional<ColorStats> colors;
  std::optional<std::size_t> added;   ///< points added to the map
  std::optional<std::size_t> unseen;  ///< points of a whole scan that no camera sees
  StageClock clock;
};

/// Statistics of a stage, created at its first use in a frame.
template <class Stats>
Stats& stats_of(std::optional<Stats>& stats) {
  return stats ? *stats : stats.emplace();
}

/// The result of a frame before its stages.
FrameResult started_result(const Frame& frame, bool held_out);

/// Whether an image can color points. Counts blank images. The drive counts missing images.
bool has_content(const Image& image, FrameResult& result);

/// The report of a frame: what the map keeps.
FrameRecord record_of(const FrameResult& result);

/// Poses and tracking of a frame that an earlier run has mapped.
FrameResult tracked_result(const FrameRecord& record);

}  // namespace fovea
