#include "app/pose_lines.h"

#include <gtest/gtest.h>

namespace fovea::pose_lines_test {
namespace {

/// Turned by 90 degrees about the vertical.
bridge::PublishedPose turned_pose() {
  bridge::PublishedPose pose;
  pose.frame = 12;
  pose.stamp = 1'700'000'000'123'456'789;
  pose.T_world_lidar.translation() = Eigen::Vector3d(1.5, -2.25, 1e-3);
  pose.T_world_lidar.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  pose.state = "tracked";
  return pose;
}

constexpr const char* kLine =
    "12 1700000000123456789 tracked 1.500000 -2.250000 0.001000 "
    "0.000000000 0.000000000 0.707106781 0.707106781";

TEST(PoseLines, HaveFrameTimeStateAndPose) { EXPECT_EQ(app::pose_line(turned_pose()), kLine); }

TEST(PoseLines, AKnownCovarianceAddsDeviationsAlongTheWorldsAxes) {
  bridge::PublishedPose pose = turned_pose();
  const double variances[] = {0.01, 0.04, 0.09, 1, 4, 9};  // rotations of the LiDAR first
  pose.covariance = bridge::PoseCovariance::Zero();
  for (int k = 0; k < 6; ++k) (*pose.covariance)(k, k) = variances[k];
  EXPECT_EQ(app::pose_line(pose), std::string(kLine) + " 2 1 3 0.2 0.1 0.3");
}

}  // namespace
}  // namespace fovea::pose_lines_test
