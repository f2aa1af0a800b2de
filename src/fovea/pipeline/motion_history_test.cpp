#include "fovea/pipeline/motion_history.h"

#include <gtest/gtest.h>

namespace fovea {
namespace {

StampedPose pose_at(double time, double x) {
  StampedPose pose{from_seconds(time)};
  pose.T_local_body.translation().x() = x;
  return pose;
}

TEST(MotionHistory, GrowsWithTheFramesAndKeepsAMinute) {
  DriveInfo drive;
  drive.navigation = Trajectory({pose_at(0, 0)});
  drive.navigation_accuracy = {0.1};
  drive.imu.emplace().samples = {{0, {}, {}}};
  MotionHistory history(drive);
  const Trajectory* const navigation = history.navigation();
  const ImuData* const imu = history.imu();
  for (int i = 1; i <= 100; ++i) {
    MotionData data;
    data.poses = {pose_at(i, 10 * i)};
    data.accuracy = {double(i)};
    data.imu = {{from_seconds(i), {}, {}}};
    history.add(data);
  }
  EXPECT_EQ(history.navigation(), navigation);  // the models keep the addresses
  EXPECT_EQ(history.imu(), imu);
  EXPECT_EQ(navigation->poses().size(), 61u);
  EXPECT_EQ(history.navigation_accuracy().front(), 40);
  EXPECT_EQ(history.navigation_accuracy().back(), 100);
  EXPECT_EQ(imu->samples.size(), 61u);
  EXPECT_NEAR(navigation->at(from_seconds(99.5))->translation().x(), 995, 1e-9);
}

TEST(MotionHistory, NavigationOfALiveDriveMayBeginLater) {
  DriveInfo drive;
  drive.kind = kLiveDrive;
  MotionHistory history(drive);
  const Trajectory* const navigation = history.navigation();
  ASSERT_NE(navigation, nullptr);
  EXPECT_FALSE(navigation->at(0));
  EXPECT_FALSE(navigation->motion(0, 0));
  MotionData data;
  data.poses = {pose_at(1, 10), pose_at(2, 20)};
  data.accuracy = {0.1, 0.2};
  history.add(data);
  EXPECT_NEAR(navigation->at(from_seconds(1.5))->translation().x(), 15, 1e-9);
  EXPECT_EQ(history.navigation_accuracy(), data.accuracy);
}

TEST(MotionHistory, ASensorThatTheDriveLackedAtItsBeginningIsNotUsed) {
  const DriveInfo drive;
  MotionHistory history(drive);
  MotionData data;
  data.poses = {pose_at(1, 0)};
  data.accuracy = {0};
  data.imu = {{1, {}, {}}};
  data.wheels = {{1, 2.0}};
  history.add(data);
  EXPECT_EQ(history.navigation(), nullptr);
  EXPECT_EQ(history.imu(), nullptr);
  EXPECT_EQ(history.wheels(), nullptr);
}

}  // namespace
}  // namespace fovea
