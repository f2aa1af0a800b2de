// Drawing a map into a camera's view with z-buffered point splats.
#pragma once

#include <limits>
#include <vector>

#include "fovea/camera.h"
#include "fovea/image.h"
#include "fovea/map/color_display.h"
#include "fovea/map/colored_points.h"

namespace fovea {

struct SplatOptions {
  double min_depth = 0.5;  ///< m; nothing nearer to the camera's plane is drawn
  double max_depth = std::numeric_limits<double>::infinity();
  ColorDisplay display = {};  ///< exposure of the image
  float max_radius = 12;      ///< pixels; bounds the footprint of points right before the camera
};

/// A map as one camera sees it; every column has width x height entries, rows from the top.
struct SplatView {
  Image image;                        ///< RGB, black where nothing is
  std::vector<float> depth;           ///< m along the optical axis; infinite where nothing is
  std::vector<std::uint8_t> covered;  ///< 1 where a point was drawn
};

/// Draws points as discs of one sample spacing in radius (so that a surface leaves no holes between
/// its samples). What lies behind the front surface is hidden; of the front surface's samples a
/// pixel takes the one whose projection is nearest to its centre, which neither blurs nor shifts
/// the texture.
/// @param spacing      of each point, see sample_spacing
/// @param T_cam_local  of the camera
SplatView splat(const ColoredPoints& map, const std::vector<float>& spacing, const Camera& camera,
                const RigidMotion& T_cam_local, const SplatOptions& options = {});

}  // namespace fovea
