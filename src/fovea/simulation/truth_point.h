// What is true of one LiDAR return (docs/simulator.md).
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fovea/image.h"

namespace fovea {

struct TruthPoint {
  /// Exact, in the LiDAR's frame at the scan's stamp (m).
  Eigen::Vector3f hit_lidar = Eigen::Vector3f::Zero();
  float time = 0;             ///< s from the stamp
  std::uint32_t surface = 0;  ///< id of the thing hit
  Rgb albedo;                 ///< there, sRGB
  std::uint8_t ring = 0;      ///< 0 is the highest beam
  bool moving = false;
};

}  // namespace fovea
