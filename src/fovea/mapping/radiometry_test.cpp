#include "fovea/mapping/radiometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/random.h"

namespace fovea::radiometry_test {

/// Differences of an image with a gain, in codes: noise of 10 %.
CodeDifferences differences(const LogGain& gain, int count, std::uint64_t seed) {
  Random random(seed);
  CodeDifferences all;
  for (int i = 0; i < count; ++i) {
    all.add(gain * 256 +
            Eigen::Array3f(float(random.normal()), float(random.normal()), float(random.normal())) *
                36);
  }
  return all;
}

TEST(Gain, IsThatOfTheImage) {
  const LogGain truth(-2, 0.1f, 0.3f);
  const LogGain gain = *gain_of(differences(truth, 5000, 1));
  EXPECT_LT((gain - truth).abs().maxCoeff(), 0.006);  // 0.4 %, 2.5 standard deviations
}

TEST(Gain, IsThatOfTheLargerPart) {
  CodeDifferences all = differences(LogGain::Constant(0.5f), 3000, 2);
  all.append(differences(LogGain::Constant(-0.7f), 1400, 3));  // a shadow has moved
  EXPECT_LT((*gain_of(all) - 0.5f).abs().maxCoeff(), 0.02);
}

TEST(Gain, OfTooFewPointsIsUnknown) {
  EXPECT_FALSE(gain_of(differences(LogGain::Zero(), 149, 4)));
  EXPECT_TRUE(gain_of(differences(LogGain::Zero(), 150, 4)));
}

TEST(ResidualPercent, IsTheMeanAbsoluteDifferenceAfterTheGain) {
  CodeDifferences all;
  for (int i = 0; i < 10; ++i) all.add(Eigen::Array3f::Constant(256 + (i % 2 == 0 ? 36 : -36)));
  EXPECT_NEAR(residual_percent(all, LogGain::Constant(1)), 100 * (std::exp2(36.0 / 256) - 1), 1e-3);
  EXPECT_EQ(residual_percent({}, LogGain::Zero()), 0);
}

TEST(Mode, OfTwoPeaksIsTheHigherOne) {
  EXPECT_NEAR(mode_of({0, 1, 2, 3, 500, 501, 502, 503, 504}, 12).value, 502, 0.4);  // half a bin
  EXPECT_FLOAT_EQ(mode_of({7}, 12).value, 7);
}

}  // namespace fovea::radiometry_test
