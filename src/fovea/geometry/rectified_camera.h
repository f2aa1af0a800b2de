// The pinhole camera in a camera with a lens.
#pragma once

#include <optional>

#include "fovea/camera.h"
#include "fovea/geometry/lens.h"

namespace fovea {

/// The largest image that a pinhole camera in the same place, looking the same way and of the same
/// focal lengths can show without a pixel that the lens did not take: index, T_cam_lidar and
/// image_delay are left as by default. Of a camera without distortion that is its own image.
/// Empty if hardly a pixel is left, or a side would be longer than `max_side`.
/// @param max_field_of_view  rad, below pi: what a lens sees beyond it, across the width and the
///                           height, is cut off (a fisheye's border would take most of the pixels)
/// @param max_side           pixels
std::optional<Camera> rectified_camera(const LensCamera& camera, double max_field_of_view,
                                       int max_side);

}  // namespace fovea
