#include "fovea/sweep_motion.h"

#include <gtest/gtest.h>

namespace fovea::sweep_motion_test {

/// Turns about z by 2 rad/s and moves along x by 3 m/s.
SweepPath path() {
  SweepPath path{-0.05, 0.01, {}};
  for (int i = 0; i <= 10; ++i) {
    const double dt = -0.05 + 0.01 * i;
    path.placements.emplace_back() << 0, 0, 2 * dt, 3 * dt, 0, 0;
  }
  return path;
}

TEST(SweepPath, InterpolatesAndGoesOnBeyondItsEnds) {
  for (const double dt : {-0.07, -0.05, -0.013, 0.0, 0.049, 0.06}) {
    const RigidMotion T = path().at(dt);
    EXPECT_NEAR(T.translation().x(), 3 * dt, 1e-12) << dt;
    EXPECT_NEAR(std::atan2(T.linear()(1, 0), T.linear()(0, 0)), 2 * dt, 1e-12) << dt;
  }
}

TEST(SweepMotion, APathReplacesVelocityAndAcceleration) {
  SweepMotion motion;
  motion.velocity << 0, 0, 0.5, 1, 0, 0;
  motion.acceleration << 0, 0, 0, 2, 0, 0;
  const RigidMotion by_velocity = motion.T_later_moment(0.04);
  EXPECT_TRUE(by_velocity.isApprox(exp_se3(motion.over(0.04)).inverse(), 1e-12));
  motion.path = path();
  EXPECT_TRUE(motion.T_later_moment(0.04).isApprox(path().at(0.04).inverse(), 1e-12));
}

}  // namespace fovea::sweep_motion_test
