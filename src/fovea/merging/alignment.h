// Where a map's submaps lie in another map of the same place.
#pragma once

#include <cstddef>
#include <vector>

#include "fovea/map/frame_record.h"
#include "fovea/map/map_surfaces.h"

namespace fovea {

struct MapAlignment {
  std::vector<RigidMotion> T_a_submap;  ///< of B's submaps, in A's local frame
  std::size_t met = 0;                  ///< submaps of B that have something of A around them
  std::size_t registered = 0;           ///< of those, that fitted there
  double moved = 0;  ///< m, median over the registered ones: how far from the guess
};

/// Registers each submap of B to what A has around it, and bends B's trajectory so that what it
/// says of itself and what the registrations say agree best. A stays as it is.
/// @param frames_b    of B; they tell how its submaps lie to each other where it came back
/// @param guess_T_a_b of the local frames; good to some 5 m where the two first meet
MapAlignment align_maps(MapSurfaces& a, MapSurfaces& b, const std::vector<FrameRecord>& frames_b,
                        const RigidMotion& guess_T_a_b);

}  // namespace fovea
