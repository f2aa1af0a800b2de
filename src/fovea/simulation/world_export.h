// The truth about everything that stands still along a drive.
#pragma once

#include <set>

#include "fovea/simulation/scenery.h"
#include "fovea/world/world_file.h"

namespace fovea {

/// Chunks of a scenery as one mesh.
World export_world(const Scenery& scenery, const std::set<std::uint32_t>& chunks,
                   const RigidMotion& T_local_world);

}  // namespace fovea
