#include "fovea/pipeline/initial_motion.h"

#include <gtest/gtest.h>

#include "../../../tests/raw_drive.h"

namespace fovea::initial_motion_test {

Twist twist(double turn, double forward) {
  return (Twist() << 0, 0, turn, forward, 0, 0).finished();
}

void expect_near(const std::optional<Twist>& velocity, const Twist& truth) {
  ASSERT_TRUE(velocity);
  EXPECT_LT((*velocity - truth).head<3>().norm(), 0.005) << velocity->transpose();
  EXPECT_LT((*velocity - truth).tail<3>().norm(), 0.1) << velocity->transpose();
}

TEST(InitialVelocity, IsFoundAtAnySpeed) {
  for (const double forward : {-5.0, 0.0, 8.0, 17.0, 30.0, 40.0}) {
    for (const double turn : {0.0, 0.2}) {
      RawDrive drive(2, twist(turn, forward));
      expect_near(initial_velocity(drive, {}, 0, true), twist(turn, forward));
      drive.editable_info().sweep_compensated = true;
      expect_near(initial_velocity(drive, {}, 0, true), twist(turn, forward));
    }
  }
}

TEST(InitialVelocity, IsLeftToNavigation) {
  RawDrive drive(4, twist(0, 10));
  std::vector<StampedPose> poses;
  for (int i = 0; i < 4; ++i) {
    poses.push_back({SyntheticDrive::stamp_of(i), drive.T_local_lidar[std::size_t(i)]});
  }
  drive.editable_info().navigation.emplace(poses);
  EXPECT_FALSE(initial_velocity(drive, {}, 0, true));
}

TEST(InitialVelocity, IsThatOfThePosesGiven) {
  const RawDrive drive(3, twist(0, 10));
  const std::vector<RigidMotion> poses{exp_se3(0.0 * twist(0.1, 7)), exp_se3(0.1 * twist(0.1, 7))};
  const auto velocity = initial_velocity(drive, poses, 0, true);
  ASSERT_TRUE(velocity);
  EXPECT_TRUE(velocity->isApprox(twist(0.1, 7), 1e-9));
  expect_near(initial_velocity(drive, {poses[0]}, 0, true), twist(0, 10));  // one pose is no motion
}

TEST(InitialVelocity, IsOfTheFirstTwoUsableFrames) {
  RawDrive drive(13, twist(0, 10));
  drive.dropped = {0, 2};
  expect_near(initial_velocity(drive, {}, 0, true), twist(0, 10));  // frames 1 and 3
  EXPECT_FALSE(initial_velocity(drive, {}, 12, true));              // the last of all
  drive.dropped = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
  EXPECT_FALSE(initial_velocity(drive, {}, 0, true));  // 1.1 s
}

TEST(InitialVelocity, IsUnknownIfScansDoNotFit) {
  RawDrive drive(2, twist(0, 10));
  drive.scene.boxes = {{{500, 500, 0}, {501, 501, 1}}};  // out of reach
  EXPECT_FALSE(initial_velocity(drive, {}, 0, true));
}

}  // namespace fovea::initial_motion_test
