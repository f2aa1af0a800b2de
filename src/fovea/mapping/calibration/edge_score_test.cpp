#include "fovea/mapping/calibration/edge_score.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::edge_score_test {

/// An edge whose image is at `place` pixels, a pixel wide.
EdgeProfile profile_at(double place, float half_gap) {
  EdgeProfile profile;
  for (int k = 0; k < EdgeProfile::kSize; ++k) {
    const double away = k - EdgeProfile::kReach - place;
    profile.strength[std::size_t(k)] = static_cast<float>(0.3 * std::exp(-away * away / 2));
  }
  profile.half_gap = half_gap;
  profile.J_along << 700, -300, 50, 30, 40, -10, 120, 1, 0.5f;
  return profile;
}

CalibrationVector small_correction() {
  return (CalibrationVector() << 1.2, -0.7, 0.3, 0.4, -0.2, 0.1, 0.5, 0.8, -0.4).finished();
}

TEST(EdgeScore, GradientAndCurvatureAreTheDerivatives) {
  const EdgeProfile profile = profile_at(3, 1.5f);
  constexpr double kSmall = 1e-4;
  for (const double width : {4.0, 1.0}) {
    const CalibrationVector x = small_correction();
    const EdgeScore score = edge_score(profile, x, width);
    for (int k = 0; k < 9; ++k) {
      const CalibrationVector step = kSmall * CalibrationVector::Unit(k);
      const EdgeScore up = edge_score(profile, x + step, width);
      const EdgeScore down = edge_score(profile, x - step, width);
      EXPECT_NEAR((up.value - down.value) / (2 * kSmall), score.gradient[k], 1e-5) << k;
      const CalibrationVector slope = (up.gradient - down.gradient) / (2 * kSmall);
      EXPECT_LT((slope + score.curvature.col(k)).norm(), 1e-4) << k;
    }
  }
}

TEST(EdgeScore, IsHighestAtTheImagesEdge) {
  const EdgeProfile profile = profile_at(4, 0.5f);
  const double unit = profile.J_along[0] * calibration_unit()[0];
  const auto value = [&](double pixels) {
    return edge_score(profile, pixels / unit * CalibrationVector::Unit(0), 1).value;
  };
  EXPECT_GT(value(4), value(3.5));
  EXPECT_GT(value(4), value(4.5));
  EXPECT_GT(value(3.5), value(0));
}

// Its maximum is a step that never leads down: value(x + d) >= value(x) + g d - d B d / 2.
TEST(EdgeScore, BoundLiesBelow) {
  const EdgeProfile profile = profile_at(-2, 1.0f);
  // A wide Gaussian, so that its ends do not matter.
  constexpr double kWidth = 8;
  const CalibrationVector x = small_correction();
  const EdgeScore at = edge_score(profile, x, kWidth);
  for (double way = -4; way <= 4; way += 0.25) {
    const CalibrationVector step = way * CalibrationVector::Unit(1);
    const double below = at.value + at.gradient.dot(step) - 0.5 * step.dot(at.bound * step);
    EXPECT_GE(edge_score(profile, x + step, kWidth).value, below - 1e-9) << way;
  }
}

TEST(EdgeScore, OfSeveralIsTheSum) {
  const std::vector<EdgeProfile> profiles{profile_at(1, 1), profile_at(-3, 2), profile_at(0, 0)};
  EdgeScore sum;
  for (const EdgeProfile& p : profiles) sum += edge_score(p, small_correction(), 2);
  const EdgeScore all = edge_score(profiles, small_correction(), 2);
  EXPECT_NEAR(all.value, sum.value, 1e-12);
  EXPECT_LT((all.gradient - sum.gradient).norm(), 1e-12);
}

}  // namespace fovea::edge_score_test
