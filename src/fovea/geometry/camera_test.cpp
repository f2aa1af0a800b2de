#include "fovea/camera.h"

#include <gtest/gtest.h>

namespace fovea::camera_test {

Camera small_camera() {
  Camera camera{0, 640, 480, 500, 500, 319.5, 239.5, RigidMotion::Identity()};
  // The LiDAR's x (forward) is the camera's z; the camera stands 1 m ahead of the LiDAR.
  camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  camera.T_cam_lidar.translation() = Eigen::Vector3d(0, 0, -1);
  return camera;
}

TEST(Camera, ProjectsAsAPinhole) {
  const Camera camera = small_camera();
  // 10 m deep, 1 m to the left and 2 m up.
  const auto pixel = camera.project(camera.T_cam_lidar * Eigen::Vector3d(11, 1, 2));
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 319.5 - 50, 1e-12);
  EXPECT_NEAR(pixel->y(), 239.5 - 100, 1e-12);
  EXPECT_LT((camera.center_lidar() - Eigen::Vector3d(1, 0, 0)).norm(), 1e-15);
}

TEST(Camera, NothingBehindOrBesideIt) {
  const Camera camera = small_camera();
  EXPECT_FALSE(camera.project({0, 0, -5}));
  EXPECT_FALSE(camera.project({1, 1, 0}));
  EXPECT_FALSE(camera.project({0, 0, std::numeric_limits<double>::quiet_NaN()}));
}

TEST(Camera, ViewEndsAtTheOutermostPixelCentres) {
  const Camera camera = small_camera();
  EXPECT_TRUE(camera.in_view({0, 0}));
  EXPECT_TRUE(camera.in_view({639, 479}));
  EXPECT_FALSE(camera.in_view({639.01, 479}));
  EXPECT_FALSE(camera.in_view({-0.01, 0}));
  EXPECT_FALSE(camera.in_view({0, std::numeric_limits<double>::quiet_NaN()}));
}

// Half a second after the stamp the LiDAR is 5 m further on: what was 20 m ahead is 15 m ahead.
TEST(Camera, StandsWhereItWasWhenTheImageWasTaken) {
  Camera camera;
  camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  camera.image_delay = 0.5;
  const Twist forward = (Twist() << 0, 0, 0, 10, 0, 0).finished();
  const Eigen::Vector3d ahead(20, 1, 0);
  const Camera at_image = camera.at_image(SweepMotion{forward});
  EXPECT_LT((at_image.T_cam_lidar * ahead - Eigen::Vector3d(-1, 0, 15)).norm(), 1e-12);
  EXPECT_EQ(at_image.image_delay, 0);
  EXPECT_LT((camera.at_image(std::nullopt).T_cam_lidar * ahead - Eigen::Vector3d(-1, 0, 20)).norm(),
            1e-12);
  // Braking with 4 m/s^2 it is only 4.5 m further on.
  const Twist brake = (Twist() << 0, 0, 0, -4, 0, 0).finished();
  const Camera braking = camera.at_image(SweepMotion{forward, brake});
  EXPECT_LT((braking.T_cam_lidar * ahead - Eigen::Vector3d(-1, 0, 15.5)).norm(), 1e-12);
  // Turning left by 0.2 rad a second: straight ahead moves to the right.
  const Twist left = (Twist() << 0, 0, 0.2, 0, 0, 0).finished();
  EXPECT_GT((camera.at_image(SweepMotion{left}).T_cam_lidar * Eigen::Vector3d(20, 0, 0)).x(), 1.9);
}

}  // namespace fovea::camera_test
