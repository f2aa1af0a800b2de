#include "fovea/pipeline/motion_model.h"

#include <gtest/gtest.h>

namespace fovea::motion_model_test {

constexpr TimeNs kTenth = kNsPerSecond / 10;

RigidMotion at_x(double x) {
  RigidMotion T = RigidMotion::Identity();
  T.translation().x() = x;
  return T;
}

TEST(MotionModel, WithoutNavigationStartsAtRestAndThenKeepsItsVelocity) {
  MotionModel model(nullptr);
  EXPECT_TRUE(model.predict(0, 0).guesses[0].T_odom_lidar.isApprox(RigidMotion::Identity()));
  EXPECT_FALSE(model.predict(0, 0).guesses[0].velocity);
  model.update(0, at_x(0));
  model.update(kTenth, at_x(1.5));
  const MotionPrediction next = model.predict(3 * kTenth, 3 * kTenth);  // one frame is missing
  EXPECT_NEAR(next.guesses[0].T_odom_lidar.translation().x(), 4.5, 1e-12);
  EXPECT_NEAR((*next.guesses[0].velocity)[3], 15, 1e-9);
  EXPECT_FALSE(next.T_local_lidar_navigation);
}

TEST(MotionModel, NavigationsMotionIsAppliedToTheRefinedPose) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back({i * kTenth, at_x(i)});
  const Trajectory navigation(poses);
  MotionModel model(&navigation);
  EXPECT_NEAR(model.predict(kTenth, kTenth).guesses[0].T_odom_lidar.translation().x(), 1, 1e-12);
  model.update(kTenth, at_x(1.25));  // refined: navigation was 25 cm off
  const MotionPrediction next = model.predict(2 * kTenth, 2 * kTenth + kTenth / 2);
  EXPECT_NEAR(next.guesses[0].T_odom_lidar.translation().x(), 2.25, 1e-12);
  EXPECT_NEAR(next.T_local_lidar_navigation->translation().x(), 2, 1e-12);
  EXPECT_NEAR((*next.guesses[0].velocity)[3], 10, 1e-9);
}

TEST(MotionModel, WithoutInterpolationTheNearestRecordCounts) {
  const Trajectory navigation({{0, at_x(0)}, {kTenth, at_x(1)}, {2 * kTenth, at_x(2)}});
  const MotionModel model(&navigation, {.interpolate = false});
  EXPECT_NEAR(model.predict(kTenth * 6 / 10, kTenth).guesses[0].T_odom_lidar.translation().x(), 1,
              1e-12);
  EXPECT_NEAR(model.predict(kTenth * 4 / 10, kTenth).guesses[0].T_odom_lidar.translation().x(), 0,
              1e-12);
}

/// Navigation that leaves the true motion (1 m a frame) at frame 5.
MotionPrediction predict_fifth(const RigidMotion& navigation_at_5, bool doubt) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 5; ++i) poses.push_back({i * kTenth, at_x(i)});
  poses.push_back({5 * kTenth, navigation_at_5});
  const Trajectory navigation(poses);
  MotionModel model(&navigation, {.doubt = doubt});
  for (int i = 3; i < 5; ++i) model.update(i * kTenth, at_x(i));
  return model.predict(5 * kTenth, 5 * kTenth);
}

TEST(MotionModel, NavigationThatContradictsTheMotionIsTheSecondGuess) {
  for (const double x : {4.0, 10.0, 0.0}) {  // frozen, jumped ahead, jumped back
    const MotionPrediction prediction = predict_fifth(at_x(x), true);
    ASSERT_EQ(prediction.guesses.size(), 2u) << x;
    EXPECT_FALSE(prediction.guesses[0].by_navigation);
    EXPECT_NEAR(prediction.guesses[0].T_odom_lidar.translation().x(), 5, 1e-9);
    EXPECT_NEAR((*prediction.guesses[0].velocity)[3], 10, 1e-9);
    EXPECT_TRUE(prediction.guesses[1].by_navigation);
    EXPECT_NEAR(prediction.guesses[1].T_odom_lidar.translation().x(), x, 1e-9);
  }
  RigidMotion turned = at_x(5);
  turned.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()));
  EXPECT_EQ(predict_fifth(turned, true).guesses.size(), 2u);
  EXPECT_EQ(predict_fifth(at_x(10), /*doubt=*/false).guesses.size(), 1u);
}

TEST(MotionModel, BrakingIsNoContradiction) {
  const MotionPrediction prediction = predict_fifth(at_x(4.9), true);  // 10 m/s^2
  ASSERT_EQ(prediction.guesses.size(), 1u);
  EXPECT_NEAR(prediction.guesses[0].T_odom_lidar.translation().x(), 4.9, 1e-9);
}

TEST(MotionModel, BeyondTheNavigationItGoesOnByVelocity) {
  const Trajectory navigation({{0, at_x(0)}, {kTenth, at_x(1)}});
  MotionModel model(&navigation);
  model.update(0, at_x(0));
  model.update(kTenth, at_x(1));
  const MotionPrediction late =
      model.predict(10 * kTenth, 10 * kTenth);  // 0.9 s after the last record
  EXPECT_NEAR(late.guesses[0].T_odom_lidar.translation().x(), 10, 1e-9);
  EXPECT_FALSE(late.T_local_lidar_navigation);
}

TEST(MotionModel, AThousandGuessesInARowStayRigid) {
  MotionModel model(nullptr);
  RigidMotion T = RigidMotion::Identity();
  model.update(0, T);
  T.linear() = Eigen::AngleAxisd(0.01, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  model.update(kTenth, T);
  for (int i = 2; i < 1000; ++i) {
    T = model.predict(i * kTenth, i * kTenth).guesses[0].T_odom_lidar;
    model.update(i * kTenth, T);
  }
  EXPECT_TRUE(is_rotation(T.linear(), 1e-12));
}

}  // namespace fovea::motion_model_test
