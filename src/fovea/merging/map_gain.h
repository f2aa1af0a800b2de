// How much brighter one map is than another.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "fovea/map/map_store.h"

namespace fovea {

/// The gain, a channel, that brings B's colours to A's: median over some of the points that both
/// have. 1 where too few tell.
Eigen::Array3f gain_of_maps(const MapReader& a, const MapReader& b,
                            const std::vector<RigidMotion>& T_a_submap_b, double tile_size);

}  // namespace fovea
