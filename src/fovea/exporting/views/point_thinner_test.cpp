#include "fovea/exporting/views/point_thinner.h"

#include <gtest/gtest.h>

namespace fovea::point_thinner_test {

PointThinner thinned(double cell, std::size_t max_points) {
  PointThinner thinner(cell, max_points);
  for (int x = -50; x < 50; ++x) {
    for (int y = -50; y < 50; ++y) {
      thinner.add({{0.1 * x + 0.05, 0.1 * y + 0.05, 0}, {std::uint8_t(x + 50), 0, 0}});
    }
  }
  return thinner;
}

TEST(PointThinner, KeepsTheFirstPointOfEachCell) {
  const PointThinner all = thinned(0.1, 100'000), half = thinned(0.2, 100'000);
  EXPECT_EQ(all.points().size(), 10'000u);
  EXPECT_EQ(half.points().size(), 2'500u);
  EXPECT_EQ(half.cell(), 0.2);
  EXPECT_NEAR(half.points()[0].position.x(), -4.95, 1e-12);
  EXPECT_EQ(half.points().back().color.r, 98);
}

TEST(PointThinner, CellsGrowUntilThePointsFit) {
  const PointThinner thinner = thinned(0.1, 1'000);
  EXPECT_LE(thinner.points().size(), 1'000u);
  EXPECT_GT(thinner.points().size(), 400u);
  EXPECT_GT(thinner.cell(), 0.25);
}

// A grid has eight cells about its origin, however large they are.
TEST(PointThinner, AFewPointsStayAtLeast) { EXPECT_EQ(thinned(0.1, 1).points().size(), 4u); }

}  // namespace fovea::point_thinner_test
