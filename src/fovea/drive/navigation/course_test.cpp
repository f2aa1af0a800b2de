#include "fovea/drive/navigation/course.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fovea::course_test {

TEST(Course, IsTheDirectionOfTheWay) {
  // Round a circle of 20 m at 8 m/s, ten places a second: the chord before and behind has the
  // tangent's direction.
  std::vector<TimeNs> times;
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.04 * i;
    times.push_back(i * kNsPerSecond / 10);
    places.emplace_back(20 * std::cos(angle), 20 * std::sin(angle), 0.3 * i);
  }
  const auto headings = course_headings(times, places);
  ASSERT_TRUE(headings);
  for (int i = 1; i < 39; ++i) {
    EXPECT_NEAR(std::remainder((*headings)[std::size_t(i)] - 0.04 * i - std::numbers::pi / 2,
                               2 * std::numbers::pi),
                0, 1e-9);
  }
  EXPECT_NEAR(headings->front(), std::numbers::pi / 2 + 0.04, 0.03);  // the first chords ahead
}

TEST(Course, StaysWhileTheVehicleStands) {
  std::vector<TimeNs> times;
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i < 60; ++i) {  // stands 3 s, drives west, stands again
    times.push_back(i * kNsPerSecond / 10);
    places.emplace_back(-0.8 * std::clamp(i - 30, 0, 10), 0.01 * (i % 2), 0);
  }
  const auto headings = course_headings(times, places);
  ASSERT_TRUE(headings);
  for (const double heading : *headings) {
    EXPECT_NEAR(std::abs(heading), std::numbers::pi, 0.02);
  }
}

TEST(Course, IsUnknownIfTheVehicleNeverMoves) {
  EXPECT_FALSE(course_headings({0, 1, 2}, {{0, 0, 0}, {0.1, 0, 5}, {0, 0.1, 9}}));
  EXPECT_FALSE(course_headings({0}, {{0, 0, 0}}));
  EXPECT_FALSE(course_headings({}, {}));
  // A metre, but in an hour.
  EXPECT_FALSE(course_headings({0, 3600 * kNsPerSecond}, {{0, 0, 0}, {1.5, 0, 0}}));
}

TEST(Course, KeepsTheHeadingFromBeforeUntilTheVehicleMoves) {
  const std::vector<TimeNs> times{0, 3 * kNsPerSecond, 4 * kNsPerSecond, 5 * kNsPerSecond};
  const auto headings =
      course_headings(times, {{0, 0, 0}, {0, 0, 0}, {2, 0, 0}, {4, 0, 0}}, /*before=*/1.5);
  ASSERT_TRUE(headings);
  EXPECT_EQ(headings->front(), 1.5);
  EXPECT_EQ(headings->back(), 0);
  EXPECT_EQ(course_headings({0}, {{0, 0, 0}}, /*before=*/1.5), std::vector<double>{1.5});
}

}  // namespace fovea::course_test
