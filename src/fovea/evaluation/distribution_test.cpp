#include "fovea/evaluation/distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fovea::distribution_test {

TEST(Distribution, OfAFewValues) {
  const Distribution d = distribution({4, 1, 3, 2});
  EXPECT_EQ(d.count, 4u);
  EXPECT_EQ(d.mean, 2.5);
  EXPECT_EQ(d.rmse, std::sqrt(7.5));
  EXPECT_EQ(d.median, 2.5);
  EXPECT_EQ(d.p95, 4);
  EXPECT_EQ(d.max, 4);
  EXPECT_EQ(distribution({5}).p95, 5);
  EXPECT_EQ(distribution({1, 7, 3}).median, 3);
}

TEST(Distribution, TheHighestTwentiethIsBeyondP95) {
  std::vector<float> values;
  for (int i = 100; i >= 1; --i) values.push_back(float(i));
  EXPECT_EQ(distribution(values).p95, 95);
  values.push_back(101);
  EXPECT_EQ(distribution(values).p95, 96);  // 95.95 values: rounded up
}

TEST(Distribution, OfNothingIsNoNumber) {
  EXPECT_TRUE(std::isnan(distribution({}).mean));
  EXPECT_TRUE(std::isnan(distribution({}).p95));
  EXPECT_TRUE(std::isnan(share_within({}, 1)));
  EXPECT_EQ(share_within({1, 2, 3, 4}, 2), 0.5);
}

TEST(Histogram, BinsAreHalfOpen) {
  const float infinite = std::numeric_limits<float>::infinity();
  EXPECT_EQ(histogram({0, 3.9f, 4, 11, infinite}, 4), (std::vector<std::size_t>{2, 1, 1}));
  EXPECT_TRUE(histogram({}, 4).empty());
}

}  // namespace fovea::distribution_test
