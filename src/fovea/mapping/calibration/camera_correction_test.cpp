#include "fovea/mapping/calibration/camera_correction.h"

#include <gtest/gtest.h>

#include <numbers>

namespace fovea::camera_correction_test {

constexpr double kSmall = 1e-6;

Camera forward_camera() {
  Camera camera;
  camera.width = 620;
  camera.height = 188;
  camera.fx = 360;
  camera.fy = 350;
  camera.cx = 310;
  camera.cy = 94;
  camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  camera.T_cam_lidar.translation() = Eigen::Vector3d(0.06, -0.08, -0.27);
  camera.image_delay = 0.01;
  return camera;
}

CameraCorrection correction(double scale) {
  return {.rotation = scale * Eigen::Vector3d(0.05, -0.08, 0.11),
          .translation = scale * Eigen::Vector3d(0.3, -0.1, 0.2),
          .delay = scale * 0.03};
}

void expect_same(const Camera& a, const Camera& b) {
  EXPECT_LT((a.T_cam_lidar.matrix() - b.T_cam_lidar.matrix()).norm(), 1e-12);
  EXPECT_NEAR(a.image_delay, b.image_delay, 1e-15);
}

TEST(CameraCorrection, ARotationLeavesTheCenterOfTheCamera) {
  const Camera camera = forward_camera();
  const Camera right = corrected(camera, {.rotation = {0.3, -0.2, 0.5}, .delay = 0.02});
  EXPECT_LT((right.center_lidar() - camera.center_lidar()).norm(), 1e-12);
  EXPECT_NEAR(right.image_delay, 0.03, 1e-15);
  EXPECT_EQ(right.fx, camera.fx);
}

// A quarter turn about the forward axis maps right to down.
TEST(CameraCorrection, RotatesAfterTheTranslation) {
  const Camera camera = forward_camera();
  const Camera right =
      corrected(camera, {.rotation = {0, 0, std::numbers::pi / 2}, .translation = {1, 2, 3}});
  const Eigen::Vector3d p_lidar = camera.T_cam_lidar.inverse() * Eigen::Vector3d(4, 5, 6);
  EXPECT_LT((right.T_cam_lidar * p_lidar - Eigen::Vector3d(-7, 5, 9)).norm(), 1e-12);
}

TEST(CameraCorrection, JoinedHasTheEffectOfBoth) {
  const Camera camera = forward_camera();
  const CameraCorrection first = correction(1), second = correction(-2.5);
  expect_same(corrected(camera, joined(first, second)),
              corrected(corrected(camera, first), second));
  // The order of rotations matters.
  const CameraCorrection other{.rotation = {0.2, 0.1, 0}, .translation = {0, 1, 0}};
  expect_same(corrected(camera, joined(first, other)), corrected(corrected(camera, first), other));
  expect_same(corrected(camera, joined(other, first)), corrected(corrected(camera, other), first));
}

TEST(CameraCorrection, JoinedWithNothingIsTheSame) {
  for (const CameraCorrection& both : {joined(correction(1), {}), joined({}, correction(1))}) {
    EXPECT_LT((both.rotation - correction(1).rotation).norm(), 1e-12);
    EXPECT_LT((both.translation - correction(1).translation).norm(), 1e-12);
    EXPECT_NEAR(both.delay, correction(1).delay, 1e-15);
  }
}

TEST(CameraCorrection, OfAVectorHasItsUnits) {
  const CalibrationVector vector =
      (CalibrationVector() << 1, -2, 3, -4, 5, -6, 7, 1000, 1000).finished();
  const CalibrationVector& unit = calibration_unit();
  const CameraCorrection found = correction_of(vector);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(found.rotation[k], vector[kCamRotation + k] * unit[kCamRotation + k], 1e-15);
    EXPECT_NEAR(found.translation[k], vector[kCamTranslation + k] * unit[kCamTranslation + k],
                1e-15);
  }
  EXPECT_NEAR(found.delay, vector[kCamDelay] * unit[kCamDelay], 1e-15);
}

/// Pixel of a fixed point under a correction by `by` of one parameter. The LiDAR moves at constant
/// velocity, and the point is given in its frame at the uncorrected delay.
Eigen::Vector2d pixel_at(const Camera& camera, const Eigen::Vector3d& p_lidar,
                         const Twist& velocity, int parameter, double by) {
  const CalibrationVector step = by * CalibrationVector::Unit(parameter);
  const Camera moved = corrected(camera, correction_of(step.cwiseQuotient(calibration_unit())));
  const double later = moved.image_delay - camera.image_delay;
  return moved.project(moved.T_cam_lidar * (exp_se3(later * velocity).inverse() * p_lidar)).value();
}

TEST(CameraCorrection, JacobianIsTheDerivative) {
  const Twist velocity = (Twist() << 0.02, -0.05, 0.3, 9, 0.2, -0.1).finished();
  for (const CameraCorrection& by : {CameraCorrection{}, correction(1)}) {
    const Camera camera = corrected(forward_camera(), by);
    for (const auto& p_lidar :
         {Eigen::Vector3d(8, 0.1, -0.2), Eigen::Vector3d(12, 5, -1.5), Eigen::Vector3d(6, -4, 1)}) {
      const PixelJacobian J = pixel_jacobian(camera, p_lidar, velocity);
      for (int k = 0; k < kCalibrationSize; ++k) {
        const Eigen::Vector2d slope = (pixel_at(camera, p_lidar, velocity, k, kSmall) -
                                       pixel_at(camera, p_lidar, velocity, k, -kSmall)) /
                                      (2 * kSmall);
        EXPECT_LT((J.col(k) - slope).norm(), 1e-5 * (1 + slope.norm())) << k;
      }
    }
  }
}

// One unit is worth about a pixel on a road: f = 700, 10 m away, 10 m/s.
TEST(CameraCorrection, UnitsAreWorthAboutAPixel) {
  Camera camera = forward_camera();
  camera.fx = camera.fy = 700;
  const Twist forward = (Twist() << 0, 0, 0, 10, 0, 0).finished();
  const PixelJacobian J = pixel_jacobian(camera, {10, 2, 0.5}, forward);
  for (int k = 0; k < kCalibrationSize; ++k) {
    const double pixels = J.col(k).norm() * calibration_unit()[k];
    EXPECT_GT(pixels, 0.5) << k;
    EXPECT_LT(pixels, 2) << k;
  }
}

}  // namespace fovea::camera_correction_test
