// The response of one camera, estimated while the drive begins (docs/method.md 6).
#pragma once

#include <deque>
#include <vector>

#include "fovea/camera.h"
#include "fovea/mapping/image_pyramid.h"
#include "fovea/mapping/response_fit.h"

namespace fovea {

/// Compares each image with one half a second before. Knows the response after 5 pairs, improves
/// it after 10, 20, ... 160 pairs, and is then finished.
class ResponseEstimate {
 public:
  /// @param points_cam  of the scan: in view and not hidden, camera frame, m
  /// @param footprint   edge of the patch whose mean color a point gets, m
  void add(const std::vector<Eigen::Vector3f>& points_cam, const ImagePyramid& image,
           const Camera& camera, const RigidMotion& T_odom_cam, double footprint);

  /// Continues an earlier run, if that was finished with the estimate.
  /// @param images    that it has added
  /// @param response  after the last of them
  void resume(std::size_t images, const CameraResponse& response);

  const CameraResponse& response() const { return response_; }
  bool is_finished() const;

 private:
  /// The points of one scan in its image.
  struct View {
    std::vector<Eigen::Vector3d> points_odom;
    std::vector<PointInImage> seen;
  };
  std::deque<View> views_;  // the last ones
  ResponseFit fit_;
  std::size_t pairs_ = 0;
  CameraResponse response_;
};

}  // namespace fovea
