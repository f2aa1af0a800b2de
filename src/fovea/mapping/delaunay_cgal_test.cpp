// CGAL as an independent oracle if it is installed. It is GPL: the library never links it.
#if __has_include(<CGAL/Delaunay_triangulation_2.h>)

// Headers only: without GMP, CGAL uses its own exact numbers.
#define CGAL_DISABLE_GMP 1
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <gtest/gtest.h>

#include "fovea/mapping/delaunay_test_support.h"

namespace fovea::delaunay_cgal_test {

using namespace delaunay_test;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalTriangulation = CGAL::Delaunay_triangulation_2<Kernel>;

CgalTriangulation cgal_triangulation(const Points& points) {
  std::vector<Kernel::Point_2> converted;
  for (const GridPoint p : points) converted.emplace_back(p.x, p.y);
  return CgalTriangulation(converted.begin(), converted.end());
}

std::set<std::array<GridPoint, 3>> triangle_set(const CgalTriangulation& triangulation) {
  std::set<std::array<GridPoint, 3>> set;
  for (auto face = triangulation.finite_faces_begin(); face != triangulation.finite_faces_end();
       ++face) {
    std::array<GridPoint, 3> points;
    for (int k = 0; k < 3; ++k) {
      points[k] = {static_cast<std::int32_t>(face->vertex(k)->point().x()),
                   static_cast<std::int32_t>(face->vertex(k)->point().y())};
    }
    std::sort(points.begin(), points.end());
    set.insert(points);
  }
  return set;
}

// Random points on a large grid are hardly ever cocircular, so the triangulation is unique.
TEST(DelaunayAgainstCgal, SameTrianglesOfGenericPoints) {
  for (const std::int32_t extent : {1 << 20, 1 << 26, kMaxGridCoordinate}) {
    for (std::uint64_t seed = 0; seed < 5; ++seed) {
      const Points points = uniform_points(4000, extent, seed);
      DelaunayTriangulation triangulation;
      triangulation.insert(points);
      EXPECT_EQ(delaunay_test::triangle_set(triangulation),
                triangle_set(cgal_triangulation(points)));
    }
  }
}

TEST(DelaunayAgainstCgal, SameTrianglesAfterIncrementalInsertion) {
  Points points = uniform_points(2000, 1 << 26, 20);
  const Points more = uniform_points(2000, 1 << 26, 21);
  DelaunayTriangulation triangulation;
  triangulation.insert(points);
  for (const GridPoint p : more) triangulation.insert(p);
  points.insert(points.end(), more.begin(), more.end());
  EXPECT_EQ(delaunay_test::triangle_set(triangulation), triangle_set(cgal_triangulation(points)));
}

// With cocircular points the triangles may differ, but not the numbers of vertices, triangles and
// hull edges.
TEST(DelaunayAgainstCgal, AsManyTrianglesOfPointsWithTies) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Points points = uniform_points(600, 20, seed);
    DelaunayTriangulation triangulation;
    triangulation.insert(points);
    const CgalTriangulation reference = cgal_triangulation(points);
    EXPECT_EQ(triangulation.points().size(), reference.number_of_vertices());
    EXPECT_EQ(delaunay_test::triangle_set(triangulation).size(), reference.number_of_faces());
    check_delaunay(triangulation, points);
  }
}

}  // namespace fovea::delaunay_cgal_test

#endif
