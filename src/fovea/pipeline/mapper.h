// The paper's method, frame by frame: the only place that knows the order of the stages.
#pragma once

#include <optional>
#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/map/occupancy.h"
#include "fovea/map/tile_map.h"
#include "fovea/mapping/ray_filter.h"
#include "fovea/pipeline/map_colors.h"
#include "fovea/pipeline/mapper_options.h"
#include "fovea/pipeline/motion_model.h"
#include "fovea/pipeline/moving_things.h"
#include "fovea/pipeline/pose_refiner.h"
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

/// Builds a map incrementally. Feed it frames in increasing order of their stamps.
class Mapper {
 public:
  /// @param drive  calibration, navigation and sweep; must outlive the mapper
  Mapper(const DriveInfo& drive, const MapperOptions& options, PoseSource pose_source);

  /// Maps one frame and returns what is to be kept of it.
  /// @param held_out    registered like any other, but adds no point, colour or registration target
  /// @param given_pose  T_local_lidar where the pose source is kGiven, or kGivenFirst and the frame
  ///        is one of the first
  FrameRecord process(const Frame& frame, bool held_out,
                      const std::optional<RigidMotion>& given_pose = std::nullopt);

  const TileMap& map() const { return map_; }

  /// Puts the frames mapped so far where their submaps are now.
  void settle(std::vector<FrameRecord>& records) const;

  /// Takes up a map where an earlier run left it: its tiles, and the frames' records in order.
  /// `load` reads the latest frames again, which registration needs as targets.
  void resume(TileMap map, const std::vector<FrameRecord>& records, const FrameSource& source);

 private:
  /// A frame's scan as it is mapped, and what registration said of it.
  struct Placed {
    PointCloud scan_lidar;
    std::optional<Twist> velocity;
    RefinedPose refined;
  };
  PointCloud compensated(const PointCloud& scan, const std::optional<Twist>& velocity) const;
  Placed place(const Frame& frame, const MotionPrediction& motion,
               const std::optional<RigidMotion>& given_pose, StageClock& clock) const;
  bool compensates() const;
  bool registers() const;
  void follow_submaps();
  /// Index of the first frame of an earlier run whose scan targets or evidence now depend on.
  int first_to_replay(const std::vector<FrameRecord>& records) const;
  void replay(const PointCloud& scan, const FrameRecord& record, bool looked_at);
  void map_camera(const PointCloud& scan_lidar, const Frame& frame, std::size_t camera,
                  const RigidMotion& T_local_lidar, FrameRecord& record, StageClock& clock);
  /// The points of a scan in the foveal region; where the ray filter says so, without those that
  /// other points hide from the camera.
  PointCloud foveal_part(const PointCloud& scan_lidar, const FovealRegion& region,
                         FrameRecord& record, StageClock& clock) const;
  /// The foveal points and what is sampled between them.
  PointCloud densified(const PointCloud& foveal_cam, const Camera& camera,
                       const RigidMotion& T_local_cam, StageClock& clock);
  /// What the paper's ray filter leaves.
  PointCloud filter_rays(const PointCloud& dense_cam, const FovealRegion& region,
                         const RigidMotion& T_local_lidar, FrameRecord& record);
  /// What the ray filter leaves; the map is looked at where it or the texture asks for that.
  PointCloud visible_part(PointCloud dense_cam, const FovealRegion& region,
                          const RigidMotion& T_local_lidar, FrameRecord& record);
  void map_whole_scan(const PointCloud& scan_lidar, const Frame& frame,
                      const RigidMotion& T_local_lidar, FrameRecord& record, StageClock& clock);

  const DriveInfo& drive_;
  MapperOptions options_;
  PoseSource pose_source_;
  MotionModel motion_model_;
  PoseRefiner refiner_;
  Fusion fusion_;
  RayFilter ray_filter_;
  MovingThings moving_things_;
  TileMap map_;
  SeenMap seen_map_;
  std::optional<Occupancy> occupancy_;  // where surfaces are sampled on a grid
  /// Where the cameras were when the images of the frame at hand were taken.
  std::vector<Camera> cameras_;
};

}  // namespace fovea
