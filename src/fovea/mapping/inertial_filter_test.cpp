#include "fovea/mapping/inertial_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>

namespace fovea::inertial_filter_test {

using Vector3 = Eigen::Vector3d;

constexpr double kGravity = 9.81;
constexpr TimeNs kStart = 1'700'000'000 * kNsPerSecond, kFrame = kNsPerSecond / 10;
const SweepSpan kSweep{-0.05, 0.05};

TimeNs at(double time) { return kStart + from_seconds(time); }

/// A LiDAR on a circle of 5 m that bobs, tilted against gravity, from rest or at once.
class Motion {
 public:
  explicit Motion(bool starts_at_rest = false) : starts_at_rest_(starts_at_rest) {}

  RigidMotion T_odom_lidar(double time) const {
    const RigidMotion start = T_world_lidar(0);
    return start.inverse() * T_world_lidar(time);
  }
  /// In odom, which is the LiDAR's frame at time 0.
  Vector3 gravity() const {
    return T_world_lidar(0).linear().transpose() * Vector3(0, 0, -kGravity);
  }

 private:
  RigidMotion T_world_lidar(double time) const {
    if (starts_at_rest_) {  // speeds up within a second
      constexpr double kRest = 2;
      const double moving = std::max(0.0, time - kRest);
      time = moving < 1 ? moving * moving * moving * (1 - moving / 2) : moving - 0.5;
    }
    const double angle = 0.9 * time;
    RigidMotion T = RigidMotion::Identity();
    T.translation() << 5 * std::cos(angle), 5 * std::sin(angle), 0.04 * std::sin(9 * time);
    T.linear() = (Eigen::AngleAxisd(angle + 1.2, Vector3::UnitZ()) *
                  Eigen::AngleAxisd(0.2 + 0.05 * std::sin(7 * time), Vector3::UnitX()))
                     .toRotationMatrix();
    return T;
  }
  bool starts_at_rest_;
};

RigidMotion mount() {
  RigidMotion T_lidar_imu = RigidMotion::Identity();
  T_lidar_imu.translation() << -0.2, 0.1, 0.3;
  T_lidar_imu.linear() = Eigen::AngleAxisd(2, Vector3(1, -1, 2).normalized()).toRotationMatrix();
  return T_lidar_imu;
}

const Vector3 kRateBias(0.004, -0.003, 0.002), kForceBias(0.08, -0.05, 0.03);

/// Exact measurements at 200 Hz with constant biases, by differences of the poses.
ImuData measure(const Motion& motion, double seconds_long, const Vector3& rate_bias = kRateBias,
                const Vector3& force_bias = kForceBias) {
  ImuData imu;
  imu.T_lidar_imu = mount();
  imu.noise = {1e-4, 1e-6, 1e-3, 1e-5};
  constexpr double kHalf = 1e-4;
  for (int i = -200; i <= seconds_long * 200; ++i) {
    const double time = i / 200.0;
    const RigidMotion before = motion.T_odom_lidar(time - kHalf) * mount(),
                      now = motion.T_odom_lidar(time) * mount(),
                      after = motion.T_odom_lidar(time + kHalf) * mount();
    const Vector3 acceleration =
        (after.translation() - 2 * now.translation() + before.translation()) / (kHalf * kHalf);
    const Eigen::AngleAxisd turn(before.linear().transpose() * after.linear());
    imu.samples.push_back(
        {at(time), turn.angle() * turn.axis() / (2 * kHalf) + rate_bias,
         now.linear().transpose() * (acceleration - motion.gravity()) + force_bias});
  }
  return imu;
}

Twist pose_sigma() {
  return (Twist() << Twist::Constant(1e-3).head<3>(), Twist::Constant(3e-3).head<3>()).finished();
}

/// Follows the true poses.
InertialFilter followed(const ImuData& imu, const Motion& motion, int frames,
                        const InertialStart& start = {}) {
  InertialFilter filter(imu);
  filter.begin(kStart, start);
  for (int i = 1; i <= frames; ++i) {
    filter.update(filter.predict(kStart + i * kFrame), motion.T_odom_lidar(0.1 * i), pose_sigma());
  }
  return filter;
}

double position_error(const RigidMotion& a, const RigidMotion& b) {
  return (a.translation() - b.translation()).norm();
}

double angle_between(const Vector3& a, const Vector3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

// The covariance of gravity's angles stays with the axes, so these must not swing.
TEST(InertialFilter, TheAxesAcrossGravityTurnWithIt) {
  InertialState state;
  state.gravity = kGravity * -Vector3::UnitZ();
  const auto down = across_gravity(state);
  for (const double angle : {0.0, 1.5, 3.0, 4.5, 6.0}) {
    state.gravity = kGravity * Vector3(1e-3 * std::cos(angle), 1e-3 * std::sin(angle), -1);
    EXPECT_LT((across_gravity(state) - down).norm(), 3e-3) << angle;
  }
  state.gravity = kGravity * Vector3::UnitX();
  const auto axes = across_gravity(state);
  EXPECT_LT((axes.transpose() * axes - Eigen::Matrix2d::Identity()).norm(), 1e-12);
  EXPECT_LT((axes.transpose() * state.gravity).norm(), 1e-12);
}

TEST(InertialFilter, FindsGravityAndBiasesInMotion) {
  const Motion motion;
  const ImuData imu = measure(motion, 12);
  const InertialFilter filter = followed(imu, motion, 100);
  EXPECT_LT(angle_between(filter.state().gravity, motion.gravity()), 0.002);
  EXPECT_NEAR(filter.state().gravity.norm(), kGravity, 1e-9);
  EXPECT_LT((filter.state().rate_bias - kRateBias).norm(), 3e-4);
  EXPECT_LT((filter.state().force_bias - kForceBias).norm(), 0.02);
}

TEST(InertialFilter, PredictsPosesAndTheSweepBetween) {
  const Motion motion;
  const ImuData imu = measure(motion, 12);
  const InertialFilter filter = followed(imu, motion, 100);
  const InertialPrediction next = filter.predict(at(10.1));
  const RigidMotion truth = motion.T_odom_lidar(10.1);
  EXPECT_LT(position_error(next.T_odom_lidar, truth), 0.004);
  EXPECT_LT(rotation_angle(truth.linear().transpose() * next.T_odom_lidar.linear()), 5e-4);
  EXPECT_GT(next.sigma.tail<3>().minCoeff(), 1e-4);
  EXPECT_LT(next.sigma.tail<3>().maxCoeff(), 0.02);
  const SweepMotion sweep = filter.motion(next, kSweep);
  for (const double dt : {-0.05, -0.033, -0.01, 0.0, 0.02, 0.05}) {
    const RigidMotion T = truth.inverse() * motion.T_odom_lidar(10.1 + dt);
    EXPECT_LT(position_error(sweep.path->at(dt), T), 0.002) << dt;
    EXPECT_LT(rotation_angle(T.linear().transpose() * sweep.path->at(dt).linear()), 5e-4) << dt;
  }
  const Twist velocity = velocity_between(truth, motion.T_odom_lidar(10.101), 0.001);
  EXPECT_LT((sweep.velocity - velocity).norm(), 0.1);
}

TEST(InertialFilter, AtRestTheMeanRateIsTheBias) {
  const Motion motion(/*starts_at_rest=*/true);
  const ImuData imu = measure(motion, 2);
  InertialFilter filter(imu);
  filter.begin(kStart, {RigidMotion::Identity(), Twist::Zero(), /*is_level=*/false});
  EXPECT_LT((filter.state().rate_bias - kRateBias).norm(), 1e-6);
  EXPECT_LT(angle_between(filter.state().gravity, motion.gravity()), 0.012);  // of the force's bias
}

TEST(InertialFilter, GravityOfALevelFrameIsKnown) {
  const ImuData imu = measure(Motion(), 2);
  InertialFilter filter(imu);
  filter.begin(kStart, {RigidMotion::Identity(), std::nullopt, /*is_level=*/true});
  EXPECT_TRUE(filter.state().gravity.isApprox(Vector3(0, 0, -kGravity)));
}

TEST(InertialFilter, BridgesASecondWithoutPoses) {
  const Motion motion;
  const ImuData imu = measure(motion, 12);
  InertialFilter filter = followed(imu, motion, 100);
  const InertialPrediction blind = filter.predict(at(11));
  EXPECT_LT(position_error(blind.T_odom_lidar, motion.T_odom_lidar(11)), 0.05);
  // Its own deviations tell that.
  EXPECT_GT(blind.sigma.tail<3>().norm(), filter.predict(at(10.1)).sigma.tail<3>().norm());
  filter.update(blind, blind.T_odom_lidar, std::nullopt);  // a pose that nothing confirms
  EXPECT_EQ(filter.state().covariance, blind.state.covariance);
}

TEST(InertialFilter, InAGapVelocitiesStay) {
  const Motion motion;
  ImuData imu = measure(motion, 12);
  std::erase_if(imu.samples, [](const ImuSample& sample) {
    return sample.time > at(10.02) && sample.time < at(10.2);
  });
  const InertialFilter filter = followed(imu, motion, 100);
  const InertialPrediction next = filter.predict(at(10.1));
  const RigidMotion truth = motion.T_odom_lidar(10.1);
  // The acceleration on the circle and of the bobbing is about 6 m/s^2.
  EXPECT_LT(position_error(next.T_odom_lidar, truth), 6 * 0.08 * 0.08 / 2 + 0.02);
  // It turns by 0.9 rad/s; about the other axes the rates change.
  EXPECT_LT(rotation_angle(truth.linear().transpose() * next.T_odom_lidar.linear()), 0.02);
  EXPECT_GT(next.sigma.head<3>().minCoeff(), 0.02);
  EXPECT_TRUE(filter.covers(at(10.1)));
  EXPECT_FALSE(filter.covers(at(20)));
  EXPECT_FALSE(filter.covers(at(-2)));
}

TEST(InertialFilter, PosesAndSpeedsOfOthersCorrectPredictions) {
  const Motion motion;
  const ImuData imu = measure(motion, 3);
  InertialFilter filter(imu);
  filter.begin(kStart, {});  // the velocity is not known
  const InertialPrediction raw = filter.predict(at(0.1));
  const RigidMotion truth = motion.T_odom_lidar(0.1);
  const InertialPrediction by_pose = filter.corrected(raw, truth, pose_sigma());
  EXPECT_GT(position_error(raw.T_odom_lidar, truth), 0.3);
  EXPECT_LT(position_error(by_pose.T_odom_lidar, truth), 0.02);

  RigidMotion T_lidar_body = RigidMotion::Identity();  // looks along the velocity
  const Twist velocity = velocity_between(truth, motion.T_odom_lidar(0.101), 0.001);
  T_lidar_body.linear() =
      Eigen::Quaterniond::FromTwoVectors(Vector3::UnitX(), velocity.tail<3>()).matrix();
  const InertialPrediction by_speed =
      filter.corrected(raw, velocity.tail<3>().norm(), 0.01, T_lidar_body);
  EXPECT_LT(position_error(by_speed.T_odom_lidar, truth),
            0.7 * position_error(raw.T_odom_lidar, truth));
}

TEST(InertialFilter, AfterASearchItGoesOnFromThePoseThatWasFound) {
  const Motion motion;
  const ImuData imu = measure(motion, 12);
  InertialFilter filter = followed(imu, motion, 99);
  RigidMotion T_jump = RigidMotion::Identity();
  T_jump.translation() << 4, -2, 0;
  filter.place(filter.predict(at(10)), T_jump * motion.T_odom_lidar(10));
  const RigidMotion truth = T_jump * motion.T_odom_lidar(10.1);
  EXPECT_LT(position_error(filter.predict(at(10.1)).T_odom_lidar, truth), 0.005);
  EXPECT_LT((filter.state().rate_bias - kRateBias).norm(), 3e-4);
}

TEST(InertialFilter, WheelsThatContradictItAreLeftOut) {
  const Motion motion;
  const ImuData imu = measure(motion, 12);
  const InertialFilter filter = followed(imu, motion, 100);
  const InertialPrediction next = filter.predict(at(10.1));
  const InertialPrediction slipping = filter.corrected(next, -4, 0.1, RigidMotion::Identity());
  EXPECT_EQ(slipping.state.velocity, next.state.velocity);
}

TEST(InertialFilter, NeedsABeginning) {
  const ImuData imu = measure(Motion(), 1);
  EXPECT_THROW(InertialFilter(imu).predict(kStart), std::logic_error);
}

}  // namespace fovea::inertial_filter_test
