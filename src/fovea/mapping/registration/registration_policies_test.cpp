// The benefit of each policy: registration with it against registration without it.
#include "fovea/mapping/registration/registration_policies.h"

#include <gtest/gtest.h>

#include <numbers>

#include "fovea/mapping/registration/registration.h"
#include "fovea/mapping/registration/test_scenes.h"

namespace fovea::registration_policies_test {

using test::motion;

const RigidMotion kTruth = motion(0.01, -0.02, 0.04, 0.3, -0.2, 0.05);

class PolicyBenefit : public testing::Test {
 protected:
  PolicyBenefit() {
    options_.method = RegistrationMethod::kPointToPlane;
    options_.robust_width = 0.1;
  }

  RegistrationResult align(const RegistrationPolicies& policies, const RigidMotion& guess) const {
    RegistrationOptions options = options_;
    options.policies = policies;
    return register_clouds(target_, index_, source_, guess, options);
  }
  static double error(const RegistrationResult& result) {
    return log_se3(kTruth.inverse() * result.T_target_source).tail<3>().norm();
  }

  RegistrationOptions options_;
  RegistrationCloud target_ =
      prepare_cloud(test::sample(test::room_corner(), 40, 1, 0.01), RegistrationOptions());
  PointIndex index_ = PointIndex(target_.points);
  RegistrationCloud source_ = select_points(
      test::transformed(kTruth.inverse(), test::sample(test::room_corner(), 40, 2, 0.01)), 0);
};

TEST_F(PolicyBenefit, NarrowingKernelFindsThePoseFromFurtherAway) {
  options_.max_distance = 4;
  const auto found = [&](bool narrowing_kernel) {
    RegistrationPolicies policies;
    policies.narrowing_kernel = narrowing_kernel;
    int count = 0;
    for (int k = 0; k < 16; ++k) {
      const double angle = k * std::numbers::pi / 8;
      const RigidMotion guess =
          kTruth * motion(0, 0, 0, 1.5 * std::cos(angle), 1.5 * std::sin(angle), 0);
      const RegistrationResult result = align(policies, guess);
      count += result.converged && error(result) < 0.02 ? 1 : 0;
    }
    return count;
  };
  EXPECT_EQ(found(true), 16);
  EXPECT_LE(found(false), 12);
}

TEST_F(PolicyBenefit, CoarsePhaseFindsThePoseWithFewerSearches) {
  const RegistrationResult with = align({}, RigidMotion::Identity());
  const RegistrationResult without = align({.coarse_phase = false}, RigidMotion::Identity());
  EXPECT_TRUE(with.converged);
  EXPECT_LT(double(with.searches), 0.6 * double(without.searches));
  EXPECT_LT(error(with), error(without) + 0.001);
}

TEST_F(PolicyBenefit, PairCacheFindsThePoseWithFewerSearches) {
  const RegistrationResult with = align({}, RigidMotion::Identity());
  const RegistrationResult without = align({.pair_cache = false}, RigidMotion::Identity());
  EXPECT_TRUE(with.converged);
  EXPECT_LT(double(with.searches), 0.8 * double(without.searches));
  EXPECT_LT(error(with), error(without) + 0.001);
}

TEST(NarrowingKernel, HalvesItsWidthDownToTheFinalOne) {
  const NarrowingKernel kernel(true, 1, 0.2);
  EXPECT_EQ(kernel.width(0), 1);
  EXPECT_EQ(kernel.width(2), 0.25);
  EXPECT_FALSE(kernel.is_final(2));
  EXPECT_EQ(kernel.width(3), 0.2);
  EXPECT_TRUE(kernel.is_final(3));
  EXPECT_EQ(NarrowingKernel(true, 1, 0).width(0), 0);  // off
  EXPECT_TRUE(NarrowingKernel(false, 1, 0.2).is_final(0));
}

TEST(CoarsePhase, EndsWhenThePoseIsNearlyFoundOrAfterManyRounds) {
  const StepLimit limit{1e-4, 1e-3};
  const Twist large = Twist::Constant(0.1), small = Twist::Constant(5e-4);
  CoarsePhase phase(true, 10000);
  EXPECT_EQ(phase.points(), 2000u);
  EXPECT_FALSE(phase.end_if_due(large, 1, limit));
  EXPECT_TRUE(phase.end_if_due(small, 2, limit));
  EXPECT_EQ(phase.points(), 10000u);
  EXPECT_FALSE(phase.end_if_due(small, 3, limit));
  EXPECT_TRUE(CoarsePhase(true, 10000).end_if_due(large, 30, limit));
  EXPECT_FALSE(CoarsePhase(true, 1999).is_active());
}

/// Rounds of an iteration whose plain steps reduce the error by a constant ratio.
int rounds_to_converge(bool accelerated, double ratio) {
  const StepLimit limit{1e-4, 1e-3};
  AitkenAcceleration acceleration(accelerated, limit);
  double error = 4;  // m
  for (int round = 1; round < 1000; ++round) {
    Twist step = Twist::Zero();
    step[3] = (1 - ratio) * error;
    if (limit.contains(step)) return round;
    error -= acceleration.factor(step) * step[3];
  }
  return 1000;
}

TEST(AitkenAcceleration, ShortensSlowConvergence) {
  EXPECT_LT(rounds_to_converge(true, 0.9), rounds_to_converge(false, 0.9) / 2);
  EXPECT_LE(rounds_to_converge(true, 0.3), rounds_to_converge(false, 0.3));
}

TEST(AitkenAcceleration, LengthensOnlyLargeStepsInOneDirection) {
  AitkenAcceleration acceleration(true, {1e-4, 1e-3});
  const auto factor = [&](double x, double y) {
    Twist step = Twist::Zero();
    step.tail<3>() << x, y, 0;
    return acceleration.factor(step);
  };
  EXPECT_EQ(factor(0.04, 0), 1);  // the first step
  EXPECT_NEAR(factor(0.02, 0), 2, 1e-9);
  EXPECT_EQ(factor(0, 0.02), 1);     // another direction
  EXPECT_EQ(factor(0, 0.03), 4);     // the largest factor
  EXPECT_EQ(factor(0, -0.03), 1);    // a reversal ...
  EXPECT_EQ(factor(0, -0.04), 3);    // ... reduces the largest factor
  EXPECT_EQ(factor(0, -0.0039), 1);  // nearly converged
}

}  // namespace fovea::registration_policies_test
