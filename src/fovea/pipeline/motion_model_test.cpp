#include "fovea/pipeline/motion_model.h"

#include <gtest/gtest.h>

namespace fovea {
namespace {

constexpr TimeNs kTenth = kNsPerSecond / 10;

RigidMotion at_x(double x) {
  RigidMotion T = RigidMotion::Identity();
  T.translation().x() = x;
  return T;
}

TEST(MotionModel, WithoutNavigationStartsAtRestAndThenKeepsItsVelocity) {
  MotionModel model(nullptr);
  EXPECT_TRUE(model.predict(0, 0).T_local_lidar.isApprox(RigidMotion::Identity()));
  EXPECT_FALSE(model.predict(0, 0).velocity);
  model.update(0, at_x(0));
  model.update(kTenth, at_x(1.5));
  const MotionPrediction next = model.predict(3 * kTenth, 3 * kTenth);  // one frame is missing
  EXPECT_NEAR(next.T_local_lidar.translation().x(), 4.5, 1e-12);
  EXPECT_NEAR((*next.velocity)[3], 15, 1e-9);
  EXPECT_FALSE(next.T_local_lidar_navigation);
}

TEST(MotionModel, NavigationsMotionIsAppliedToTheRefinedPose) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back({i * kTenth, at_x(i)});
  const Trajectory navigation(poses);
  MotionModel model(&navigation);
  EXPECT_NEAR(model.predict(kTenth, kTenth).T_local_lidar.translation().x(), 1, 1e-12);
  model.update(kTenth, at_x(1.25));  // refined: navigation was 25 cm off
  const MotionPrediction next = model.predict(2 * kTenth, 2 * kTenth + kTenth / 2);
  EXPECT_NEAR(next.T_local_lidar.translation().x(), 2.25, 1e-12);
  EXPECT_NEAR(next.T_local_lidar_navigation->translation().x(), 2, 1e-12);
  EXPECT_NEAR((*next.velocity)[3], 10, 1e-9);
}

TEST(MotionModel, WithoutInterpolationTheNearestRecordCounts) {
  const Trajectory navigation({{0, at_x(0)}, {kTenth, at_x(1)}, {2 * kTenth, at_x(2)}});
  const MotionModel model(&navigation, /*interpolate=*/false);
  EXPECT_NEAR(model.predict(kTenth * 6 / 10, kTenth).T_local_lidar.translation().x(), 1, 1e-12);
  EXPECT_NEAR(model.predict(kTenth * 4 / 10, kTenth).T_local_lidar.translation().x(), 0, 1e-12);
}

TEST(MotionModel, BeyondTheNavigationItGoesOnByVelocity) {
  const Trajectory navigation({{0, at_x(0)}, {kTenth, at_x(1)}});
  MotionModel model(&navigation);
  model.update(0, at_x(0));
  model.update(kTenth, at_x(1));
  const MotionPrediction late =
      model.predict(10 * kTenth, 10 * kTenth);  // 0.9 s after the last record
  EXPECT_NEAR(late.T_local_lidar.translation().x(), 10, 1e-9);
  EXPECT_FALSE(late.T_local_lidar_navigation);
}

TEST(MotionModel, AThousandGuessesInARowStayRigid) {
  MotionModel model(nullptr);
  RigidMotion T = RigidMotion::Identity();
  model.update(0, T);
  T.linear() = Eigen::AngleAxisd(0.01, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  model.update(kTenth, T);
  for (int i = 2; i < 1000; ++i) {
    T = model.predict(i * kTenth, i * kTenth).T_local_lidar;
    model.update(i * kTenth, T);
  }
  EXPECT_TRUE(is_rotation(T.linear(), 1e-12));
}

}  // namespace
}  // namespace fovea
