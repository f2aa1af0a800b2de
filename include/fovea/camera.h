// A rectified pinhole camera and a vehicle's calibration.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fovea/sweep_motion.h"

namespace fovea {

/// Pinhole camera without distortion. x right, y down, z forward; pixel centers at integers.
struct Camera {
  int index = 0;  ///< the drive's number for it (KITTI: 0, 1 gray; 2, 3 color)
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  RigidMotion T_cam_lidar = RigidMotion::Identity();
  /// s, images are taken this long after their scan's stamp: the median of a drive.
  double image_delay = 0;

  /// Points nearer than this to the camera's plane are never projected (m).
  static constexpr double kMinDepth = 0.1;

  /// Pixel of a point in the camera's frame; empty if it is not in front of the camera.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& p_cam) const {
    if (!(p_cam.z() > kMinDepth)) return std::nullopt;
    return Eigen::Vector2d(fx * p_cam.x() / p_cam.z() + cx, fy * p_cam.y() / p_cam.z() + cy);
  }
  /// Whether a color can be interpolated there: 0 <= u <= width - 1 and 0 <= v <= height - 1.
  bool in_view(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= 0 && pixel.x() <= width - 1 && pixel.y() >= 0 && pixel.y() <= height - 1;
  }
  /// The camera where it was when the image was taken, against the LiDAR frame at the scan's stamp.
  /// @param motion  of the LiDAR at the stamp; absent: as if it stood
  Camera at_image(const std::optional<SweepMotion>& motion) const {
    Camera moved = *this;
    if (motion && image_delay != 0) {
      moved.T_cam_lidar = T_cam_lidar * motion->T_later_moment(image_delay);
    }
    moved.image_delay = 0;
    return moved;
  }
  /// Camera center in the LiDAR frame.
  Eigen::Vector3d center_lidar() const { return T_cam_lidar.inverse().translation(); }
};

/// Squared distance of a pixel from the principal point; 1 in the farthest corner of the image.
inline float squared_distance_from_center(const Camera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Array2d center(camera.cx, camera.cy);
  const Eigen::Array2d last(camera.width - 1, camera.height - 1);
  const double corner = center.max(last - center).matrix().squaredNorm();
  return static_cast<float>((pixel.array() - center).matrix().squaredNorm() / corner);
}

struct Calibration {
  std::vector<Camera> cameras;  ///< the cameras in use, in the order asked for
  std::optional<RigidMotion> T_imu_lidar;
};

}  // namespace fovea
