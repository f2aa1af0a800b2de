// An order of points along a space-filling curve: what is near in the order is near in the plane.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/mapping/grid_predicates.h"

namespace fovea {

/// Indices of `points` along a Hilbert curve over their bounding square (2^16 cells a side; points
/// of one cell stay in the order given). Linear time.
std::vector<std::uint32_t> hilbert_order(std::span<const GridPoint> points);

}  // namespace fovea
