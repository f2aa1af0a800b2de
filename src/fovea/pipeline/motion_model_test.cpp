#include "fovea/pipeline/motion_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace fovea::motion_model_test {

constexpr TimeNs kTenth = kNsPerSecond / 10;

RigidMotion at_x(double x) {
  RigidMotion T = RigidMotion::Identity();
  T.translation().x() = x;
  return T;
}

TEST(MotionModel, WithoutNavigationStartsAtRestAndThenKeepsItsVelocity) {
  MotionModel model(nullptr);
  EXPECT_TRUE(model.predict(0).guesses[0].T_odom_lidar.isApprox(RigidMotion::Identity()));
  EXPECT_FALSE(model.predict(0).guesses[0].motion);
  model.update(0, at_x(0));
  model.update(kTenth, at_x(1.5));
  const MotionPrediction next = model.predict(3 * kTenth);  // one frame is missing
  EXPECT_NEAR(next.guesses[0].T_odom_lidar.translation().x(), 4.5, 1e-12);
  EXPECT_NEAR(next.guesses[0].motion->velocity[3], 15, 1e-9);
  EXPECT_FALSE(next.T_local_lidar_navigation);
}

TEST(MotionModel, BeginsWithTheGivenVelocity) {
  Twist velocity = Twist::Zero();
  velocity[3] = 20;
  MotionModel model(nullptr);
  model.begin_with(velocity);
  const MotionPrediction first = model.predict(0);
  EXPECT_TRUE(first.guesses[0].T_odom_lidar.isApprox(RigidMotion::Identity()));
  EXPECT_EQ(first.guesses[0].motion->velocity, velocity);
  model.update(0, at_x(0));
  EXPECT_NEAR(model.predict(kTenth).guesses[0].T_odom_lidar.translation().x(), 2, 1e-12);
  model.update(kTenth, at_x(1.5));  // from here on the velocity of the poses
  EXPECT_NEAR(model.predict(2 * kTenth).guesses[0].T_odom_lidar.translation().x(), 3, 1e-12);
}

TEST(MotionModel, NavigationsMotionIsAppliedToTheRefinedPose) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back({i * kTenth, at_x(i)});
  const Trajectory navigation(poses);
  MotionModel model(&navigation, {.sweep_rest = kTenth / 2});
  EXPECT_NEAR(model.predict(kTenth).guesses[0].T_odom_lidar.translation().x(), 1, 1e-12);
  model.update(kTenth, at_x(1.25));  // refined: navigation was 25 cm off
  const MotionPrediction next = model.predict(2 * kTenth);
  EXPECT_NEAR(next.guesses[0].T_odom_lidar.translation().x(), 2.25, 1e-12);
  EXPECT_NEAR(next.T_local_lidar_navigation->translation().x(), 2, 1e-12);
  EXPECT_NEAR(next.guesses[0].motion->velocity[3], 10, 1e-9);
}

/// Navigation that leaves the true motion (1 m a frame) at frame 5.
MotionPrediction predict_fifth(const RigidMotion& navigation_at_5, bool doubt) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 5; ++i) poses.push_back({i * kTenth, at_x(i)});
  poses.push_back({5 * kTenth, navigation_at_5});
  const Trajectory navigation(poses);
  MotionModel model(&navigation, {.doubt = doubt});
  for (int i = 3; i < 5; ++i) model.update(i * kTenth, at_x(i));
  return model.predict(5 * kTenth);
}

