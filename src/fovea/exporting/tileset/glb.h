// Points as a binary glTF 2.0 file.
#pragma once

#include <span>
#include <string>

#include "fovea/map/point_files/point_stream.h"

namespace fovea {

struct Glb {
  std::string bytes;
  double step = 0;  ///< m, of the quantised positions: each is off by up to half of it on each axis
};

/// Member of a mesh's `extras` with the sizes of levels of detail.
inline constexpr const char* kGlbLevels = "points_of_levels";

/// Points (glTF mode 0) with positions quantised to 16 bits of their bounding cube
/// (KHR_mesh_quantization), unlit, and colours in linear light, 16 bits. glTF's axes are y up; the
/// node's matrix turns z-up positions into them, which 3D Tiles turns back.
/// @param points        z up, m; none: a file with an empty scene
/// @param with_sources  also where each point comes from, as attributes _FRAME, _SIGHT and _SOURCE
///                      (docs/viewer-protocol.md)
/// @param levels        numbers of points: the first levels[k] points are a picture of their own,
///                      k halvings coarser. The file states them as the mesh's `extras`.
Glb make_glb(std::span<const ExportPoint> points, bool with_sources,
             std::span<const std::size_t> levels = {});

}  // namespace fovea
