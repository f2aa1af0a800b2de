#include "fovea/mapping/color_fusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fovea/core/random.h"

namespace fovea::color_fusion_test {

ColorSample sample(float red, float green, float blue, std::uint16_t weight) {
  return {Eigen::Array3f(red, green, blue), weight, 0};
}

FusedColor fuse_all(const std::vector<ColorSample>& views, std::uint64_t seed) {
  Random random(seed);
  FusedColor fused;
  for (const ColorSample& view : views) {
    fuse(view, static_cast<std::uint32_t>(random.next()), fused);
  }
  return fused;
}

/// Means over many points with the same views.
struct Average {
  Eigen::Array3d code = Eigen::Array3d::Zero();
  double spread = 0;     // codes
  double deviation = 0;  // of a point's codes from the average, RMS of channels
};

Average average(const std::vector<ColorSample>& views, int points) {
  Average result;
  std::vector<Eigen::Array3d> codes;
  for (int i = 0; i < points; ++i) {
    const FusedColor fused = fuse_all(views, std::uint64_t(i) * 977 + 5);
    codes.push_back(codes_of(fused.color).cast<double>());
    result.code += codes.back() / points;
    result.spread += double(fused.spread * kSpreadStep) / points;
  }
  for (const Eigen::Array3d& code : codes) {
    result.deviation += (code - result.code).square().sum() / (3.0 * points);
  }
  result.deviation = std::sqrt(result.deviation);
  return result;
}

std::vector<ColorSample> random_views(std::size_t count, double sigma, std::uint64_t seed) {
  Random random(seed);
  std::vector<ColorSample> views;
  for (std::size_t i = 0; i < count; ++i) {
    const auto code = [&](double mean) { return float(mean + sigma * random.normal()); };
    views.push_back(sample(code(2700.3), code(2811.8), code(2500.5),
                           static_cast<std::uint16_t>(80 + random.below(320))));
  }
  views[0].code = views[0].code.round();  // the first view is rounded to the nearest
  return views;
}

TEST(ColorFusion, TheFirstViewIsTheColor) {
  FusedColor fused;
  fuse({{2000.4f, 2900.6f, 5000.f}, 17, 4}, ~std::uint32_t{0}, fused);
  EXPECT_EQ(fused.color, LogColor::of_codes(2000, 2901, 4095));
  EXPECT_EQ(fused.views, 1);
  EXPECT_EQ(fused.spread, 0);
  EXPECT_EQ(fused.weight, 17);
  EXPECT_EQ(fused.saturated, 4);
}

TEST(ColorFusion, TwoViewsGiveTheWeightedMeanAndDeviation) {
  FusedColor fused;
  fuse(sample(2400, 2200, 2700, 10), 0, fused);
  fuse(sample(2440, 2200, 2660, 30), 0, fused);
  EXPECT_EQ(fused.color, LogColor::of_codes(2430, 2200, 2670));
  EXPECT_EQ(fused.views, 2);
  EXPECT_EQ(fused.weight, 40);
  // Channels deviate by 17.32, 0 and 17.32 codes: 14.14 together, 3.5 steps.
  EXPECT_EQ(fused.spread, 3);
}

TEST(ColorFusion, AChannelIsSaturatedIfItIsInAllViews) {
  FusedColor fused;
  fuse({{3000, 3000, 3000}, 1, 7}, 0, fused);
  fuse({{3000, 3000, 3000}, 1, 6}, 0, fused);
  EXPECT_EQ(fused.saturated, 6);
  fuse({{2900, 2900, 2900}, 200, 0}, 0, fused);
  fuse({{3000, 3000, 3000}, 1, 7}, 0, fused);
  EXPECT_EQ(fused.saturated, 0);
  EXPECT_LE(fused.color.code[0], 2902);  // saturated values count little
}

TEST(ColorFusion, TwoSetsOfViewsFuseIntoOne) {
  // Weight 40: mean square deviation of the channels 56^2; weight 60: 20^2.
  const FusedColor a{LogColor::of_codes(2430, 2200, 2670), 2, 14, 40, 3};
  const FusedColor b{LogColor::of_codes(2480, 2250, 2590), 3, 5, 60, 6};
  const FusedColor both = fused(a, b);
  EXPECT_EQ(both.color, LogColor::of_codes(2460, 2230, 2622));
  EXPECT_EQ(both.views, 5);
  EXPECT_EQ(both.weight, 100);
  EXPECT_EQ(both.saturated, 2);
  const double square = (2 * 50.0 * 50 + 80.0 * 80) / 3;
  EXPECT_NEAR(both.spread, std::sqrt(0.4 * 56 * 56 + 0.6 * 20 * 20 + 0.24 * square) / 4, 0.5);
  const FusedColor unseen;
  EXPECT_EQ(fused(a, unseen), a);
  EXPECT_EQ(fused(unseen, a), a);
  const FusedColor many{LogColor::of_codes(1, 2, 3), 250, 0, 65000, 0};
  EXPECT_EQ(fused(many, many).views, 255);
  EXPECT_EQ(fused(many, many).weight, 65535);
  EXPECT_EQ(fused(many, many).color, many.color);
}

// Steps of late views are below one code; rounding to the nearest would lose them.
TEST(ColorFusion, TheAverageOverPointsIsTheWeightedMean) {
  for (const std::size_t count : {2u, 5u, 20u, 200u}) {
    for (const double sigma : {8.0, 30.0}) {
      const std::vector<ColorSample> views = random_views(count, sigma, count);
      Eigen::Array3d mean = Eigen::Array3d::Zero();
      double weight = 0, squares = 0;
      for (const ColorSample& view : views) {
        mean += view.weight * view.code.cast<double>();
        weight += view.weight;
      }
      mean /= weight;
      for (const ColorSample& view : views) {
        squares += view.weight * (view.code.cast<double>() - mean).square().sum() / 3;
      }
      const Average fused = average(views, 20'000);
      EXPECT_LT((fused.code - mean).abs().maxCoeff(), 0.1) << count << " " << sigma;
      EXPECT_NEAR(fused.spread, std::sqrt(squares / weight), 0.05 * sigma + 1)
          << count << " " << sigma;
    }
  }
}

// The rounding of a step of |d| / n codes has at most that variance, and later views reduce its
// error in proportion. The total variance is |d| / 2 for any number of views.
TEST(ColorFusion, RoundingNoiseDoesNotGrowWithTheViews) {
  for (const std::size_t count : {5u, 30u, 250u}) {
    const double sigma = 8, mean_difference = sigma * std::sqrt(2 / 3.14159265);
    const Average fused = average(random_views(count, sigma, count), 5'000);
    EXPECT_GT(fused.deviation, 0.2) << count;
    EXPECT_LT(fused.deviation, std::sqrt(mean_difference / 2) + 0.3) << count;
  }
}

TEST(ColorFusion, LateChangesStillArrive) {
  std::vector<ColorSample> views(50, sample(2400, 2400, 2400, 100));
  views.resize(100, sample(2440, 2440, 2440, 100));
  const Average fused = average(views, 10'000);
  EXPECT_NEAR(fused.code.x(), 2420, 0.1);
  EXPECT_NEAR(fused.spread, 20, 1);
}

TEST(ColorFusion, OneColorStays) {
  const FusedColor fused = fuse_all(std::vector<ColorSample>(300, sample(1, 4095, 2900, 130)), 3);
  EXPECT_EQ(fused.color, LogColor::of_codes(1, 4095, 2900));
  EXPECT_EQ(fused.spread, 0);
  EXPECT_EQ(fused.views, 255);
  EXPECT_EQ(fused.weight, 300 * 130);
}

}  // namespace fovea::color_fusion_test