TEST(MotionModel, NavigationThatContradictsTheMotionIsTheSecondGuess) {
  for (const double x : {4.0, 10.0, 0.0}) {  // frozen, jumped ahead, jumped back
    const MotionPrediction prediction = predict_fifth(at_x(x), true);
    ASSERT_EQ(prediction.guesses.size(), 2u) << x;
    EXPECT_FALSE(prediction.guesses[0].by_navigation);
    EXPECT_NEAR(prediction.guesses[0].T_odom_lidar.translation().x(), 5, 1e-9);
    EXPECT_NEAR(prediction.guesses[0].motion->velocity[3], 10, 1e-9);
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

/// Largest error of the model's velocity (m/s) from the fifth frame on, for a vehicle at x(frame)
/// with position errors jitter(frame).
double worst_velocity(const std::function<double(double)>& x,
                      const std::function<double(int)>& jitter, bool doubt) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < 30; ++i) poses.push_back({i * kTenth, at_x(x(i) + jitter(i))});
  const Trajectory navigation(poses);
  MotionModel model(&navigation, {.doubt = doubt, .sweep_rest = kTenth / 2});
  double worst = 0;
  for (int i = 0; i < 30; ++i) {
    const MotionPrediction prediction = model.predict(i * kTenth);
    EXPECT_EQ(prediction.guesses.size(), 1u) << i;
    const double actual = (x(i + 0.5) - x(i - 0.5)) * 10;
    if (i >= 5)
      worst = std::max(worst, std::abs(prediction.guesses[0].motion->velocity[3] - actual));
    model.update(i * kTenth, at_x(x(i)));
  }
  return worst;
}

TEST(MotionModel, TheWeightOfNavigationsAccelerationDependsOnItsErrors) {
  // Braking with 4 m/s^2; the measured velocity is right, or has alternating errors of 2 m/s.
  const auto acceleration = [](double error) {
    std::vector<StampedPose> poses;
    for (int i = 0; i < 30; ++i) {
      Twist velocity = Twist::Zero();
      velocity[3] = 20 - 0.4 * i + (i % 2 == 0 ? error : -error);
      poses.push_back({i * kTenth, at_x(2 * i - 0.02 * i * i), velocity});
    }
    const Trajectory navigation(poses);
    MotionModel model(&navigation, {.doubt = true, .sweep_rest = kTenth / 2});
    for (int i = 0; i < 20; ++i) model.update(i * kTenth, at_x(2 * i - 0.02 * i * i));
    return model.predict(20 * kTenth).guesses[0].motion->acceleration[3];
  };
  EXPECT_NEAR(acceleration(0), -4, 0.1);
  EXPECT_LT(std::abs(acceleration(0.9)), 7);  // 14 m/s^2 by the measured velocity
}

TEST(MotionModel, VelocityIsThatOfTheBetterPrediction) {
  const auto steady = [](double frame) { return frame; };
  const auto braking = [](double frame) { return 2 * frame - 0.02 * frame * frame; };  // 4 m/s^2
  const auto none = [](int) { return 0.0; };
  const auto two_centimeters = [](int frame) { return frame % 2 == 0 ? 0.01 : -0.01; };
  EXPECT_NEAR(worst_velocity(steady, two_centimeters, /*doubt=*/false), 0.2, 1e-9);
  EXPECT_LT(worst_velocity(steady, two_centimeters, true), 0.04);
  // The motion so far has an error of 0.6 m/s: one and a half frames late.
  EXPECT_NEAR(worst_velocity(braking, none, /*doubt=*/false), 0.2, 1e-9);
  EXPECT_LT(worst_velocity(braking, none, true), 0.26);
}

TEST(MotionModel, ErrorsOfVelocityAreBoundedAndForgotten) {
  const Twist none = Twist::Zero();
  VelocityError error;
  const Twist unknown = error.mean_square();
  EXPECT_GT(unknown.minCoeff(), 0);
  error.add(Twist::Constant(1e6), none);  // one outlier
  EXPECT_LT(error.mean_square().maxCoeff(), 1);
  for (int i = 0; i < 60; ++i) error.add(Twist::Constant(0.01), none);
  EXPECT_NEAR(error.mean_square()[3], 1e-4, 1e-3);
  EXPECT_LT(error.mean_square()[3], unknown[3]);
}

