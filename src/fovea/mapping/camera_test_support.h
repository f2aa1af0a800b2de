// The camera of tests of what is made of a scan's projection.
#pragma once

#include "fovea/geometry/camera.h"

namespace fovea {

/// About KITTI's.
inline Camera test_camera() { return {0, 1242, 375, 720, 720, 610, 170, RigidMotion::Identity()}; }

}  // namespace fovea
