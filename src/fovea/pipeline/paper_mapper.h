// The method of Kumar, McBride and Pandey, "Real Time Incremental Foveal Texture Mapping for
// Autonomous Vehicles", and nothing else. Mapper is the default method.
#pragma once

#include <optional>
#include <vector>

#include "fovea/pipeline/incremental_mapper.h"
#include "fovea/pipeline/motion_model.h"
#include "fovea/pipeline/paper_options.h"

namespace fovea {

class PaperMapper : public IncrementalMapper {
 public:
  /// @param drive  must outlive the mapper
  PaperMapper(const DriveInfo& drive, const PaperOptions& options, PoseSource pose_source,
              MapperServices services = {});

  /// The whole method: pose and map.
  FrameResult map_frame(const Frame& frame, TrackedScan tracked) override;
  /// Starts the result; map_frame() finds the pose.
  TrackedScan track(const Frame&, const FrameTask& task) override;

  const TileMap& map() const override { return map_; }
  TileMap& map() override { return map_; }
  double reach() const override;

  void resume(TileMap map, const std::vector<FrameRecord>& records,
              const FrameSource& source) override;
  void resume_live(TileMap map, const std::vector<FrameRecord>& records,
                   const FindScan& find_scan) override;

 private:
  /// Enters the poses of an earlier run.
  /// @return the last mapped frame; null if there is none
  const FrameRecord* follow(const std::vector<FrameRecord>& records);
  /// Makes a scan the one that the next scan is registered to.
  void keep_previous(const PointCloud& scan_lidar, const RigidMotion& T_local_lidar);
  struct RegisteredScan {
    RegistrationCloud cloud_lidar;
    RigidMotion T_local_lidar;
  };
  bool uses_registration() const;
  /// The pose by navigation's motion since the previous scan, or by constant velocity. A given pose
  /// takes its place.
  MotionGuess raw_pose(const Frame& frame, const FrameTask& task, FrameResult& result);
  /// The points to register.
  std::vector<Eigen::Vector3f> densified(const PointCloud& scan_lidar,
                                         const std::vector<std::uint8_t>& is_ground) const;
  RegistrationOptions registration_options() const;
  /// The raw pose if registration fails.
  RigidMotion register_to_previous(const RegistrationCloud& cloud_lidar,
                                   const RigidMotion& raw_T_local_lidar, FrameResult& result) const;
  bool is_submap_due(TimeNs stamp, const RigidMotion& T_local_lidar) const;
  /// Passes the pose to the motion model, opens a submap if one is due, and loads the tiles around
  /// it. Submaps never move here: the frames odom and local are the same.
  void apply_pose(const RigidMotion& T_local_lidar, FrameResult& result);
  PointCloud visible_points(const PointCloud& points_cam, const FovealRegion& region,
                            const RigidMotion& T_local_lidar, FrameResult& result);
  void add_points(PointCloud points_cam, const RigidMotion& T_local_cam, FrameResult& result);
  void add_whole_scan(const PointCloud& scan_lidar, const Frame& frame,
                      const std::vector<Camera>& cameras, FrameResult& result);

  const DriveInfo& drive_;
  PaperOptions options_;
  PoseSource pose_source_;
  MapperServices services_;
  MotionHistory history_;
  MotionModel motion_model_;
  TimeNs submap_start_ = 0;  // of the last submap
  std::optional<RegisteredScan> previous_;
  RayFilter ray_filter_;
  TileMap map_;
};

}  // namespace fovea