TEST(MotionModel, BeyondTheNavigationItUsesTheVelocity) {
  const Trajectory navigation({{0, at_x(0)}, {kTenth, at_x(1)}});
  MotionModel model(&navigation);
  model.update(0, at_x(0));
  model.update(kTenth, at_x(1));
  const MotionPrediction late = model.predict(10 * kTenth);  // 0.9 s after the last record
  EXPECT_NEAR(late.guesses[0].T_odom_lidar.translation().x(), 10, 1e-9);
  EXPECT_FALSE(late.T_local_lidar_navigation);
}

TEST(MotionModel, NoVelocityIsUsedAfterAPause) {
  MotionModel model(nullptr);
  for (int i = 0; i < 4; ++i) model.update(i * kTenth, at_x(i));
  EXPECT_FALSE(model.follows_pause(4 * kTenth));
  EXPECT_FALSE(model.follows_pause(13 * kTenth));  // nine frames are missing
  const TimeNs after = 60 * kNsPerSecond;
  ASSERT_TRUE(model.follows_pause(after));
  EXPECT_TRUE(model.needs_initial_velocity(after));
  const MotionPrediction first = model.predict(after);
  EXPECT_TRUE(first.after_pause);
  EXPECT_NEAR(first.guesses[0].T_odom_lidar.translation().x(), 3, 1e-12);
  EXPECT_FALSE(first.guesses[0].motion);
  model.update(after, at_x(50));
  const MotionPrediction second = model.predict(after + kTenth);
  EXPECT_FALSE(second.after_pause);
  EXPECT_NEAR(second.guesses[0].T_odom_lidar.translation().x(), 50, 1e-12);
  EXPECT_FALSE(second.guesses[0].motion);
  model.update(after + kTenth, at_x(52));
  EXPECT_FALSE(model.needs_initial_velocity(after + 2 * kTenth));
  EXPECT_NEAR(model.predict(after + 2 * kTenth).guesses[0].T_odom_lidar.translation().x(), 54,
              1e-12);
}

TEST(MotionModel, NavigationNearAPauseBridgesIt) {
  // 1 m a frame; records lie 4 ms behind the frames, and none in the pause of 60 s.
  std::vector<StampedPose> poses;
  const auto stamp = [](int i) { return i * kTenth + (i >= 5 ? 60 * kNsPerSecond : 0); };
  const TimeNs late = kNsPerSecond / 250;
  for (int i = 0; i < 10; ++i) poses.push_back({stamp(i) + late, at_x(i + 0.04)});
  const Trajectory navigation(poses);
  MotionModel model(&navigation, {.sweep_rest = kTenth / 2});
  for (int i = 0; i < 5; ++i) model.update(stamp(i), at_x(i));
  const MotionPrediction first = model.predict(stamp(5));
  ASSERT_EQ(first.guesses.size(), 1u);
  EXPECT_TRUE(first.after_pause);
  EXPECT_TRUE(first.guesses[0].by_navigation);
  EXPECT_NEAR(first.guesses[0].T_odom_lidar.translation().x(), 5, 1e-9);
  EXPECT_NEAR(first.guesses[0].motion->velocity[3], 10, 1e-9);
}

TEST(MotionModel, ASlowDriveDoesNotPause) {
  MotionModel model(nullptr);
  for (int i = 0; i < 3; ++i) model.update(2 * i * kNsPerSecond, at_x(i));
  EXPECT_FALSE(model.follows_pause(6 * kNsPerSecond));
  EXPECT_NEAR(model.predict(6 * kNsPerSecond).guesses[0].T_odom_lidar.translation().x(), 3, 1e-12);
  EXPECT_TRUE(model.follows_pause(11 * kNsPerSecond));
}

