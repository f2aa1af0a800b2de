#include "fovea/evaluation/color_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fovea::color_rules_test {

ColorObservation view(std::uint8_t grey, float distance = 5, bool visible = true, float time = 0) {
  return {{grey, grey, grey}, distance, 1, time, visible};
}

int grey(ColorRule rule, const std::vector<ColorObservation>& views, std::uint64_t point = 0) {
  ColorState state;
  for (const ColorObservation& seen : views) observe(state, seen, point);
  const std::optional<Rgb> color = color_by(rule, state);
  return color ? color->r : -1;
}

TEST(ColorRules, EachTakesItsView) {
  std::vector<ColorObservation> views = {view(10, 9, false), view(20, 8), view(30, 4), view(90, 6),
                                         view(50, 3, false)};
  views[3].cos_incidence = 1;     // 1 / 36
  views[2].cos_incidence = 0.4f;  // 0.4 / 16 = 1 / 40
  EXPECT_EQ(grey(ColorRule::kSingleView, views), 10);
  EXPECT_EQ(grey(ColorRule::kLast, views), 50);
  EXPECT_EQ(grey(ColorRule::kNearest, views), 30);
  EXPECT_EQ(grey(ColorRule::kBest, views), 90);
  EXPECT_EQ(grey(ColorRule::kMean, views), 47);  // 140 / 3
  EXPECT_EQ(grey(ColorRule::kMedian, views), 30);
}

TEST(ColorRules, OfEqualViewsTheFirst) {
  const std::vector<ColorObservation> views = {view(10), view(20)};
  EXPECT_EQ(grey(ColorRule::kNearest, views), 10);
  EXPECT_EQ(grey(ColorRule::kBest, views), 10);
}

TEST(ColorRules, HiddenPointsAreColouredOnlyWithoutATest) {
  const std::vector<ColorObservation> hidden = {view(10, 5, false)};
  for (const ColorRule rule : kColorRules) {
    if (rule == ColorRule::kFovea || rule == ColorRule::kFloor) continue;
    const bool blind = rule == ColorRule::kLast || rule == ColorRule::kSingleView;
    EXPECT_EQ(grey(rule, hidden), blind ? 10 : -1) << to_string(rule);
    EXPECT_EQ(grey(rule, {}), -1) << to_string(rule);
    EXPECT_EQ(grey(rule, {view(77)}), 77) << to_string(rule);
  }
}

TEST(ColorRules, TheMedianIsOfEachChannel) {
  ColorState state;
  for (const Rgb color : {Rgb{1, 200, 5}, Rgb{2, 100, 9}, Rgb{3, 50, 7}}) {
    observe(state, {color, 5, 1, 0, true}, 0);
  }
  EXPECT_EQ(color_by(ColorRule::kMedian, state), (Rgb{2, 100, 7}));
  EXPECT_EQ(grey(ColorRule::kMedian, {view(10), view(21)}), 16);  // 15.5
}

TEST(ColorRules, TheMedianOfManyViewsIsOfAFairSample) {
  // The second half of 60 views is white: of many points about half end white; were the sample the
  // first 15 views, none would, and were it the last, all.
  std::vector<ColorObservation> views;
  for (int i = 0; i < 60; ++i) views.push_back(view(i < 30 ? 0 : 255));
  int white = 0;
  for (std::uint64_t point = 0; point < 400; ++point) {
    white += grey(ColorRule::kMedian, views, point) == 255 ? 1 : 0;
  }
  EXPECT_NEAR(white, 200, 40);  // 4 sigma
  EXPECT_EQ(grey(ColorRule::kMedian, views, 7), grey(ColorRule::kMedian, views, 7));
}

TEST(ColorRules, BayesAtOneTimeIsTheMean) {
  EXPECT_EQ(grey(ColorRule::kBayes, {view(10), view(40), view(100)}), 50);
}

TEST(ColorRules, BayesForgetsWithTime) {
  // One second: prior variance 225 + 25, gain 250 / 475.
  EXPECT_EQ(grey(ColorRule::kBayes, {view(0), view(190, 5, true, 1)}), 100);
  // Another after nine: variance 225 * 250 / 475 + 225, gain 343.4 / 568.4.
  EXPECT_EQ(grey(ColorRule::kBayes, {view(0), view(190, 5, true, 1), view(200, 5, true, 10)}), 160);
  // After a very long time only the last view counts.
  EXPECT_EQ(grey(ColorRule::kBayes, {view(0), view(200, 5, true, 1e6f)}), 200);
}

TEST(ColorRules, AStateIsSmall) { EXPECT_LE(sizeof(ColorState), 128u); }

}  // namespace fovea::color_rules_test
