// Coarse points of the periphery give way to finer ones (docs/method.md 4).
#pragma once

#include "fovea/camera.h"
#include "fovea/map/occupancy.h"
#include "fovea/pipeline/dynamic_points.h"

namespace fovea {

/// Removes the points whose cells hold a point of a finer level, from the tiles in a view. Looks at
/// a quarter of the tiles; which of them, changes with every second frame.
/// @param occupancy  of the map as it is
/// @param reach      of the view, m from the camera
/// @param frame      index of the frame
/// @param filter     forgets the removed points
/// @return number of removed points
std::size_t remove_replaced_points(TileMap& map, const Occupancy& occupancy, const Camera& camera,
                                   const RigidMotion& T_local_cam, double reach, int frame,
                                   DynamicPointFilter& filter);

}  // namespace fovea
