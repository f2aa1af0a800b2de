// Cameras of pictures that no vehicle's place determines.
#pragma once

#include <string>

#include "fovea/camera.h"
#include "fovea/point_cloud.h"

namespace fovea::app {

struct PlacedCamera {
  Camera camera;
  RigidMotion T_local_cam;
};

/// A camera at one place that looks to another; CLI::ValidationError if one is none, or both are
/// the same.
/// @param from, to  "X,Y,Z" in the local frame, m
PlacedCamera free_camera(const std::string& from, const std::string& to, int width, int height);

/// Above the middle of a map, north up, so high that all of it is in view.
PlacedCamera above_map(const PointCloud& points_local, int width, int height);

}  // namespace fovea::app
