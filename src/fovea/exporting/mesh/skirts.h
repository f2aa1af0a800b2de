// What hides the cracks between levels of detail.
#pragma once

#include "fovea/exporting/mesh/mesh_patch.h"

namespace fovea {

/// Hangs a strip one voxel deep, away from the sensor, from the edges where the surface leaves the
/// block: a neighbour of another level, which runs within about a voxel of it, leaves no gap to see
/// through.
void add_skirts(MeshPatch& patch);

}  // namespace fovea
