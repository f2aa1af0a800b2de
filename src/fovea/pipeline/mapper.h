// The default method, and nothing else. PaperMapper is the paper's.
#pragma once

#include <optional>
#include <vector>

#include "fovea/map/occupancy.h"
#include "fovea/pipeline/dynamic_points.h"
#include "fovea/pipeline/incremental_mapper.h"
#include "fovea/pipeline/map_light.h"
#include "fovea/pipeline/mapper_options.h"
#include "fovea/pipeline/tracker.h"
#include "fovea/pipeline/visible_map.h"

namespace fovea {

class Mapper : public IncrementalMapper {
 public:
  /// @param drive  must outlive the mapper
  Mapper(const DriveInfo& drive, const MapperOptions& options, PoseSource pose_source,
         MapperServices services = {});

  /// Steps 1 and 2 of the method: deskew, registration to the local map.
  TrackedScan track(const Frame& frame, const FrameTask& task) override;
  /// Steps 3 to 9: from visible points to the map.
  FrameResult map_frame(const Frame& frame, TrackedScan tracked) override;

  void apply_deferred_tracking() override { tracker_.apply_deferred(); }
  void apply_deferred_mapping() override;

  const TileMap& map() const override { return map_; }
  TileMap& map() override { return map_; }
  double reach() const override { return reach_; }

  void resume(TileMap map, const std::vector<FrameRecord>& records,
              const FrameSource& source) override;
  void resume_live(TileMap map, const std::vector<FrameRecord>& records,
                   const FindScan& find_scan) override;

 private:
  /// What colors a view.
  struct ViewImage {
    const Image& image;                             ///< empty: a view of a LiDAR without cameras
    std::optional<double> exposure = std::nullopt;  ///< as Frame has it
  };
  /// Steps 3 to 9 for one camera, or for one view of a LiDAR without cameras.
  void map_view(const PointCloud& scan_lidar, const ViewImage& view, const FovealRegion& region,
                const RigidMotion& T_odom_local, FrameResult& result);
  /// Removes coarse points that finer ones replace, in view of the cameras.
  void remove_replaced(const std::vector<Camera>& cameras, const FrameResult& result);
  /// Whether the LiDAR has moved since the periphery was mapped: far surfaces change slowly. To be
  /// called once for each mapped frame, in their order.
  bool periphery_is_due(const RigidMotion& T_odom_lidar);
  /// Steps 7 and 8.
  /// @param visible_cam  points of the scan
  /// @param new_cam      gets colors
  /// @param exposure     of the image
  void color_view(const PointCloud& visible_cam, const ImagePyramid& image,
                  std::optional<double> exposure, const Camera& camera, PointCloud& new_cam,
                  FrameResult& result);
  /// Light of an image relative to that of the map; adds to the figures.
  ViewLight find_light(const ViewColors& image_colors, std::optional<double> exposure, int camera,
                       FrameResult& result);
  /// What later frames need of a frame of an earlier run.
  struct ReplayedParts {
    bool votes = false;           ///< its scan decides which points are dynamic
    bool response = false;        ///< the responses of the cameras depend on its images
    bool with_periphery = false;  ///< it was mapped with the periphery
  };
  void replay(const Frame& read, const FrameResult& frame, const ReplayedParts& parts);
  void replay_response(const Frame& read, const PointCloud& scan_lidar, const FrameResult& frame,
                       const FovealOptions& foveal);
  FovealOptions foveal_options(bool with_periphery) const;
  /// Points and samples of the surface in free cells of the map.
  PointCloud new_points_of(const PointCloud& points_cam, const Camera& camera,
                           const RigidMotion& T_local_cam);

  const DriveInfo& drive_;
  MapperOptions options_;
  MapperServices services_;
  std::vector<Eigen::Vector3d> lidar_origins_;  // m, in the frame of the first LiDAR
  double foveal_reach_;                         // m, from the first LiDAR
  double reach_;
  double ground_below_;  // m, below the LiDAR
  Tracker tracker_;
  TileMap map_;
  VisibleMap visible_map_;
  MapLight light_;
  DynamicPointFilter dynamic_points_;
  Occupancy occupancy_;
  std::optional<RigidMotion> last_periphery_odom_;  // T_odom_lidar of the frame that mapped it
  bool frame_before_has_periphery_ = false;         // the last mapped frame
  std::optional<Eigen::Vector3d> occupancy_update_center_;  // where occupancy_ is out of date
};

}  // namespace fovea
