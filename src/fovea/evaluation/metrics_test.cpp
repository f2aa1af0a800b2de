#include "fovea/evaluation/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace fovea::metrics_test {

using testing::ElementsAre;
using Colors = std::vector<Eigen::Vector3f>;

TEST(ColorError, IsEuclideanInRgb) {
  EXPECT_FLOAT_EQ(color_error({10, 20, 30}, {13, 24, 42}, false), 13);
  EXPECT_FLOAT_EQ(color_error({0, 0, 0}, {255, 255, 255}, false), 255 * std::sqrt(3.0f));
}

TEST(ColorError, OfGreyIsTheDifferenceOfIntensities) {
  EXPECT_NEAR(color_error({100, 100, 100}, {90, 90, 90}, true), 10, 1e-4);
  EXPECT_NEAR(color_error({100, 100, 100}, {200, 0, 0}, true), 100 - 0.299 * 200, 1e-4);
}

TEST(Gains, AreExactForAMapInAnotherExposure) {
  const Colors truth = {{100, 60, 20}, {40, 200, 80}, {10, 20, 250}};
  Colors map = truth;
  for (Eigen::Vector3f& c : map) c = c.cwiseProduct(Eigen::Vector3f(0.5f, 2.0f, 1.0f));
  EXPECT_TRUE(fit_gains(truth, map, false).isApprox(Eigen::Vector3f(2, 0.5f, 1), 1e-6f));
}

TEST(Gains, AreThoseOfLeastSquares) {
  // Minimum of (10 - g)^2 + (40 - 2 g)^2: g = (10 + 80) / 5.
  EXPECT_FLOAT_EQ(fit_gains({{10, 0, 0}, {40, 0, 0}}, {{1, 0, 0}, {2, 0, 0}}, false).x(), 18);
}

TEST(Gains, OfABlackMapAreOne) {
  EXPECT_EQ(fit_gains({{10, 20, 30}}, {{0, 0, 0}}, false), Eigen::Vector3f(1, 1, 1));
  EXPECT_EQ(fit_gains({}, {}, false), Eigen::Vector3f(1, 1, 1));
}

TEST(Gains, OfAGreyCameraIsOne) {
  const Eigen::Vector3f gains = fit_gains({{80, 80, 80}}, {{0, 0, 100}}, true);
  EXPECT_NEAR(gains.x(), 80 / 11.4, 1e-4);
  EXPECT_EQ(gains.x(), gains.z());
}

TEST(NearestSamples, GiveDistanceAndColorOfTheNearest) {
  const Colors points = {{0, 0, 0}, {1, 0, 0}};
  const std::vector<LogColor> colors = {{1, 2, 3}, {4, 5, 6}};
  const NearestSamples found = nearest_samples({{0.75f, 0, 0}, {-3, 4, 0}}, KdTree(points), colors);
  EXPECT_THAT(found.distance, ElementsAre(0.25f, 5.0f));
  EXPECT_EQ(found.color[0], Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(found.color[1], Eigen::Vector3f(1, 2, 3));
  EXPECT_TRUE(found.interpolated.empty());
  const std::vector<std::uint8_t> made = {0, 1};
  EXPECT_THAT(
      nearest_samples({{0.75f, 0, 0}, {-3, 4, 0}}, KdTree(points), colors, made).interpolated,
      ElementsAre(1, 0));
}

TEST(PointErrors, HoldRawAndGainErrors) {
  EvaluatedView view{0, 2, false, {{0, 0, 0}}, {{100, 100, 100}}, {{10, 10}}};
  const NearestSamples map{{0.5f}, {{50, 50, 50}}};
  const PointErrors errors = point_errors(view, map, Eigen::Vector3f::Constant(2));
  EXPECT_THAT(errors.position, ElementsAre(0.5f));
  EXPECT_FLOAT_EQ(errors.color[0], 50 * std::sqrt(3.0f));
  EXPECT_THAT(errors.color_gain, ElementsAre(0.0f));
  EXPECT_FLOAT_EQ(errors.color_cross[0], 50 * std::sqrt(3.0f));  // the other set is empty
  EXPECT_FLOAT_EQ(errors.log_cross[0], std::log(2.0f));
  EXPECT_FLOAT_EQ(errors.square_cross[0], 2500);
  EXPECT_NEAR(errors.ciede2000[0], 17.0, 0.1);  // L* 42.4 against 20.8, weighed by 1.27
}

TEST(PointErrors, OfMarkedPoints) {
  const PointErrors errors{{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}};
  const PointErrors marked = errors.select({0, 1, 1}, 1);
  EXPECT_THAT(marked.position, ElementsAre(2, 3));
  EXPECT_THAT(marked.ciede2000, ElementsAre(11, 12));
  EXPECT_TRUE(marked.interpolated.empty());
  EXPECT_THAT(errors.select({0, 1, 1}, 0).color, ElementsAre(4));
}

TEST(Summary, OfAHandfulOfPoints) {
  const PointErrors errors{{0.00f, 0.05f, 0.20f, 0.35f}, {0, 20, 40, 100}, {10, 20, 30, 40}};
  const ErrorFigures figures = summarize(errors);
  EXPECT_EQ(figures.points, 4u);
  EXPECT_NEAR(figures.me_mean, 0.15, 1e-7);
  EXPECT_NEAR(figures.me_std, std::sqrt((0.0225 + 0.01 + 0.0025 + 0.04) / 4), 1e-7);
  EXPECT_DOUBLE_EQ(figures.te_mean, 40);
  EXPECT_DOUBLE_EQ(figures.te_std, std::sqrt((1600 + 400 + 0 + 3600) / 4.0));
  EXPECT_DOUBLE_EQ(figures.te_median, 30);
  EXPECT_DOUBLE_EQ(figures.te_within_20, 0.5);
  EXPECT_DOUBLE_EQ(figures.te_percent, 4000 / 255.0);
  EXPECT_DOUBLE_EQ(figures.te_gain_mean, 25);
  EXPECT_DOUBLE_EQ(figures.te_gain_within_20, 0.5);
  EXPECT_NEAR(figures.mtme, (1.0 + 8.0 + 35.0) / 4, 1e-5);
  EXPECT_DOUBLE_EQ(figures.coverage_5cm, 0.5);
  EXPECT_DOUBLE_EQ(figures.coverage_20cm, 0.75);
}

TEST(Summary, OfCrossFittedColors) {
  PointErrors errors{{0, 0}, {0, 0}, {0, 0}};
  errors.color_cross = {10, 30};
  errors.log_cross = {0.1f, 0.3f};
  errors.square_cross = {25, 75};
  const ErrorFigures figures = summarize(errors);
  EXPECT_DOUBLE_EQ(figures.te_cross_mean, 20);
  EXPECT_DOUBLE_EQ(figures.te_cross_within_20, 0.5);
  EXPECT_NEAR(figures.log_cross_mean, 0.2, 1e-7);
  EXPECT_NEAR(figures.psnr_cross, 10 * std::log10(255.0 * 255 / 50), 1e-9);
}

TEST(Summary, MedianOfAnOddNumber) {
  EXPECT_DOUBLE_EQ(summarize({{0, 0, 0}, {9, 1, 5}, {0, 0, 0}}).te_median, 5);
}

TEST(Summary, OfNothingHasNoFigures) {
  const ErrorFigures figures = summarize({});
  EXPECT_EQ(figures.points, 0u);
  EXPECT_TRUE(std::isnan(figures.me_mean));
  EXPECT_TRUE(std::isnan(figures.coverage_20cm));
}

}  // namespace fovea::metrics_test
