#include "fovea/geometry/pose_spline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fovea::pose_spline_test {

constexpr TimeNs kStart = 1'700'000'000 * kNsPerSecond;

TimeNs at_second(double time) { return kStart + from_seconds(time); }

/// A vehicle that speeds up, turns, nods and sways at about 1 Hz.
RigidMotion smooth_motion(double t) {
  const double phase = 2 * std::numbers::pi * t;
  RigidMotion T(Eigen::Translation3d(8 * t + 0.2 * std::sin(0.8 * phase),
                                     0.3 * std::sin(0.5 * phase + 1), 0.02 * std::sin(phase)));
  T.rotate(Eigen::AngleAxisd(0.25 * std::sin(0.4 * phase), Eigen::Vector3d::UnitZ()));
  T.rotate(Eigen::AngleAxisd(0.02 * std::sin(1.2 * phase + 2), Eigen::Vector3d::UnitY()));
  return T;
}

/// Poses of smooth_motion() at 10 Hz.
std::vector<StampedPose> smooth_poses(int count) {
  std::vector<StampedPose> poses;
  for (int i = 0; i < count; ++i) poses.push_back({at_second(0.1 * i), smooth_motion(0.1 * i)});
  return poses;
}

double distance(const RigidMotion& a, const RigidMotion& b) {
  return log_se3(a.inverse() * b).norm();
}

PoseSpline::State state_at(const PoseSpline& spline, double time) {
  return spline.at(at_second(time)).value();
}

/// The derivative of the curve, by differences.
Twist slope_at(const PoseSpline& spline, double time) {
  constexpr double kSmall = 1e-4;
  return velocity_between(state_at(spline, time - kSmall).T_local_body,
                          state_at(spline, time + kSmall).T_local_body, 2 * kSmall);
}

TEST(PoseSpline, PassesThroughThePoses) {
  std::vector<StampedPose> poses = smooth_poses(8);
  poses.erase(poses.begin() + 3);  // uneven times
  const PoseSpline spline(poses);
  for (const StampedPose& pose : poses) {
    EXPECT_LT(distance(spline.at(pose.time).value().T_local_body, pose.T_local_body), 1e-12);
  }
}

TEST(PoseSpline, AConstantTwistIsExact) {
  const Twist velocity = (Twist() << 0.1, -0.05, 0.6, 9, 0.4, -0.2).finished();
  const RigidMotion begin = exp_se3((Twist() << 0.3, 0.2, -2, 500, -90, 3).finished());
  std::vector<StampedPose> poses;
  for (const double time : {0.0, 0.1, 0.25, 0.32, 0.7, 0.8}) {
    poses.push_back({at_second(time), begin * exp_se3(time * velocity)});
  }
  const PoseSpline spline(poses);
  for (double time = -0.2; time < 1.0005; time += 0.01) {
    const PoseSpline::State state = state_at(spline, time);
    EXPECT_LT(distance(state.T_local_body, begin * exp_se3(time * velocity)), 1e-9) << time;
    EXPECT_LT((state.velocity - velocity).norm(), 1e-9) << time;
  }
}

TEST(PoseSpline, TheVelocityIsTheDerivative) {
  const PoseSpline spline(smooth_poses(12));
  for (double time = 0.013; time < 1.1; time += 0.017) {
    const Twist difference = state_at(spline, time).velocity - slope_at(spline, time);
    EXPECT_LT(difference.head<3>().norm(), 1e-4) << time;
    EXPECT_LT(difference.tail<3>().norm(), 1e-3) << time;
  }
}

TEST(PoseSpline, HasNoKinksAtThePoses) {
  const PoseSpline spline(smooth_poses(12));
  for (int i = 1; i < 11; ++i) {
    const Twist change = slope_at(spline, 0.1 * i + 0.0002) - slope_at(spline, 0.1 * i - 0.0002);
    EXPECT_LT(change.head<3>().norm(), 2e-3) << i;
    EXPECT_LT(change.tail<3>().norm(), 1e-2) << i;
  }
}

// Between the poses at both ends, where one neighbor is missing, the curve is not as good.
TEST(PoseSpline, FollowsASmoothMotionMuchCloserThanConstantTwists) {
  const auto poses = smooth_poses(15);
  const PoseSpline spline(poses);
  const Trajectory twists(poses);
  double worst = 0, worst_twist = 0, worst_velocity = 0;
  for (double time = 0.1; time <= 1.3; time += 0.005) {
    const PoseSpline::State state = state_at(spline, time);
    worst = std::max(worst, distance(smooth_motion(time), state.T_local_body));
    worst_twist =
        std::max(worst_twist, distance(smooth_motion(time), twists.at(at_second(time)).value()));
    const Twist velocity =
        velocity_between(smooth_motion(time - 1e-4), smooth_motion(time + 1e-4), 2e-4);
    worst_velocity = std::max(worst_velocity, (velocity - state.velocity).norm());
  }
  EXPECT_LT(worst, 0.1 * worst_twist);
  EXPECT_LT(worst, 0.002);
  EXPECT_LT(worst_velocity, 0.1);
}