TEST(MotionModel, AThousandGuessesInARowStayRigid) {
  MotionModel model(nullptr);
  RigidMotion T = RigidMotion::Identity();
  model.update(0, T);
  T.linear() = Eigen::AngleAxisd(0.01, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  model.update(kTenth, T);
  for (int i = 2; i < 1000; ++i) {
    T = model.predict(i * kTenth).guesses[0].T_odom_lidar;
    model.update(i * kTenth, T);
  }
  EXPECT_TRUE(is_rotation(T.linear(), 1e-12));
}

/// An IMU at the LiDAR, in a vehicle that speeds up along x by 3 m/s^2 from 5 m/s on.
constexpr double kSpeedingUp = 3, kFirstSpeed = 5;

double way_at(double time) { return kFirstSpeed * time + kSpeedingUp * time * time / 2; }

ImuData speeding_up() {
  ImuData imu;
  for (int i = -20; i < 400; ++i) {
    imu.samples.push_back(
        {i * kNsPerSecond / 100, Eigen::Vector3d::Zero(), {kSpeedingUp, 0, 9.81}});
  }
  return imu;
}

/// Level: gravity is that of navigation's frame.
MotionModel model_of(const ImuData& imu, const Trajectory* navigation = nullptr) {
  MotionModel model(MotionSources{.navigation = navigation, .imu = &imu},
                    {.navigation_is_level = navigation != nullptr});
  model.begin_with((Twist() << 0, 0, 0, kFirstSpeed, 0, 0).finished());
  for (int i = 0; i < 20; ++i) model.update(i * kTenth, at_x(way_at(0.1 * i)));
  return model;
}

TEST(MotionModel, AnImuTellsTheMotionBetweenFrames) {
  const ImuData imu = speeding_up();
  const MotionPrediction next = model_of(imu).predict(20 * kTenth, {-0.1, 0});
  ASSERT_EQ(next.guesses.size(), 1u);
  const MotionGuess& guess = next.guesses[0];
  EXPECT_NEAR(guess.T_odom_lidar.translation().x(), way_at(2), 0.005);
  ASSERT_TRUE(guess.motion && guess.motion->path);
  EXPECT_NEAR(guess.motion->path->at(-0.1).translation().x(), way_at(1.9) - way_at(2), 0.003);
  EXPECT_NEAR(guess.motion->velocity[3], kFirstSpeed + 2 * kSpeedingUp, 0.05);
  EXPECT_FALSE(guess.sigma);  // on a straight way nothing has proven the IMU
  EXPECT_FALSE(guess.by_navigation);
}

TEST(MotionModel, WhereTheImuEndsVelocitiesPredict) {
  const ImuData imu = speeding_up();
  MotionModel model = model_of(imu);
  for (int i = 20; i < 60; ++i) model.update(i * kTenth, at_x(way_at(0.1 * i)));
  const MotionPrediction next = model.predict(60 * kTenth);
  ASSERT_EQ(next.guesses.size(), 1u);
  EXPECT_FALSE(next.guesses[0].motion->path);
  EXPECT_NEAR(next.guesses[0].T_odom_lidar.translation().x(), 2 * way_at(5.9) - way_at(5.8), 1e-6);
}

TEST(MotionModel, NavigationCorrectsAnImuUnlessTheyContradict) {
  const ImuData imu = speeding_up();
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 20; ++i) poses.push_back({i * kTenth, at_x(way_at(0.1 * i))});
  const Trajectory good(poses);
  EXPECT_NEAR(model_of(imu, &good).predict(20 * kTenth).guesses[0].T_odom_lidar.translation().x(),
              way_at(2), 0.005);
  poses.back().T_local_body = at_x(way_at(2) + 3);
  const Trajectory jumping(poses);
  const MotionPrediction next = model_of(imu, &jumping).predict(20 * kTenth);
  ASSERT_EQ(next.guesses.size(), 2u);
  EXPECT_NEAR(next.guesses[0].T_odom_lidar.translation().x(), way_at(2), 0.005);
  EXPECT_TRUE(next.guesses[1].by_navigation);
}

}  // namespace fovea::motion_model_test
