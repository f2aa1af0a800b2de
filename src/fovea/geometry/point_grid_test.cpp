#include "fovea/geometry/point_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "fovea/core/random.h"
#include "fovea/geometry/point_index.h"

namespace fovea::point_grid_test {

Eigen::Vector3f random_point(Random& random, double half_width) {
  Eigen::Vector3f p;
  for (float& value : p) value = static_cast<float>(random.uniform(-half_width, half_width));
  return p;
}

std::vector<Eigen::Vector3f> random_points(int count, double half_width, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < count; ++i) points.push_back(random_point(random, half_width));
  return points;
}

TEST(PointGrid, FindsTheNearestAsTryingAllDoes) {
  const std::vector<Eigen::Vector3f> points = random_points(3000, 4, 1);
  const PointGrid grid(points, 0.5f);
  Random random(2);
  int found = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector3f query = random_point(random, 5);
    const auto reach = static_cast<float>(random.uniform(0.01, 1.5));
    Neighbor truth{0, std::numeric_limits<float>::infinity()};
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const float squared = (points[i] - query).squaredNorm();
      if (squared < truth.squared_distance && squared <= reach * reach) truth = {i, squared};
    }
    const Neighbor nearest = grid.nearest(query, reach);
    EXPECT_FLOAT_EQ(nearest.squared_distance, truth.squared_distance);
    if (!std::isfinite(truth.squared_distance)) continue;
    EXPECT_EQ(nearest.index, truth.index);
    ++found;
  }
  EXPECT_GT(found, 1000);
}

TEST(PointGrid, OfEquallyNearPointsTheLowestIsTaken) {
  std::vector<Eigen::Vector3f> points{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, {-1, 0, 0}};
  for (int turn = 0; turn < 2; ++turn) {
    EXPECT_EQ(PointGrid(points, 0.3f).nearest({0, 0, 0}, 2).index, 2u);
    EXPECT_EQ(PointGrid(points, 5).nearest({0, 0, 0}, 2).index, 2u);
    std::swap(points[0], points[3]);
  }
}

TEST(PointGrid, APointAtTheLimitCountsAndNoneIsFoundBeyond) {
  const std::vector<Eigen::Vector3f> points{{2, 0, 0}};
  const PointGrid grid(points, 0.5f);
  EXPECT_EQ(grid.nearest({0, 0, 0}, 2).squared_distance, 4);
  EXPECT_FALSE(std::isfinite(grid.nearest({0, 0, 0}, 1.99f).squared_distance));
  EXPECT_FALSE(std::isfinite(PointGrid({}, 0.5f).nearest({0, 0, 0}, 2).squared_distance));
}

// Nothing tells how it came to be: the same points, the same answers.
TEST(PointGrid, PointsComeAndGo) {
  const std::vector<Eigen::Vector3f> points = random_points(2000, 2, 3);
  PointGrid grid(0.7f);
  Random random(6);
  std::vector<std::uint8_t> is_in(points.size(), 0);
  for (int step = 0; step < 20'000; ++step) {
    const auto i = static_cast<std::uint32_t>(random.below(points.size()));
    is_in[i] != 0 ? grid.erase(i, points[i]) : grid.insert(i, points[i]);
    is_in[i] ^= 1;
  }
  PointGrid anew(0.7f);
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (is_in[i] != 0) anew.insert(i, points[i]);
  }
  for (const Eigen::Vector3f& query : random_points(1000, 2.5, 7)) {
    const Neighbor a = grid.nearest(query, 1), b = anew.nearest(query, 1);
    ASSERT_EQ(a.squared_distance, b.squared_distance);
    ASSERT_EQ(a.index, b.index);
  }
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    if (is_in[i] != 0) grid.erase(i, points[i]);
  }
  EXPECT_FALSE(std::isfinite(grid.nearest({0, 0, 0}, 3).squared_distance));
  EXPECT_THROW(grid.erase(0, points[0]), std::logic_error);
}

TEST(PointIndex, GridAndTreeAgree) {
  const std::vector<Eigen::Vector3f> points = random_points(2000, 3, 4);
  const PointIndex grid(points, 0.2), tree(points);
  for (const Eigen::Vector3f& query : random_points(500, 4, 5)) {
    const Neighbor a = grid.nearest(query, 1), b = tree.nearest(query, 1);
    EXPECT_EQ(std::isfinite(a.squared_distance), std::isfinite(b.squared_distance));
    if (std::isfinite(a.squared_distance)) {
      EXPECT_EQ(a.index, b.index);
    }
  }
}

}  // namespace fovea::point_grid_test
