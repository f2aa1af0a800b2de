#include "fovea/rendering/viewpoint.h"

#include <cmath>

namespace fovea {

Camera viewpoint_camera(const Viewpoint& view, int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = 0.5 * width / std::tan(0.5 * view.field_of_view);
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

RigidMotion viewpoint_pose(const Viewpoint& view, const RigidMotion& T_local_lidar) {
  const Eigen::Vector3d forward = T_local_lidar.linear().col(0);
  const Eigen::AngleAxisd heading(std::atan2(forward.y(), forward.x()), Eigen::Vector3d::UnitZ());
  RigidMotion T_local_view = RigidMotion::Identity();
  T_local_view.translation() = T_local_lidar.translation();
  T_local_view.rotate(heading);
  T_local_view.translate(Eigen::Vector3d(-view.back, view.left, view.up));
  T_local_view.rotate(Eigen::AngleAxisd(view.yaw, Eigen::Vector3d::UnitZ()));
  T_local_view.rotate(Eigen::AngleAxisd(view.pitch, Eigen::Vector3d::UnitY()));
  RigidMotion T_view_cam = RigidMotion::Identity();  // x right, y down, z forward
  T_view_cam.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return T_local_view * T_view_cam;
}

RigidMotion pose_looking_at(const Eigen::Vector3d& from_local, const Eigen::Vector3d& to_local) {
  constexpr double kSteep = 1e-3;
  const Eigen::Vector3d forward = (to_local - from_local).normalized();
  Eigen::Vector3d right = forward.cross(Eigen::Vector3d::UnitZ());
  if (right.norm() < kSteep) right = forward.cross(Eigen::Vector3d::UnitY());
  right.normalize();
  RigidMotion T_local_cam = RigidMotion::Identity();
  T_local_cam.translation() = from_local;
  T_local_cam.linear() << right, forward.cross(right), forward;
  return T_local_cam;
}

}  // namespace fovea