TEST(PoseSpline, GivesNothingInAGap) {
  std::vector<StampedPose> poses = smooth_poses(4);
  constexpr double kBegin = 0.3;  // of the gap
  const double end = kBegin + seconds(PoseSpline::kMaxGap) + 0.1;
  for (const double time : {end, end + 0.1})
    poses.push_back({at_second(time), smooth_motion(time)});
  const PoseSpline spline(poses);
  const double reach = seconds(PoseSpline::kMaxExtrapolation);
  EXPECT_TRUE(spline.at(at_second(kBegin + reach)));
  EXPECT_FALSE(spline.at(at_second(kBegin + reach + 0.001)));
  EXPECT_FALSE(spline.at(at_second(end - reach - 0.001)));
  EXPECT_TRUE(spline.at(at_second(end - reach)));
  // The poses on the other side of the gap do not change the curve.
  const PoseSpline before({poses.begin(), poses.begin() + 4}),
      after({poses.begin() + 4, poses.end()});
  EXPECT_EQ(state_at(spline, 0.27).T_local_body.matrix(),
            state_at(before, 0.27).T_local_body.matrix());
  EXPECT_EQ(state_at(spline, kBegin + 0.1).velocity, state_at(before, kBegin + 0.1).velocity);
  EXPECT_EQ(state_at(spline, end - 0.1).velocity, state_at(after, end - 0.1).velocity);
}

TEST(PoseSpline, JoinsPosesAcrossTheLongestGap) {
  const double gap = seconds(PoseSpline::kMaxGap);
  const RigidMotion moved(Eigen::Translation3d(5, 0, 0));
  const PoseSpline spline({{at_second(0), RigidMotion::Identity()}, {at_second(gap), moved}});
  EXPECT_NEAR(state_at(spline, gap / 2).T_local_body.translation().x(), 2.5, 1e-9);
  EXPECT_NEAR(state_at(spline, gap / 2).velocity[3], 5 / gap, 1e-9);
}

TEST(PoseSpline, ExtrapolatesByTheVelocityAtTheEnds) {
  const PoseSpline spline({{at_second(0), RigidMotion::Identity()},
                           {at_second(0.1), RigidMotion(Eigen::Translation3d(1, 0, 0))},
                           {at_second(0.2), RigidMotion(Eigen::Translation3d(3, 0, 0))}});
  const double reach = seconds(PoseSpline::kMaxExtrapolation);
  EXPECT_NEAR(state_at(spline, -reach).T_local_body.translation().x(), -10 * reach, 1e-9);
  EXPECT_NEAR(state_at(spline, 0.2 + reach).T_local_body.translation().x(), 3 + 20 * reach, 1e-9);
  EXPECT_FALSE(spline.at(at_second(-reach) - 1));
  EXPECT_FALSE(spline.at(at_second(0.2 + reach) + 1));
}

TEST(PoseSpline, OnePoseIsNoCurve) {
  EXPECT_FALSE(PoseSpline({}).at(0));
  const StampedPose pose{at_second(0), smooth_motion(0), Twist(Twist::Ones())};
  EXPECT_FALSE(PoseSpline({pose}).at(pose.time));
  // A lone pose between two gaps.
  std::vector<StampedPose> poses = smooth_poses(3);
  poses.push_back({at_second(1), smooth_motion(1)});
  for (const double time : {2.0, 2.1}) poses.push_back({at_second(time), smooth_motion(time)});
  const PoseSpline spline(poses);
  EXPECT_FALSE(spline.at(at_second(1)));
  EXPECT_FALSE(spline.at(at_second(1.01)));
  EXPECT_TRUE(spline.at(at_second(2)));
}

// The curve takes the velocities from the poses, not from a device.
TEST(PoseSpline, IgnoresMeasuredVelocities) {
  std::vector<StampedPose> poses = smooth_poses(3);
  const PoseSpline plain(poses);
  for (StampedPose& pose : poses) pose.velocity = Twist::Constant(100);
  EXPECT_EQ(state_at(PoseSpline(poses), 0.13).velocity, state_at(plain, 0.13).velocity);
}

}  // namespace fovea::pose_spline_test
