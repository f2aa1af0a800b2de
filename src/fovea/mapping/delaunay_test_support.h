// Shared by the tests of the triangulation: clouds of points and checks of the Delaunay property.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "fovea/core/random.h"
#include "fovea/mapping/delaunay.h"

namespace fovea::delaunay_test {

using Points = std::vector<GridPoint>;

inline std::int32_t uniform(Random& random, std::int32_t low, std::int32_t high) {
  return low + static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(high - low) + 1));
}

inline Points uniform_points(std::size_t count, std::int32_t extent, std::uint64_t seed) {
  Random random(seed);
  Points points(count);
  for (GridPoint& p : points) {
    p.x = uniform(random, -extent, extent);
    p.y = uniform(random, -extent, extent);
  }
  return points;
}

/// Each finite triangle's points, smallest first: equal for equal triangulations.
inline std::set<std::array<GridPoint, 3>> triangle_set(const DelaunayTriangulation& triangulation) {
  std::set<std::array<GridPoint, 3>> set;
  for (std::size_t t = 0; t < triangulation.triangle_count(); ++t) {
    if (!triangulation.is_finite(t)) continue;
    const auto [a, b, c] = triangulation.vertices(t);
    std::array points{triangulation.points()[a], triangulation.points()[b],
                      triangulation.points()[c]};
    std::sort(points.begin(), points.end());
    set.insert(points);
  }
  return set;
}

/// Corners of the convex hull, counter-clockwise (Andrew's monotone chain); at most two if
/// collinear.
inline Points convex_hull(Points points) {
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  Points hull;
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const GridPoint p : points) {
      while (hull.size() >= start + 2 && orientation(hull.end()[-2], hull.back(), p) <= 0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

inline std::int64_t twice_area(std::span<const GridPoint> polygon) {
  std::int64_t area = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    area += orientation(polygon[0], polygon[i - 1], polygon[i]);
  }
  return area;
}

/// The corner of `triangle` whose opposite edge leads to `neighbor` through the edge (a, b); -1 if
/// there is none.
inline int corner_opposite(const DelaunayTriangulation& triangulation, std::size_t triangle,
                           std::int32_t a, std::int32_t b) {
  const auto v = triangulation.vertices(triangle);
  for (int k = 0; k < 3; ++k) {
    if (v[(k + 1) % 3] == a && v[(k + 2) % 3] == b) return k;
  }
  return -1;
}

/// Neighbors refer to each other, triangles are counter-clockwise, and no vertex lies inside the
/// circle of a neighboring triangle. For a triangulation of the convex hull every circle is then
/// empty.
inline void check_triangles(const DelaunayTriangulation& triangulation) {
  const auto points = triangulation.points();
  for (std::size_t t = 0; t < triangulation.triangle_count(); ++t) {
    const auto v = triangulation.vertices(t);
    if (triangulation.is_finite(t)) {
      ASSERT_GT(orientation(points[v[0]], points[v[1]], points[v[2]]), 0) << "triangle " << t;
    }
    for (int k = 0; k < 3; ++k) {
      const std::int32_t neighbor = triangulation.neighbor(t, k);
      ASSERT_GE(neighbor, 0);
      const auto n = static_cast<std::size_t>(neighbor);
      const int back = corner_opposite(triangulation, n, v[(k + 2) % 3], v[(k + 1) % 3]);
      ASSERT_GE(back, 0) << "triangles " << t << " and " << n;
      ASSERT_EQ(triangulation.neighbor(n, back), static_cast<std::int32_t>(t));
      if (triangulation.is_finite(t) && triangulation.is_finite(n)) {
        const GridPoint apex = points[triangulation.vertices(n)[back]];
        ASSERT_FALSE(in_circle_exact(points[v[0]], points[v[1]], points[v[2]], apex))
            << "triangles " << t << " and " << n;
      }
    }
  }
}

/// All of that, and: the triangles cover the convex hull of `input` without overlap, every distinct
/// point is a vertex, and Euler's formula holds.
inline void check_delaunay(const DelaunayTriangulation& triangulation, const Points& input) {
  const std::set<GridPoint> distinct(input.begin(), input.end());
  const auto points = triangulation.points();
  ASSERT_EQ(std::set<GridPoint>(points.begin(), points.end()), distinct);
  ASSERT_EQ(points.size(), distinct.size());

  const Points hull = convex_hull(input);
  if (hull.size() < 3) {
    ASSERT_EQ(triangulation.triangle_count(), 0u);
    return;
  }
  check_triangles(triangulation);
  std::int64_t area = 0;
  std::size_t finite = 0;
  std::set<std::int32_t> used;
  for (std::size_t t = 0; t < triangulation.triangle_count(); ++t) {
    if (!triangulation.is_finite(t)) continue;
    const auto [a, b, c] = triangulation.vertices(t);
    area += orientation(points[a], points[b], points[c]);
    used.insert({a, b, c});
    ++finite;
  }
  ASSERT_EQ(area, twice_area(hull));
  ASSERT_EQ(used.size(), points.size());
  const std::size_t hull_edges = triangulation.triangle_count() - finite;
  ASSERT_EQ(finite, 2 * points.size() - 2 - hull_edges);
}

}  // namespace fovea::delaunay_test
