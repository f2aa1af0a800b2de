#include "fovea/evaluation/rule_errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::rule_errors_test {

TEST(RuleErrors, AreThoseOfTheNearestPoints) {
  PointErrors errors;
  errors.position = {0.01f, 0.03f, 0.25f, 0.5f};
  errors.color = {4, 8, 16, 32};
  const std::vector<std::uint8_t> reason = {reason_of(PointRule::kMeasured),
                                            reason_of(PointRule::kPlanar) | kExposureMatched,
                                            reason_of(PointRule::kShortEdges), 15};
  ErrorsByRule by_rule = errors_by_rule(errors, {1, 1, 0, 3}, reason);
  const auto& planar = by_rule[reason_of(PointRule::kPlanar)];
  EXPECT_EQ(planar.points, 2u);
  EXPECT_NEAR(planar.mean(planar.position), 0.02, 1e-8);
  EXPECT_EQ(planar.mean(planar.color), 6);
  const auto& measured = by_rule[reason_of(PointRule::kMeasured)];
  EXPECT_EQ(measured.mean(measured.color), 16);
  EXPECT_TRUE(std::isnan(by_rule[reason_of(PointRule::kShortEdges)].mean(0)));

  append(by_rule, errors_by_rule(errors, {0, 0, 0, 0}, reason));
  EXPECT_EQ(by_rule[reason_of(PointRule::kMeasured)].points, 5u);
  EXPECT_EQ(by_rule[reason_of(PointRule::kMeasured)].color, 16 + 60);
  EXPECT_EQ(by_rule[reason_of(PointRule::kPlanar)].points, 2u);

  for (const RuleErrors& of_rule : errors_by_rule(errors, {0, 1, 2, 3}, {})) {
    EXPECT_EQ(of_rule.points, 0u);
  }
}

}  // namespace fovea::rule_errors_test
