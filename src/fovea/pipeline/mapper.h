// The paper's method, frame by frame: the only place that knows the order of the stages.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/map/occupancy.h"
#include "fovea/map/tile_map.h"
#include "fovea/mapping/ray_filter.h"
#include "fovea/pipeline/dynamic_points.h"
#include "fovea/pipeline/mapper_options.h"
#include "fovea/pipeline/tracker.h"
#include "fovea/pipeline/visible_map.h"
#include "fovea/sensor/frame_source.h"

namespace fovea {

/// Builds a map incrementally. Feed it frames in increasing order of their stamps.
class Mapper {
 public:
  /// @param drive  calibration, navigation and sweep; must outlive the mapper
  /// @param bring_near  called before tiles within a ball around the LiDAR are looked at, where
  ///        some of them may be in a store (TileMap::restore)
  using BringNear =
      std::function<void(TileMap& map, const Eigen::Vector3d& center_local, double radius)>;
  Mapper(
      const DriveInfo& drive, const MapperOptions& options, PoseSource pose_source,
      BringNear bring_near = [](TileMap&, const Eigen::Vector3d&, double) {});

  /// Sets the LiDAR's velocity at the first frame, and at the first one after a pause, before that
  /// frame is tracked, where navigation does not measure it (initial_velocity). Without either the
  /// LiDAR counts as at rest, and its sweep stays as it is.
  void begin_with(const std::optional<Twist>& velocity) { tracker_.begin_with(velocity); }
  /// Whether a frame follows a pause of the recording (MotionModel::follows_pause). In the thread
  /// of track().
  bool follows_pause(TimeNs stamp) const { return tracker_.follows_pause(stamp); }
  /// Whether the last frame tracked is the first of all or the first after a pause.
  bool begins() const { return tracker_.begins(); }

  /// Maps one frame and returns what is to be kept of it.
  /// @param held_out    registered like any other, but adds no point, colour or registration target
  /// @param given_pose  T_local_lidar where the pose source is kGiven, or kGivenFirst and the frame
  ///        is one of the first
  FrameRecord process(const Frame& frame, bool held_out,
                      const std::optional<RigidMotion>& given_pose = std::nullopt);

  /// The two halves of process(), each to be called for every frame in order: where the frame is,
  /// and then its points and colours into the map. track() of later frames may run, in one other
  /// thread, while add() runs: the map is the same.
  TrackedFrame track(const Frame& frame, bool held_out,
                     const std::optional<RigidMotion>& given_pose);
  FrameRecord add(const Frame& frame, TrackedFrame tracked);
  /// What tracking the next frame needs of the last one and its map does not; track() does it where
  /// it was not done before. In the thread of track().
  void settle_tracking() { tracker_.settle(); }
  /// The same of add(), in its thread.
  void settle_map();

  const TileMap& map() const { return map_; }
  TileMap& map() { return map_; }  ///< for a store
  /// How far from the LiDAR tiles are looked at, m; those of the last submap may be anywhere.
  double reach() const { return reach_; }

  /// Takes up a map where an earlier run left it: its tiles, and the frames' records in order.
  /// @param source  reads the last keyframes again, which registration needs as targets, and the
  ///                latest scans, which tell what moves
  void resume(TileMap map, const std::vector<FrameRecord>& records, const FrameSource& source);

 private:
  void follow_submaps(const std::vector<RigidMotion>& poses);
  /// Number of the first frame of an earlier run whose scan the evidence of what moves depends on.
  static int first_to_look_through(const std::vector<FrameRecord>& records);
  void replay(const PointCloud& scan, const FrameRecord& record, bool looked_at);
  /// What one camera sees, into the map.
  void map_view(ScanView view, const Image& image, FrameRecord& record, StageClock& clock);
  bool looks_at_map() const;
  void look_at_map(const FovealRegion& region, const RigidMotion& T_local_lidar);
  /// How a view colours points, after a comparison with the map; none with the paper's one view.
  std::optional<ColorView> colors_of(const ScanView& view, FrameRecord& record) const;
  /// The foveal points and what is sampled between them.
  PointCloud densified(ScanView& view, const RigidMotion& T_local_cam, StageClock& clock);
  /// What the paper's ray filter leaves.
  PointCloud filter_rays(const PointCloud& dense_cam, const FovealRegion& region,
                         const RigidMotion& T_local_lidar, FrameRecord& record);
  /// What the ray filter leaves. The map has been looked at.
  PointCloud visible_part(PointCloud dense_cam, const FovealRegion& region,
                          const RigidMotion& T_local_lidar, FrameRecord& record);
  void map_whole_scan(const PointCloud& scan_lidar, const Frame& frame,
                      const std::vector<Camera>& cameras, const RigidMotion& T_local_lidar,
                      FrameRecord& record, StageClock& clock);
  /// The drive's cameras, each at the place where it took its image of a frame. lidar_views() where
  /// the drive has no camera.
  std::vector<Camera> cameras_at_images(int index, const std::optional<SweepMotion>& motion) const;

  const DriveInfo& drive_;
  MapperOptions options_;
  BringNear bring_near_;
  double reach_;
  Tracker tracker_;
  RayFilter ray_filter_;
  DynamicPointFilter dynamic_points_;
  TileMap map_;
  VisibleMap visible_map_;
  std::optional<Occupancy> occupancy_;  // where surfaces are sampled on a grid
  /// Where points have come of which `occupancy_` does not know yet.
  std::optional<Eigen::Vector3d> added_near_;
  RigidMotion T_odom_local_ = RigidMotion::Identity();  // as of the frame at hand
};

}  // namespace fovea
