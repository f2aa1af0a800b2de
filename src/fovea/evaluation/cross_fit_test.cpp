#include "fovea/evaluation/cross_fit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::cross_fit_test {

using Colors = std::vector<Eigen::Vector3f>;

/// A row of blocks, one point in each.
EvaluatedView view_of(const Colors& truth) {
  EvaluatedView view;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    view.color.push_back(truth[i]);
    view.pixel.emplace_back((double(i) + 0.5) * kCrossFitBlock, 10);
  }
  return view;
}

TEST(CrossFit, AGainOfTheWholeViewLeavesNoError) {
  const Colors truth = {{100, 60, 20}, {40, 200, 80}, {10, 20, 200}, {70, 30, 50}};
  Colors map = truth;
  for (Eigen::Vector3f& c : map) c = c.cwiseProduct(Eigen::Vector3f(0.5f, 2.0f, 4.0f));
  const Colors fitted = cross_fitted(view_of(truth), map);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_TRUE(fitted[i].isApprox(truth[i], 1e-5f)) << i;
  }
}

TEST(CrossFit, APointIsNotFittedToItself) {
  // The blocks 0 and 2 have a gain of 2, the blocks 1 and 3 one of 3.
  const Colors map(4, {10, 10, 10});
  const Colors fitted =
      cross_fitted(view_of({{20, 20, 20}, {30, 30, 30}, {20, 20, 20}, {30, 30, 30}}), map);
  EXPECT_FLOAT_EQ(fitted[0].x(), 30);
  EXPECT_FLOAT_EQ(fitted[1].x(), 20);
}

TEST(CrossFit, TheBlocksAreAChessboard) {
  EvaluatedView view = view_of({{20, 20, 20}, {30, 30, 30}});
  view.pixel = {{10, 10}, {10, kCrossFitBlock + 1}};
  EXPECT_FLOAT_EQ(cross_fitted(view, Colors(2, {10, 10, 10}))[0].y(), 30);
  view.pixel[1] = {kCrossFitBlock + 1, kCrossFitBlock + 1};  // of the same set: nothing is fitted
  EXPECT_FLOAT_EQ(cross_fitted(view, Colors(2, {10, 10, 10}))[0].y(), 10);
}

TEST(CrossFit, SaturatedValuesFitNoGainAndTheResultIsClipped) {
  const Colors fitted = cross_fitted(view_of({{255, 255, 255}, {255, 50, 50}, {50, 50, 50}}),
                                     {{100, 100, 100}, {100, 100, 100}, {100, 100, 100}});
  EXPECT_FLOAT_EQ(fitted[0].x(), 100);  // the other set has no unsaturated red
  EXPECT_FLOAT_EQ(fitted[0].y(), 50);
  EXPECT_FLOAT_EQ(fitted[1].x(), 50);
  EXPECT_FLOAT_EQ(
      cross_fitted(view_of({{100, 100, 100}, {200, 200, 200}}), {{200, 200, 200}, {50, 50, 50}})[0]
          .x(),
      255);
}

TEST(CrossFit, OfAGrayCameraTheLumaIsFitted) {
  EvaluatedView view = view_of({{80, 80, 80}, {80, 80, 80}});
  view.grey = true;
  EXPECT_NEAR(cross_fitted(view, Colors(2, {0, 0, 100}))[0].x(), 80, 1e-3);
}

TEST(LogColorError, DoesNotGrowWithBrightness) {
  const float error = log_color_error({20, 30, 40}, {22, 33, 44}, false);
  EXPECT_NEAR(error, std::log(1.1f), 1e-6);
  EXPECT_NEAR(log_color_error({200, 120, 80}, {220, 132, 88}, false), error, 1e-6);
  EXPECT_FLOAT_EQ(log_color_error({0, 3, 8}, {8, 0, 5}, false), 0);  // noise
}

}  // namespace fovea::cross_fit_test
