// Places around the vehicle to look at a map from.
#pragma once

#include "fovea/camera.h"

namespace fovea {

/// Where a picture is taken from, seen from the LiDAR's place with z up.
struct Viewpoint {
  const char* name;
  double back, up;       ///< m
  double pitch;          ///< rad, downwards
  double field_of_view;  ///< rad, horizontal
  double left = 0;       ///< m
  double yaw = 0;        ///< rad, to the left
};

Camera viewpoint_camera(const Viewpoint& view, int width, int height);

/// T_local_cam. Level, whichever way the vehicle leans: it looks along the LiDAR's x axis, turned
/// by yaw and pitched down.
RigidMotion viewpoint_pose(const Viewpoint& view, const RigidMotion& T_local_lidar);

/// T_local_cam of a camera that looks from one place to another, its rows level. Straight down, the
/// top of the picture is north (y of the local frame).
RigidMotion pose_looking_at(const Eigen::Vector3d& from_local, const Eigen::Vector3d& to_local);

}  // namespace fovea
