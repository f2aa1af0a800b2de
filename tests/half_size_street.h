// A simulated street for tests, with images of half of KITTI's size.
#pragma once

#include "fovea/simulation/simulate.h"

namespace fovea {

inline SimulationOptions half_size_street(int frames) {
  SimulationOptions options = simulation_options(Scene::kStreet, "default");
  options.seed = 5;
  options.frames = frames;
  options.format = DriveFormat::kGeneric;
  options.camera.cameras = {kitti_camera(2)};
  options.camera.width = 620;
  options.camera.height = 188;
  options.camera.focal = 360;
  options.camera.cx = 304.5;
  options.camera.cy = 86.2;
  return options;
}

}  // namespace fovea
