// The camera of tests of what is made of a scan's projection.
#pragma once

#include "fovea/geometry/camera.h"

namespace fovea {

/// About KITTI's.
inline Camera test_camera() {
  Camera camera;
  camera.width = 1242;
  camera.height = 375;
  camera.fx = camera.fy = 720;
  camera.cx = 610;
  camera.cy = 170;
  return camera;
}

}  // namespace fovea
