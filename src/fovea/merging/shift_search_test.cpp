#include "fovea/merging/shift_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fovea/core/parallel.h"
#include "fovea/core/random.h"

namespace fovea::shift_search_test {

using Points = std::vector<Eigen::Vector3f>;

/// Adds points of a vertical wall of 3 m height, every 0.2 m.
void add_wall(const Eigen::Vector2d& begin, double direction, double length, Points& points) {
  const Eigen::Vector2d along(std::cos(direction), std::sin(direction));
  for (double s = 0; s < length; s += 0.2) {
    const Eigen::Vector2d p = begin + s * along;
    for (double z = 0; z < 3; z += 0.2) {
      points.emplace_back(float(p.x()), float(p.y()), float(z));
    }
  }
}

/// Walls of houses in all directions within 60 m.
Points walls(std::uint64_t seed = 1, int count = 40) {
  Random random(seed);
  Points points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d begin(random.uniform(-60, 60), random.uniform(-60, 60));
    const double direction = random.uniform(0, 2 * std::numbers::pi);
    add_wall(begin, direction, random.uniform(5, 15), points);
  }
  return points;
}

/// Level ground within 60 m.
Points ground() {
  Points points;
  for (double x = -60; x < 60; x += 0.5) {
    for (double y = -60; y < 60; y += 0.5) points.emplace_back(float(x), float(y), 0.05F);
  }
  return points;
}

Points moved(Points points, const Eigen::Vector2d& shift) {
  const Eigen::Vector3f step(float(shift.x()), float(shift.y()), 0);
  for (Eigen::Vector3f& p : points) p += step;
  return points;
}

TEST(ShiftSearch, FindsThePlantedShift) {
  const Points a = walls();
  for (const Eigen::Vector2d& shift :
       {Eigen::Vector2d(0, 0), Eigen::Vector2d(3.3, -7.1), Eigen::Vector2d(-12.4, -0.8),
        Eigen::Vector2d(24.9, 24.9), Eigen::Vector2d(-24.9, 24.9), Eigen::Vector2d(-24.9, -24.9),
        Eigen::Vector2d(17.25, 0.25)}) {
    const auto shifts = likely_shifts(a, moved(a, -shift), 5);
    ASSERT_FALSE(shifts.empty());
    EXPECT_LT((shifts.front() - shift).norm(), 0.5) << shift.transpose();
  }
}

TEST(ShiftSearch, FindsTheShiftOfMapsThatHaveHalfTheirWallsInCommon) {
  Points a = walls(1), b = walls(1);
  const Points only_a = walls(2), only_b = walls(3);
  a.insert(a.end(), only_a.begin(), only_a.end());
  b.insert(b.end(), only_b.begin(), only_b.end());
  const Points flat = ground();
  a.insert(a.end(), flat.begin(), flat.end());
  b.insert(b.end(), flat.begin(), flat.end());
  const Eigen::Vector2d shift(-8.6, 15.2);
  const auto shifts = likely_shifts(a, moved(b, -shift), 5);
  ASSERT_FALSE(shifts.empty());
  EXPECT_LT((shifts.front() - shift).norm(), 0.5);
}

// Across a wall the shift is known, along it every shift fits.
TEST(ShiftSearch, ALongWallFixesTheShiftAcrossIt) {
  Points a, b;
  add_wall({-80, 0.2}, 0, 160, a);
  add_wall({-20, 6.2}, 0, 40, b);
  const auto shifts = likely_shifts(a, b, 10);
  ASSERT_EQ(shifts.size(), 10u);
  for (const Eigen::Vector2d& shift : shifts) EXPECT_NEAR(shift.y(), -6, 0.5);
}

TEST(ShiftSearch, FindsNothingWithoutWalls) {
  EXPECT_TRUE(likely_shifts({}, {}, 5).empty());
  EXPECT_TRUE(likely_shifts(walls(), {}, 5).empty());
  EXPECT_TRUE(likely_shifts({}, walls(), 5).empty());
  EXPECT_TRUE(likely_shifts(ground(), ground(), 5).empty());
  EXPECT_TRUE(likely_shifts(walls(), ground(), 5).empty());
  // A post says nothing.
  Points post;
  add_wall({3, 3}, 0, 0.3, post);
  EXPECT_TRUE(likely_shifts(walls(), post, 5).empty());
}

TEST(ShiftSearch, CandidatesAreApartAndWithinReach) {
  const Points a = walls(), b = moved(a, Eigen::Vector2d(4, 4));
  for (const std::size_t most : {0u, 1u, 3u, 20u}) {
    const auto shifts = likely_shifts(a, b, most);
    EXPECT_EQ(shifts.size(), most);
    for (std::size_t i = 0; i < shifts.size(); ++i) {
      EXPECT_LE(shifts[i].cwiseAbs().maxCoeff(), kShiftReach);
      for (std::size_t j = 0; j < i; ++j) EXPECT_GE((shifts[i] - shifts[j]).norm(), 2);
    }
  }
}

TEST(ShiftSearch, FewerCandidatesAreTheBestOfMore) {
  const Points a = walls(), b = moved(walls(5), Eigen::Vector2d(4, 4));
  const auto many = likely_shifts(a, b, 20), few = likely_shifts(a, b, 5);
  EXPECT_EQ(few, std::vector<Eigen::Vector2d>(many.begin(), many.begin() + 5));
}

TEST(ShiftSearch, TheNumberOfThreadsDoesNotMatter) {
  const Points a = walls(1), b = moved(walls(4), Eigen::Vector2d(2.2, -9.1));
  std::vector<std::vector<Eigen::Vector2d>> results;
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    results.push_back(likely_shifts(a, b, 20));
  }
  EXPECT_EQ(results[0].size(), 20u);
  EXPECT_EQ(results[0], results[1]);
}

}  // namespace fovea::shift_search_test
