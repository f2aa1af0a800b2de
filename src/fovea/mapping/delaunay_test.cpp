#include "fovea/mapping/delaunay.h"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <string>

#include "fovea/mapping/delaunay_test_support.h"

namespace fovea::delaunay_test {

using namespace delaunay_test;

struct Case {
  std::string name;
  Points points;
};

Points lattice(std::int32_t columns, std::int32_t rows, std::int32_t step) {
  Points points;
  for (std::int32_t y = 0; y < rows; ++y) {
    for (std::int32_t x = 0; x < columns; ++x) points.push_back({x * step, y * step});
  }
  return points;
}

// All integer points on the circle x^2 + y^2 = 5^2 13^2 17^2: 108 cocircular points.
Points circle() {
  Points points;
  constexpr std::int32_t kRadius = 5 * 13 * 17;
  for (std::int32_t x = -kRadius; x <= kRadius; ++x) {
    for (std::int32_t y = -kRadius; y <= kRadius; ++y) {
      if (x * x + y * y == kRadius * kRadius) points.push_back({x, y});
    }
  }
  return points;
}

Points clusters() {
  Random random(5);
  Points points;
  for (int c = 0; c < 12; ++c) {
    const std::int32_t x = uniform(random, -kMaxGridCoordinate / 2, kMaxGridCoordinate / 2);
    const std::int32_t y = uniform(random, -kMaxGridCoordinate / 2, kMaxGridCoordinate / 2);
    const std::int32_t extent = 1 << uniform(random, 2, 16);
    for (const GridPoint p : uniform_points(40, extent, random.next())) {
      points.push_back({x + p.x, y + p.y});
    }
  }
  return points;
}

// Within one grid line of y = x / 3, across the whole grid.
Points nearly_collinear() {
  Random random(6);
  Points points;
  for (int i = 0; i < 400; ++i) {
    const std::int32_t x = uniform(random, -kMaxGridCoordinate, kMaxGridCoordinate);
    points.push_back({x, x / 3 + uniform(random, -1, 1)});
  }
  return points;
}

// Rings of a LiDAR: rows of points with equal spacing and a little noise, row after row.
Points scan_lines() {
  Random random(7);
  Points points;
  for (int row = 0; row < 24; ++row) {
    for (int i = 0; i < 100; ++i) {
      points.push_back({i * 3000 + uniform(random, -40, 40), row * 9000 + uniform(random, -9, 9)});
    }
  }
  return points;
}

std::vector<Case> cases() {
  constexpr std::int32_t kMax = kMaxGridCoordinate;
  const Points line = {{0, 0}, {-4, -8}, {10, 20}, {1, 2}, {3, 6}, {1, 2}, {-100, -200}};
  Points line_then_corner = line;
  line_then_corner.insert(line_then_corner.end(), {{5, 11}, {-7, -13}, {4, 8}, {2, 4}, {50, 100}});
  return {{"Nothing", {}},
          {"OnePoint", {{3, 4}}},
          {"TwoPoints", {{3, 4}, {-5, 6}}},
          {"OnePointOften", Points(20, GridPoint{7, 7})},
          {"Line", line},
          {"LineThenCorner", line_then_corner},
          {"HorizontalLine", lattice(60, 1, 5)},
          {"GridCorners", {{-kMax, -kMax}, {kMax, -kMax}, {kMax, kMax}, {-kMax, kMax}, {0, 0}}},
          {"Lattice", lattice(23, 17, 1024)},
          {"Circle", circle()},
          {"Uniform", uniform_points(1500, 1 << 20, 1)},
          {"UniformOnTheWholeGrid", uniform_points(1500, kMax, 2)},
          {"ManyDuplicates", uniform_points(3000, 12, 3)},
          {"Clusters", clusters()},
          {"NearlyCollinear", nearly_collinear()},
          {"ScanLines", scan_lines()}};
}

class DelaunayOf : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Inputs, DelaunayOf, testing::ValuesIn(cases()),
                         [](const auto& instance) { return instance.param.name; });

