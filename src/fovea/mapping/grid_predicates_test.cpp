#include "fovea/mapping/grid_predicates.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "fovea/core/random.h"

namespace fovea::grid_predicates_test {

GridPoint draw(Random& random, std::int32_t extent) {
  const auto bound = 2 * static_cast<std::uint64_t>(extent) + 1;
  return {static_cast<std::int32_t>(random.below(bound)) - extent,
          static_cast<std::int32_t>(random.below(bound)) - extent};
}

// The filtered and the exact predicate agree on all rotations of these points.
void expect_agreement(std::array<GridPoint, 4> p) {
  for (int turn = 0; turn < 4; ++turn) {
    std::rotate(p.begin(), p.begin() + 1, p.end());
    auto [a, b, c, d] = p;
    if (orientation(a, b, c) < 0) std::swap(b, c);
    ASSERT_EQ(in_circle(a, b, c, d), in_circle_exact(a, b, c, d))
        << a.x << ' ' << a.y << ", " << b.x << ' ' << b.y << ", " << c.x << ' ' << c.y << ", "
        << d.x << ' ' << d.y;
  }
}

TEST(GridPredicates, OrientationAtTheEndsOfTheGrid) {
  constexpr std::int32_t kMax = kMaxGridCoordinate;
  EXPECT_EQ(orientation({-kMax, -kMax}, {kMax, -kMax}, {kMax, kMax}), std::int64_t{1} << 60);
  EXPECT_EQ(orientation({-kMax, -kMax}, {0, 0}, {kMax, kMax}), 0);
  EXPECT_GT(orientation({-kMax, -kMax}, {kMax, kMax}, {-1, 0}), 0);
  EXPECT_LT(orientation({-kMax, -kMax}, {kMax, kMax}, {0, -1}), 0);
}

TEST(GridPredicates, InCircleAtTheEndsOfTheGrid) {
  constexpr std::int32_t kMax = kMaxGridCoordinate;
  const GridPoint a{-kMax, -kMax}, b{kMax, -kMax}, c{kMax, kMax};
  EXPECT_FALSE(in_circle(a, b, c, {-kMax, kMax}));  // the square's fourth corner is on the circle
  EXPECT_TRUE(in_circle(a, b, c, {-kMax + 1, kMax}));
  EXPECT_TRUE(in_circle(a, b, c, {-kMax, kMax - 1}));
  EXPECT_TRUE(in_circle(a, b, {-kMax, kMax - 1}, {kMax, kMax - 2}));
  EXPECT_FALSE(in_circle(a, b, {-kMax, kMax - 1}, {kMax, kMax - 1}));
  EXPECT_FALSE(in_circle(a, b, {-kMax, kMax - 1}, {kMax, kMax}));
}

TEST(GridPredicates, FilterAgreesWithIntegersOnRandomPoints) {
  Random random(1);
  for (int i = 0; i < 200000; ++i) {
    const std::int32_t extent = 1 << random.below(30);
    expect_agreement(
        {draw(random, extent), draw(random, extent), draw(random, extent), draw(random, extent)});
  }
}

// Four points of one circle: (x, y) -> (-y, x) and reflections about its center keep the radius.
// One of them is then moved by at most one grid line.
TEST(GridPredicates, FilterAgreesWithIntegersOnNearlyCocircularPoints) {
  Random random(2);
  for (int i = 0; i < 200000; ++i) {
    const std::int32_t extent = 1 << random.below(28);
    const GridPoint center = draw(random, kMaxGridCoordinate / 4), arm = draw(random, extent);
    std::array<GridPoint, 4> points;
    for (GridPoint& p : points) {
      GridPoint turned = arm;
      if (random.below(2) == 1) turned = {turned.y, turned.x};
      if (random.below(2) == 1) turned.x = -turned.x;
      if (random.below(2) == 1) turned.y = -turned.y;
      p = {center.x + turned.x, center.y + turned.y};
    }
    const GridPoint nudge = draw(random, 1);
    points[0] = {points[0].x + nudge.x, points[0].y + nudge.y};
    expect_agreement(points);
  }
}

TEST(GridPredicates, FilterAgreesWithIntegersOnNearlyCollinearPoints) {
  Random random(3);
  for (int i = 0; i < 100000; ++i) {
    const GridPoint start = draw(random, kMaxGridCoordinate / 2), step = draw(random, 1 << 14);
    std::array<GridPoint, 4> points;
    for (GridPoint& p : points) {
      const auto steps = static_cast<std::int32_t>(random.below(1 << 14));
      const GridPoint nudge = draw(random, 1);
      p = {start.x + steps * step.x + nudge.x, start.y + steps * step.y + nudge.y};
      ASSERT_TRUE(on_grid(p));
    }
    expect_agreement(points);
  }
}

}  // namespace fovea::grid_predicates_test
