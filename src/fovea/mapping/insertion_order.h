// The order in which points are best inserted into a triangulation.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/mapping/grid_predicates.h"

namespace fovea {

/// Indices of `points` in a biased randomised insertion order (Amenta, Choi, Rote 2003): a
/// sixteenth of the points, a further three sixteenths, then the rest, drawn by a fixed hash of the
/// index, and each of these rounds along a Hilbert curve over the bounding square (2^15 cells a
/// side). The curve keeps the next point near the last; the sparse rounds before spare the long
/// thin triangles, and their flips, that come of adding points along the edge of what is there.
/// Linear time.
std::vector<std::uint32_t> insertion_order(std::span<const GridPoint> points);

}  // namespace fovea