void expect_vertices_of_points(const DelaunayTriangulation& triangulation, const Points& points,
                               const std::vector<std::int32_t>& vertices) {
  ASSERT_EQ(vertices.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(triangulation.points()[vertices[i]], points[i]);
  }
}

TEST_P(DelaunayOf, AllPointsAtOnce) {
  const Points& points = GetParam().points;
  DelaunayTriangulation triangulation;
  const auto vertices = triangulation.insert(points);
  check_delaunay(triangulation, points);
  expect_vertices_of_points(triangulation, points, vertices);
}

TEST_P(DelaunayOf, OneByOne) {
  const Points& points = GetParam().points;
  DelaunayTriangulation triangulation;
  std::set<GridPoint> known;
  for (const GridPoint p : points) {
    const auto insertion = triangulation.insert(p);
    EXPECT_EQ(insertion.inserted, known.insert(p).second);
    EXPECT_EQ(triangulation.points()[insertion.vertex], p);
  }
  check_delaunay(triangulation, points);
}

TEST_P(DelaunayOf, EveryStepOfTheWay) {
  const Points& points = GetParam().points;
  DelaunayTriangulation triangulation;
  Points so_far;
  std::int32_t hint = DelaunayTriangulation::kNoTriangle;
  for (std::size_t i = 0; i < std::min<std::size_t>(points.size(), 150); ++i) {
    hint = triangulation.insert(points[i], hint).triangle;
    so_far.push_back(points[i]);
    ASSERT_NO_FATAL_FAILURE(check_delaunay(triangulation, so_far)) << "after point " << i;
  }
}

TEST_P(DelaunayOf, HalfAtOnceThenHalfWithTriangles) {
  const Points& points = GetParam().points;
  const auto half = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
  const Points first(points.begin(), half), second(half, points.end());
  DelaunayTriangulation triangulation;
  triangulation.insert(first);
  // Any triangle is allowed: take right ones, wrong ones and the same one many times.
  Random random(8);
  std::vector<std::int32_t> triangles;
  for (std::size_t i = 0; i < second.size(); ++i) {
    triangles.push_back(
        static_cast<std::int32_t>(random.below(triangulation.triangle_count() + 1)) - 1);
  }
  const std::size_t before = triangulation.points().size();
  const auto point_of = triangulation.insert(second, triangles);
  check_delaunay(triangulation, points);
  ASSERT_EQ(point_of.size(), triangulation.points().size() - before);
  for (std::size_t i = 0; i < point_of.size(); ++i) {
    EXPECT_EQ(triangulation.points()[before + i], second[point_of[i]]);
  }
}

/// Twice inserts a point into each triangle with a positive `weight`: the weighted mean of its
/// corners. The first corner has that weight, the others 1.
template <class F>
void check_points_in_triangles(Points points, F&& weight) {
  DelaunayTriangulation triangulation;
  triangulation.insert(points);
  for (int round = 0; round < 2; ++round) {
    Points means;
    std::vector<std::int32_t> triangles;
    for (std::size_t t = 0; t < triangulation.triangle_count(); ++t) {
      const std::int64_t w = weight(t);
      if (!triangulation.is_finite(t) || w == 0) continue;
      const auto [a, b, c] = triangulation.vertices(t);
      const auto at = triangulation.points();
      const std::int64_t x = w * at[a].x + at[b].x + at[c].x, y = w * at[a].y + at[b].y + at[c].y;
      means.push_back(
          {static_cast<std::int32_t>(x / (w + 2)), static_cast<std::int32_t>(y / (w + 2))});
      triangles.push_back(static_cast<std::int32_t>(t));
    }
    triangulation.insert(means, triangles);
    points.insert(points.end(), means.begin(), means.end());
    check_delaunay(triangulation, points);
  }
}

TEST_P(DelaunayOf, CentroidsInTheirTriangles) {
  check_points_in_triangles(GetParam().points, [](std::size_t) { return 1; });
}

// Split triangles lie next to whole ones, and many edges between parts stay.
TEST_P(DelaunayOf, PointsInSomeTrianglesNearACorner) {
  Random random(12);
  check_points_in_triangles(GetParam().points, [&](std::size_t) {
    return random.uniform() < 0.4 ? 0 : 1 + static_cast<int>(40 * random.uniform());
  });
}

