// Light (docs/method.md 6): how the images of a drive show the colors of the map.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/map/tile_map.h"
#include "fovea/mapping/fusion/exposure_graph.h"
#include "fovea/mapping/response_estimate.h"
#include "fovea/pipeline/visible_map.h"

namespace fovea {

/// Estimates the response of each camera, the gain of each image, and from these the gains of the
/// submaps.
class MapLight {
 public:
  /// Enters the submaps up to that of a frame, and sets the gains of the map.
  /// @param map  may have further submaps when it continues an earlier run
  void follow(std::size_t submap, const RigidMotion& T_odom_lidar, TileMap& map);

  /// Improves the response of a camera while the drive begins.
  /// @param points_cam  of the scan: in view and not hidden, camera frame, m
  /// @param footprint   edge of the patch whose mean color a point gets, m
  void learn_response(const std::vector<Eigen::Vector3f>& points_cam, const ImagePyramid& image,
                      const Camera& camera, const RigidMotion& T_odom_cam, double footprint);
  const CameraResponse& response(int camera) { return cameras_[camera].response.response(); }

  /// The record of the next image. An image that shows too little of the map has the gain of the
  /// camera's image before; the first image of a drive has the exposure of the map. Sets the gains
  /// of the submaps if the image shows a revisited place.
  /// @param differences  of the image under the camera's response
  /// @param exposure     as DriveInfo::image_exposure()
  ViewRecord next(int camera, const MapDifferences& differences, std::optional<double> exposure,
                  TileMap& map);
  /// How an image shows the map, by the present gains.
  /// @param submap  of the image
  ViewLight light(const ViewRecord& view, std::size_t submap) const;

  /// Continues an earlier run: enters the next image, which next() returned.
  void replay(const ViewRecord& view, std::optional<double> exposure, TileMap& map);
  /// Whether the responses still depend on the images of an earlier run, which learn_response()
  /// then needs.
  /// @param records  of all frames of that run
  bool needs_images(const std::vector<FrameRecord>& records);

 private:
  struct CameraState {
    ResponseEstimate response;
    std::optional<LogGain> gain;  // of the last image, relative to its submap
    std::size_t submap = 0;       // of that image
  };
  /// Gain relative to the map of an image that does not show the map.
  LogGain gain_before(int camera) const;

  std::map<int, CameraState> cameras_;
  ExposureGraph graph_;
  Eigen::Vector3d opened_odom_ = Eigen::Vector3d::Zero();  // LiDAR where the last submap was opened
  std::set<std::size_t> revisiting_;  // submaps that were compared with an earlier one
};

}  // namespace fovea
