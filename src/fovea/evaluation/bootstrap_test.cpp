#include "fovea/evaluation/bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/random.h"

namespace fovea::bootstrap_test {

TEST(Bootstrap, SumsOfAFrame) {
  const FrameSums sums = frame_sums({{0.5f, 1.5f}, {10, 20}, {0, 0}});
  EXPECT_EQ(sums.points, 2u);
  EXPECT_DOUBLE_EQ(sums.me, 2);
  EXPECT_DOUBLE_EQ(sums.te, 30);
  EXPECT_DOUBLE_EQ(sums.mtme, 35);
}

TEST(Bootstrap, OneFrameHasNoInterval) {
  EXPECT_TRUE(std::isnan(bootstrap_means({{5, 1, 1, 1}, {}}).me.low));
}

TEST(Bootstrap, EqualFramesLeaveNoDoubt) {
  const MeanIntervals found = bootstrap_means({{10, 5, 100, 7}, {20, 10, 200, 14}});
  EXPECT_NEAR(found.me.low, 0.5, 1e-12);
  EXPECT_NEAR(found.me.high, 0.5, 1e-12);
  EXPECT_NEAR(found.te.high, 10, 1e-12);
  EXPECT_NEAR(found.mtme.low, 0.7, 1e-12);
}

TEST(Bootstrap, IsAsWideAsTheNormalInterval) {
  // 400 frames of a hundred points, means normal about 3 with deviation 1: 1.96 / sqrt(400).
  std::vector<FrameSums> frames;
  Random random(5);
  double sum = 0;
  for (int i = 0; i < 400; ++i) {
    const double mean = 3 + random.normal();
    sum += mean;
    frames.push_back({100, 100 * mean, 0, 0});
  }
  const MeanIntervals found = bootstrap_means(frames);
  EXPECT_NEAR(found.me.low, sum / 400 - 0.098, 0.015);
  EXPECT_NEAR(found.me.high, sum / 400 + 0.098, 0.015);
}

}  // namespace fovea::bootstrap_test
