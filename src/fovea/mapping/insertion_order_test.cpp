#include "fovea/mapping/insertion_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fovea/core/random.h"

namespace fovea::insertion_order_test {

std::vector<GridPoint> lattice(std::int32_t side) {
  std::vector<GridPoint> points;
  for (std::int32_t y = 0; y < side; ++y) {
    for (std::int32_t x = 0; x < side; ++x) points.push_back({x, y});
  }
  return points;
}

double distance(GridPoint a, GridPoint b) { return std::hypot(a.x - b.x, a.y - b.y); }

TEST(InsertionOrder, HasEveryIndexOnce) {
  for (const std::int32_t side : {0, 1, 2, 50}) {
    auto order = insertion_order(lattice(side));
    std::sort(order.begin(), order.end());
    std::vector<std::uint32_t> all(static_cast<std::size_t>(side) * side);
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(order, all);
  }
}

// The rounds contain 1/16, 3/16 and 12/16 of the points. The curve visits every cell of a lattice
// in steps of one. The points of the last round therefore have a mean distance of 4/3 cells along
// the curve, and hardly more in the plane.
TEST(InsertionOrder, FollowsTheCurveInEachRound) {
  const auto points = lattice(256);
  const auto order = insertion_order(points);
  const auto mean_step = [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin + 1; i < end; ++i) {
      sum += distance(points[order[i - 1]], points[order[i]]);
    }
    return sum / static_cast<double>(end - begin - 1);
  };
  const std::size_t n = points.size();
  EXPECT_LT(mean_step(n * 28 / 100, n), 1.4);
  EXPECT_LT(mean_step(0, n * 6 / 100), 5.0);
}

// Other curves (row by row, Morton's) jump across the lattice somewhere.
TEST(InsertionOrder, NeverJumpsInTheLastRound) {
  const auto points = lattice(128);
  const auto order = insertion_order(points);
  double longest = 0;
  for (std::size_t i = points.size() * 28 / 100; i < points.size(); ++i) {
    longest = std::max(longest, distance(points[order[i - 1]], points[order[i]]));
  }
  EXPECT_LT(longest, 8);
}

TEST(InsertionOrder, SpansTheWholeGrid) {
  const std::vector<GridPoint> corners = {{kMaxGridCoordinate, kMaxGridCoordinate},
                                          {-kMaxGridCoordinate, -kMaxGridCoordinate},
                                          {kMaxGridCoordinate, -kMaxGridCoordinate},
                                          {-kMaxGridCoordinate, kMaxGridCoordinate}};
  EXPECT_EQ(insertion_order(corners).size(), 4u);
}

}  // namespace fovea::insertion_order_test
