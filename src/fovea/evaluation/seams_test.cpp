#include "fovea/evaluation/seams.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::seams_test {

/// A wall of two views that take turns, point by point. The colors of the second one are brighter.
PointCloud wall(int first_frame, int second_frame, int codes) {
  PointCloud points;
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const bool second = (x + y) % 2 == 1;
      const auto texture = static_cast<std::uint16_t>(2500 + (x / 3 * 37 + y / 3 * 53) % 300);
      const auto code = static_cast<std::uint16_t>(texture + (second ? codes : 0));
      points.position.emplace_back(0.01f * float(x) + 0.002f, 0.01f * float(y) + 0.002f, 0.0f);
      points.color.push_back(LogColor::of_codes(code, code, code));
      points.frame.push_back(second ? second_frame : first_frame);
      points.camera.push_back(2);
    }
  }
  return points;
}

TEST(Seams, AreTheStepsBetweenViews) {
  const SeamFigures seams = find_seams(wall(1, 2, 20));
  EXPECT_EQ(seams.pairs, 1u);
  EXPECT_NEAR(seams.p95_percent, 100 * (std::exp2(20.0 / 256) - 1), 0.3);
  EXPECT_NEAR(find_seams(wall(1, 2, 0)).p95_percent, 0, 0.3);
}

TEST(Seams, NeedTwoViews) {
  const SeamFigures seams = find_seams(wall(1, 1, 20));
  EXPECT_EQ(seams.pairs, 0u);
  EXPECT_TRUE(std::isnan(seams.p95_percent));
}

}  // namespace fovea::seams_test
