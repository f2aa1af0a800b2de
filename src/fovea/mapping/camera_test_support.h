// The camera of the tests.
#pragma once

#include "fovea/camera.h"

namespace fovea {

/// Similar to KITTI's.
inline Camera test_camera() { return {0, 1242, 375, 720, 720, 610, 170, RigidMotion::Identity()}; }

}  // namespace fovea
