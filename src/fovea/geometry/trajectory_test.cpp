#include "fovea/trajectory.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace fovea::trajectory_test {

RigidMotion at_x(double x) { return RigidMotion(Eigen::Translation3d(x, 0, 0)); }

/// 10 m/s along x in the first second, 20 m/s in the second, 5 m/s in the third.
Trajectory stop_and_go() {
  return Trajectory({{0, at_x(0)},
                     {kNsPerSecond, at_x(10)},
                     {2 * kNsPerSecond, at_x(30)},
                     {3 * kNsPerSecond, at_x(35)}});
}

double x_at(const Trajectory& trajectory, double time) {
  return trajectory.at(from_seconds(time)).value().translation().x();
}

double speed(const Trajectory& trajectory, double time, double known_until) {
  return trajectory.motion(from_seconds(time), from_seconds(known_until)).value().velocity[3];
}

TEST(Trajectory, InterpolatesBetweenNeighbours) {
  const Trajectory trajectory = stop_and_go();
  EXPECT_NEAR(x_at(trajectory, 0), 0, 1e-12);
  EXPECT_NEAR(x_at(trajectory, 0.25), 2.5, 1e-12);
  EXPECT_NEAR(x_at(trajectory, 1), 10, 1e-12);
  EXPECT_NEAR(x_at(trajectory, 1.5), 20, 1e-12);
  EXPECT_NEAR(x_at(trajectory, 3), 35, 1e-12);
}

TEST(Trajectory, FollowsAnArc) {
  // Half a turn to the left in a second: at half time a quarter turn, on the circle.
  Twist turn;
  turn << 0, 0, 3.0, 30.0, 0, 0;
  const Trajectory trajectory({{0, RigidMotion::Identity()}, {kNsPerSecond, exp_se3(turn)}});
  EXPECT_TRUE(trajectory.at(kNsPerSecond / 2)->isApprox(exp_se3(0.5 * turn), 1e-12));
  EXPECT_NEAR((trajectory.at(kNsPerSecond / 3)->translation() - Eigen::Vector3d(0, 10, 0)).norm(),
              10, 1e-12);
  EXPECT_TRUE(trajectory.motion(kNsPerSecond / 2, kNsPerSecond)->velocity.isApprox(turn, 1e-12));
}

TEST(Trajectory, ExtrapolatesByTheVelocityOfTheEndForAFifthOfASecond) {
  const Trajectory trajectory = stop_and_go();
  EXPECT_NEAR(x_at(trajectory, -0.2), -2, 1e-12);
  EXPECT_NEAR(x_at(trajectory, 3.2), 36, 1e-12);
  EXPECT_FALSE(trajectory.at(from_seconds(-0.2) - 1));
  EXPECT_FALSE(trajectory.at(from_seconds(3.2) + 1));
}

TEST(Trajectory, KeepsNanosecondsAtEpochTimes) {
  constexpr TimeNs kStart = 1'317'042'504'957'314'930;  // a double would round it by 128 ns
  const Trajectory trajectory({{kStart, at_x(0)}, {kStart + 1000, at_x(1000)}});
  EXPECT_NEAR(trajectory.at(kStart + 1)->translation().x(), 1, 1e-9);
}

TEST(Trajectory, BridgesNoOutage) {
  const Trajectory trajectory({{0, at_x(0)},
                               {kNsPerSecond, at_x(1)},
                               {11 * kNsPerSecond, at_x(50)},
                               {12 * kNsPerSecond, at_x(52)}});
  EXPECT_TRUE(trajectory.at(kNsPerSecond));
  EXPECT_TRUE(trajectory.at(11 * kNsPerSecond));
  // Near a pose, the velocity on its side of the outage counts.
  EXPECT_NEAR(x_at(trajectory, 1.2), 1.2, 1e-12);
  EXPECT_NEAR(x_at(trajectory, 10.8), 49.6, 1e-12);
  EXPECT_FALSE(trajectory.at(from_seconds(1.2) + 1));
  EXPECT_FALSE(trajectory.at(from_seconds(10.8) - 1));
  EXPECT_FALSE(trajectory.motion(6 * kNsPerSecond, 20 * kNsPerSecond));
  EXPECT_NEAR(speed(trajectory, 12, 12.05), 2, 1e-12);
  EXPECT_NEAR(speed(trajectory, 11, 11.05), 2, 1e-12);  // the first two poses after the outage
}

