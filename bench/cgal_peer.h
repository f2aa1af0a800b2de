// CGAL's Delaunay triangulation behind plain numbers. CGAL is GPL: only this benchmark includes it.
#pragma once

#include <cstddef>
#include <span>

#include "fovea/mapping/grid_predicates.h"

namespace fovea::bench {

/// Whether CGAL was there when this was built.
bool has_cgal();

/// Triangulates points, all in one call (CGAL sorts them along a curve itself).
/// @return how many finite triangles there are; 0 without CGAL
std::size_t cgal_triangles(std::span<const GridPoint> points);

}  // namespace fovea::bench