TEST(DelaunayTriangulation, CirclesAreEmptyOfAllVertices) {
  DelaunayTriangulation triangulation;
  triangulation.insert(uniform_points(250, 1000, 9));
  const auto points = triangulation.points();
  for (std::size_t t = 0; t < triangulation.triangle_count(); ++t) {
    if (!triangulation.is_finite(t)) continue;
    const auto [a, b, c] = triangulation.vertices(t);
    for (const GridPoint p : points) {
      ASSERT_FALSE(in_circle_exact(points[a], points[b], points[c], p));
    }
  }
}

TEST(DelaunayTriangulation, OfGenericPointsDoesNotDependOnTheOrder) {
  Points points = uniform_points(2000, 1 << 27, 10);
  DelaunayTriangulation reference;
  reference.insert(points);
  Random random(11);
  for (int k = 0; k < 5; ++k) {
    for (std::size_t i = points.size() - 1; i > 0; --i) {
      std::swap(points[i], points[random.below(i + 1)]);
    }
    DelaunayTriangulation shuffled, one_by_one;
    shuffled.insert(points);
    for (const GridPoint p : points) one_by_one.insert(p);
    EXPECT_EQ(triangle_set(shuffled), triangle_set(reference));
    EXPECT_EQ(triangle_set(one_by_one), triangle_set(reference));
  }
}

TEST(DelaunayTriangulation, PointOnAnEdgeAndOnTheHullSplitsIt) {
  DelaunayTriangulation triangulation;
  Points points = {{0, 0}, {8, 0}, {8, 8}, {0, 8}};
  for (const GridPoint p : {GridPoint{4, 4}, {4, 0}, {8, 6}, {0, 2}, {2, 8}, {12, 0}, {-4, 8}}) {
    points.push_back(p);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    triangulation.insert(points[i]);
    check_delaunay(triangulation, Points(points.begin(), points.begin() + i + 1));
  }
}

TEST(DelaunayTriangulation, IsEmptyAgainAfterClear) {
  const Points points = uniform_points(300, 5000, 12);
  DelaunayTriangulation triangulation, fresh;
  triangulation.insert(lattice(9, 9, 3));
  triangulation.clear();
  EXPECT_EQ(triangulation.points().size(), 0u);
  EXPECT_EQ(triangulation.triangle_count(), 0u);
  triangulation.insert(points);
  fresh.insert(points);
  ASSERT_EQ(triangulation.triangle_count(), fresh.triangle_count());
  for (std::size_t t = 0; t < fresh.triangle_count(); ++t) {
    EXPECT_EQ(triangulation.vertices(t), fresh.vertices(t));
  }
}

TEST(DelaunayTriangulation, RejectsInputBeyondExactArithmetic) {
  DelaunayTriangulation triangulation;
  triangulation.insert(Points{{0, 0}, {9, 0}, {0, 9}});
  constexpr std::int32_t kBeyond = kMaxGridCoordinate + 1;
  for (const GridPoint p : {GridPoint{kBeyond, 0}, {0, kBeyond}, {-kBeyond, 0}, {0, -kBeyond}}) {
    EXPECT_THROW(triangulation.insert(p), std::invalid_argument);
    EXPECT_THROW(triangulation.insert(Points{p}), std::invalid_argument);
    EXPECT_THROW(triangulation.insert(Points{p}, std::vector<std::int32_t>{0}),
                 std::invalid_argument);
  }
  EXPECT_THROW(triangulation.insert(GridPoint{1, 1}, 4), std::invalid_argument);
  EXPECT_THROW(triangulation.insert(GridPoint{1, 1}, -2), std::invalid_argument);
  EXPECT_THROW(triangulation.insert(Points{{1, 1}}, std::vector<std::int32_t>{4}),
               std::invalid_argument);
  EXPECT_THROW(triangulation.insert(Points{{1, 1}}, std::vector<std::int32_t>{}),
               std::invalid_argument);
  check_delaunay(triangulation, {{0, 0}, {9, 0}, {0, 9}});
}

}  // namespace fovea::delaunay_test
