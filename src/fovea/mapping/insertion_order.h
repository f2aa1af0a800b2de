// A fast order for the insertion of points into a triangulation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/mapping/grid_predicates.h"

namespace fovea {

/// Indices of `points` in a biased randomized insertion order (Amenta, Choi, Rote 2003). The rounds
/// contain 1/16, 3/16 and 12/16 of the points, drawn by a fixed hash of the index. Each round
/// follows a Hilbert curve over the bounding square (2^15 cells a side), which keeps successive
/// points near. The sparse rounds avoid long thin triangles along the rim, and their flips.
/// Linear time.
std::vector<std::uint32_t> insertion_order(std::span<const GridPoint> points);

}  // namespace fovea