TEST(Trajectory, APoseBetweenTwoOutagesNeedsAVelocity) {
  Twist velocity = Twist::Zero();
  velocity[3] = 10;
  const auto isolated = [&](std::optional<Twist> measured) {
    return Trajectory(
        {{0, at_x(0)}, {5 * kNsPerSecond, at_x(50), measured}, {10 * kNsPerSecond, at_x(100)}});
  };
  EXPECT_NEAR(x_at(isolated(velocity), 5.1), 51, 1e-12);
  EXPECT_NEAR(x_at(isolated(velocity), 4.9), 49, 1e-12);
  EXPECT_FALSE(isolated(velocity).at(from_seconds(5.3)));
  EXPECT_FALSE(isolated(std::nullopt).at(from_seconds(5.1)));
  EXPECT_TRUE(isolated(std::nullopt).at(from_seconds(5)));
}

TEST(Trajectory, SinglePoseHoldsWithoutVelocity) {
  const Trajectory trajectory({{kNsPerSecond, at_x(7)}});
  EXPECT_EQ(x_at(trajectory, 1.1), 7);
  EXPECT_FALSE(trajectory.at(from_seconds(1.3)));
  EXPECT_FALSE(trajectory.motion(kNsPerSecond, 2 * kNsPerSecond));
  EXPECT_FALSE(Trajectory().at(0));
}

TEST(Trajectory, VelocityIsThatAroundTheTimeAsFarAsItIsKnown) {
  const Trajectory trajectory = stop_and_go();
  EXPECT_NEAR(speed(trajectory, 1.96, 2.01), 20, 1e-12);  // the pair around the time
  EXPECT_NEAR(speed(trajectory, 1.5, 1.9), 10, 1e-12);    // the pose at 2 s is still to come
  EXPECT_NEAR(speed(trajectory, 1.5, 2), 20, 1e-12);
  EXPECT_NEAR(speed(trajectory, 2.9, 2.9), 20, 1e-12);
  EXPECT_NEAR(speed(trajectory, 4, 4), 5, 1e-12);
  EXPECT_FALSE(trajectory.motion(from_seconds(4) + 1, from_seconds(9)));
  EXPECT_NEAR(speed(trajectory, 0.5, 0.5), 10, 1e-12);  // too early for two: the first two
  EXPECT_NEAR(speed(trajectory, -1, -1), 10, 1e-12);
}

TEST(Trajectory, FrequentPosesDoNotDivideTheirNoiseByAMoment) {
  // 100 poses a second at 10 m/s, 1 cm too far and 1 cm too near in turn.
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 100; ++i) {
    poses.push_back({i * kNsPerSecond / 100, at_x(0.1 * i + (i % 2 == 0 ? 0.01 : -0.01))});
  }
  const Trajectory trajectory(poses);
  EXPECT_NEAR(speed(trajectory, 0.5, 0.55), 10, 0.26);  // 0.8 m in 0.08 s, 2 cm off
  EXPECT_NEAR(speed(trajectory, 0.5, 0.5), 10, 2.001);
}

TEST(Trajectory, AMotionThatEndsNowHasASpanToo) {
  // 10 m/s at 100 Hz, each position a centimeter off, to one side and the other.
  std::vector<StampedPose> poses, measured;
  for (int i = 0; i <= 100; ++i) {
    const RigidMotion T = at_x(0.1 * i + (i % 2 == 0 ? 0.01 : -0.01));
    poses.push_back({i * kNsPerSecond / 100, T});
    Twist velocity = Twist::Zero();
    velocity[3] = i % 2 == 0 ? 9.9 : 10.1;
    measured.push_back({i * kNsPerSecond / 100, T, velocity});
  }
  // Between neighbors it would be 8 or 12 m/s.
  EXPECT_NEAR(speed(Trajectory(poses), 0.5, 0.5), 10, 1);
  EXPECT_NEAR(speed(Trajectory(measured), 0.5, 0.5), 10, 0.1);
}

TEST(Trajectory, AMeasuredVelocityIsBetterThanDifferences) {
  Twist fast = Twist::Zero(), faster = Twist::Zero();
  fast[3] = 8;
  faster[3] = 9;
  std::vector<StampedPose> poses = stop_and_go().poses();  // its poses differ by 10, 20 and 5 m
  poses[1].velocity = fast;
  poses[2].velocity = faster;
  const Trajectory trajectory(poses);
  EXPECT_NEAR(speed(trajectory, 1.02, 1.07), 8, 1e-12);
  EXPECT_NEAR(speed(trajectory, 1.5, 2), 8.5, 1e-12);    // the mean of both
  EXPECT_NEAR(speed(trajectory, 1.5, 1.99), 10, 1e-12);  // neither is near enough
  EXPECT_NEAR(speed(trajectory, 3, 3.05), 5, 1e-12);     // not measured there
  EXPECT_NEAR(speed(Trajectory({poses[1]}), 1, 1.05), 8, 1e-12);
}

