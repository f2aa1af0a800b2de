// How much brighter one map is than another.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fovea/map/map_store.h"
#include "fovea/mapping/radiometry.h"
#include "fovea/merging/submap_match.h"

namespace fovea {

/// The gain of B: colors of B = colors of A * 2^gain. The mode over some of the points that both
/// maps have; 0 if they have too few.
LogGain gain_of_maps(const MapReader& a, const MapReader& b,
                     const std::vector<RigidMotion>& T_a_submap_b, double tile_size);

/// Sets the gain of one match for each submap of B: of the match with the most common surfaces. The
/// gain is the mode over five submaps of B before and after, with all their partners in A. The
/// other matches have no gain.
void set_gains(const MapReader& a, const MapReader& b, std::vector<SubmapMatch>& matches);

}  // namespace fovea
