// A frame as the calibration of a camera uses it.
#pragma once

#include <optional>
#include <vector>

#include "fovea/geometry/pose_spline.h"
#include "fovea/image.h"
#include "fovea/mapping/calibration/camera_correction.h"
#include "fovea/mapping/calibration/edge_profiles.h"
#include "fovea/mapping/calibration/lidar_edges.h"

namespace fovea {

struct CalibrationView {
  int frame = 0;
  TimeNs stamp = 0;         ///< of the scan
  double image_offset = 0;  ///< s, see DriveInfo::image_offset
  Image image;
  const ImageMask* mask = nullptr;             ///< of the image, if it has one; outlives the view
  std::vector<LidarEdges> edges_lidar;         ///< of each LiDAR, at the stamp (motion compensated)
  std::vector<Eigen::Vector3f> surface_lidar;  ///< points of surfaces, at the stamp

  bool is_masked(const Eigen::Vector2d& pixel) const {
    return mask != nullptr && mask->covers(float(pixel.x()), float(pixel.y()), kMaskMargin);
  }
  static constexpr float kMaskMargin = 8;  ///< pixels
};

/// Where the LiDAR was when a camera took the image of a view.
struct ImageMoment {
  RigidMotion T_image_stamp = RigidMotion::Identity();  ///< LiDAR frames of the two times
  RigidMotion T_local_lidar = RigidMotion::Identity();  ///< at the image
  Twist velocity = Twist::Zero();                       ///< per second, in the LiDAR frame
};
/// Empty where the motion is unknown.
/// @param delay  s, Camera::image_delay
std::optional<ImageMoment> image_moment(const CalibrationView& view, double delay,
                                        const PoseSpline& T_local_lidar);

/// Edge profiles of all views (edge_profiles), in their order.
std::vector<EdgeProfile> profiles_of_views(const std::vector<CalibrationView>& views,
                                           const Camera& camera, const PoseSpline& T_local_lidar);

}  // namespace fovea