/// A body whose velocity changes steadily, measured so often, `late` after a multiple of the
/// period.
Trajectory accelerating(double rate, double late, const Twist& velocity, const Twist& change) {
  std::vector<StampedPose> poses;
  for (int i = 0; i <= 2 * rate; ++i) {
    const double time = i / rate + late;
    poses.push_back({from_seconds(time), at_x(time), Twist(velocity + time * change)});
  }
  return Trajectory(poses);
}

TEST(Trajectory, TheMotionIsThatOfTheTimeNotOfTheMeasurements) {
  Twist velocity, change;
  velocity << 0.1, 0, 0.4, 9, 0.2, 0;
  change << 0.2, -0.1, 0.8, -4, 1, 0.1;
  for (const double rate : {10.0, 100.0}) {
    for (const double late : {0.0, 0.012, 0.034}) {
      const auto motion = accelerating(rate, late, velocity, change)
                              .motion(kNsPerSecond, kNsPerSecond + kNsPerSecond / 20);
      ASSERT_TRUE(motion);
      EXPECT_LT((motion->velocity - velocity - change).norm(), 1e-6) << rate << ' ' << late;
      EXPECT_LT((motion->acceleration - change).norm(), 1e-6) << rate << ' ' << late;
    }
  }
}

TEST(Trajectory, ChangesThatNobodyMeasuredAreNone) {
  Twist change = Twist::Zero();
  change[3] = 30;  // m/s^2: what was measured is wrong
  const TimeNs now = kNsPerSecond, known = now + kNsPerSecond / 20;
  const auto absurd = accelerating(10, 0.02, Twist::Zero(), change).motion(now, known);
  EXPECT_NEAR(absurd->velocity[3], 30 * 1.02, 1e-9);
  EXPECT_EQ(absurd->acceleration, Twist::Zero());
  change << 0, 0, 4, 0, 0, 0;  // rad/s^2
  EXPECT_EQ(accelerating(10, 0.02, Twist::Zero(), change).motion(now, known)->acceleration,
            Twist::Zero());
  // Once a second: nothing was measured just before.
  change << 0, 0, 0, 3, 0, 0;
  const auto seldom = accelerating(1, 0.02, Twist::Zero(), change).motion(now, known);
  EXPECT_NEAR(seldom->velocity[3], 3.06, 1e-9);
  EXPECT_EQ(seldom->acceleration, Twist::Zero());
  // Two measurements 10 ms apart, one of which is just out of reach.
  std::vector<StampedPose> close = {{from_seconds(0.945), at_x(0), Twist::Zero()},
                                    {from_seconds(0.955), at_x(0.1), Twist::Constant(0.1)}};
  const auto motion = Trajectory(close).motion(now, known);
  EXPECT_EQ(motion->velocity, Twist::Constant(0.1));
  EXPECT_EQ(motion->acceleration, Twist::Zero());
}

TEST(Trajectory, AFrozenPoseHasNoVelocity) {
  std::vector<StampedPose> poses = {{0, at_x(0)}, {kNsPerSecond, at_x(8)}};
  for (StampedPose& pose : poses) pose.velocity = Twist::Ones();
  poses.push_back(poses.back());
  poses.back().time = 2 * kNsPerSecond;
  const Trajectory trajectory(poses);
  EXPECT_TRUE(trajectory.poses()[0].velocity);
  EXPECT_TRUE(trajectory.poses()[1].velocity);
  EXPECT_FALSE(trajectory.poses()[2].velocity);
  EXPECT_NEAR(speed(trajectory, 2, 2.05), 0, 1e-12);
}

TEST(Trajectory, GrowsAndForgets) {
  Trajectory grown({{0, at_x(0)}, {kNsPerSecond / 2, at_x(1)}});
  grown.extend({{kNsPerSecond, at_x(2)}, {2 * kNsPerSecond, at_x(5)}});
  EXPECT_NEAR(grown.at(from_seconds(1.5))->translation().x(), 3.5, 1e-12);
  EXPECT_THROW(grown.extend({{2 * kNsPerSecond, at_x(5)}}), std::invalid_argument);
  EXPECT_EQ(grown.drop_before(kNsPerSecond), 2u);
  EXPECT_EQ(grown.poses().size(), 2u);
  EXPECT_NEAR(grown.at(from_seconds(1.5))->translation().x(), 3.5, 1e-12);
  EXPECT_EQ(grown.drop_before(9 * kNsPerSecond), 1u);  // the last one stays
  EXPECT_EQ(grown.poses().size(), 1u);
}

TEST(Trajectory, RejectsTimesThatDoNotIncrease) {
  EXPECT_THROW(Trajectory(std::vector<StampedPose>{}), std::invalid_argument);
  EXPECT_THROW(Trajectory({{5, at_x(0)}, {5, at_x(1)}}), std::invalid_argument);
  EXPECT_THROW(Trajectory({{5, at_x(0)}, {4, at_x(1)}}), std::invalid_argument);
}

}  // namespace fovea::trajectory_test
