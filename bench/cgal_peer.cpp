#include "bench/cgal_peer.h"

#if __has_include(<CGAL/Delaunay_triangulation_2.h>)

// Headers only: without GMP, CGAL takes its own exact numbers.
#define CGAL_DISABLE_GMP 1
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <vector>

namespace fovea::bench {

bool has_cgal() { return true; }

std::size_t cgal_triangles(std::span<const GridPoint> points) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  std::vector<Kernel::Point_2> converted;
  converted.reserve(points.size());
  for (const GridPoint p : points) converted.emplace_back(p.x, p.y);
  return CGAL::Delaunay_triangulation_2<Kernel>(converted.begin(), converted.end())
      .number_of_faces();
}

}  // namespace fovea::bench

#else

namespace fovea::bench {

bool has_cgal() { return false; }
std::size_t cgal_triangles(std::span<const GridPoint>) { return 0; }

}  // namespace fovea::bench

#endif
