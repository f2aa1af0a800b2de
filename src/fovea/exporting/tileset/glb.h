// Points as a binary glTF 2.0 file.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "fovea/base/image.h"

namespace fovea {

struct Glb {
  std::string bytes;
  double step = 0;  ///< m, of the quantised positions: each is off by up to half of it on each axis
};

/// Points (glTF mode 0) with positions quantised to 16 bits of their bounding cube
/// (KHR_mesh_quantization), unlit, and colours in linear light, 16 bits. glTF's axes are y up; the
/// node's matrix turns z-up positions into them, which 3D Tiles turns back.
/// @param positions  z up, m; at least one
/// @param colors     sRGB, as many
Glb make_glb(const std::vector<Eigen::Vector3d>& positions, const std::vector<Rgb>& colors);

}  // namespace fovea
