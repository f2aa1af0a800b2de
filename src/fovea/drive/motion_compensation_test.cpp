#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <numbers>
#include <stdexcept>

#include "fovea/core/parallel.h"
#include "fovea/core/random.h"
#include "fovea/deskew.h"

namespace fovea::motion_compensation_test {

constexpr double kPeriod = 0.1;
const SweepTiming kKitti{.period = kPeriod};

Twist twist(std::initializer_list<double> values) {
  Twist result;
  std::copy(values.begin(), values.end(), result.data());
  return result;
}

Eigen::Vector3f compensated(const Eigen::Vector3f& p, const Twist& velocity) {
  PointCloud scan;
  scan.position = {p};
  compensate_sweep(scan, {velocity}, kKitti);
  return scan.position[0];
}

TEST(MotionCompensation, SweepTurnsClockwiseAndFacesForwardAtTheStamp) {
  const Twist forward = twist({0, 0, 0, 10, 0, 0});
  // Ahead: measured at the stamp. Left: a quarter turn earlier, since then the car went 0.25 m on.
  EXPECT_LT((compensated({8, 0, 1}, forward) - Eigen::Vector3f(8, 0, 1)).norm(), 1e-6f);
  EXPECT_LT((compensated({0, 5, 1}, forward) - Eigen::Vector3f(-0.25f, 5, 1)).norm(), 1e-6f);
  EXPECT_LT((compensated({0, -5, 1}, forward) - Eigen::Vector3f(0.25f, -5, 1)).norm(), 1e-6f);
  // Behind the sweep begins and ends: half a period either way.
  EXPECT_NEAR(compensated({-5, 1e-6f, 0}, forward).x(), -5.5, 1e-5);
  EXPECT_NEAR(compensated({-5, -1e-6f, 0}, forward).x(), -4.5, 1e-5);
  // Straight above there is no azimuth.
  EXPECT_EQ(compensated({0, 0, 3}, forward), Eigen::Vector3f(0, 0, 3));
}

/// Seconds from the stamp at which the sweep measured a point ahead, left, behind (just left of it)
/// and right, by how far the vehicle was from its place at the stamp.
std::array<double, 4> times_of(const SweepTiming& sweep) {
  std::array<double, 4> times{};
  const std::array<Eigen::Vector3f, 4> points{
      {{5, 1e-6f, 0}, {-1e-6f, 5, 0}, {-5, 1e-6f, 0}, {1e-6f, -5, 0}}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    PointCloud scan;
    scan.position = {points[i]};
    compensate_sweep(scan, {twist({0, 0, 0, 0, 0, 10})}, sweep);
    times[i] = double(scan.position[0].z()) / 10;
  }
  return times;
}

void expect_times(const SweepTiming& sweep, const std::array<double, 4>& expected) {
  const std::array<double, 4> times = times_of(sweep);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(times[i], expected[i], 1e-5) << i;
}

TEST(MotionCompensation, EveryPartOfTheTimingCounts) {
  using enum SweepDirection;
  const double pi = std::numbers::pi;
  expect_times({0.1}, {0, -0.025, -0.05, 0.025});
  expect_times({0.2}, {0, -0.05, -0.1, 0.05});
  // The same sensor, seen against its axis: the sweep begins just right of behind.
  expect_times({0.1, kCounterclockwise, pi}, {0, 0.025, 0.05, -0.025});
  // Stamped at its start, or at its end.
  expect_times({0.1, kClockwise, pi, 0}, {0.05, 0.025, 0, 0.075});
  expect_times({0.1, kClockwise, pi, 1}, {-0.05, -0.075, -0.1, -0.025});
  // From the left: ahead after a quarter.
  expect_times({0.1, kClockwise, pi / 2 + 1e-4, 0}, {0.025, 0, 0.075, 0.05});
  expect_times({0.1, kCounterclockwise, pi / 2 - 1e-4, 0}, {0.075, 0, 0.025, 0.05});
  expect_times({0.1, kCounterclockwise, -3 * pi / 2 - 1e-4, 0}, {0.075, 0, 0.025, 0.05});
}

TEST(MotionCompensation, AnUpsideDownSensorNeedsNoOtherTiming) {
  // The sensor hangs upside down, turned about its x axis: its points and its motion are given in
  // its own axes, in which it turns as ever.
  const Eigen::AngleAxisf turned(std::numbers::pi_v<float>, Eigen::Vector3f::UnitX());
  const Twist forward = twist({0, 0, 0, 10, 0, 0});
  const Eigen::Vector3f left_of_the_vehicle = turned * Eigen::Vector3f(0, 5, 1);
  EXPECT_LT((compensated(left_of_the_vehicle, forward) - Eigen::Vector3f(0.25f, -5, -1)).norm(),
            1e-5f);
}

TEST(MotionCompensation, EqualsTheExponentialOfTheTwist) {
  Random random(5);
  for (const Twist& velocity : {twist({0, 0, 0, 0, 0, 0}), twist({0, 0, 1.5, 12, 0.3, -0.1}),
                                twist({0.4, -0.2, 0.1, 5, 1, 2}), twist({1e-7, 0, -1e-7, 30, 0, 0}),
                                twist({3, -2, 8, 5, 1, 2})}) {  // whirled round by hand
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3f p(
          Eigen::Vector3d(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-2, 5))
              .cast<float>());
      const double azimuth = std::atan2(double(p.y()), double(p.x()));
      const double dt = -azimuth / (2 * std::numbers::pi) * kPeriod;
      const Eigen::Vector3d expected = exp_se3(dt * velocity) * p.cast<double>();
      EXPECT_LT((compensated(p, velocity).cast<double>() - expected).norm(), 2e-5);
    }
  }
}

/// Where a body is, dt after a moment, by small steps.
RigidMotion integrated(const SweepMotion& motion, double dt) {
  constexpr int kSteps = 1000;
  RigidMotion T = RigidMotion::Identity();
  for (int i = 0; i < kSteps; ++i) {
    const double middle = dt * (i + 0.5) / kSteps;
    T = T * exp_se3(dt / kSteps * (motion.velocity + middle * motion.acceleration));
  }
  return T;
}

TEST(MotionCompensation, FollowsABendThatBegins) {
  // Into a bend within a second, while braking: steady motion would be 10 cm off at 50 m.
  const SweepMotion motion{twist({0.05, -0.02, 0.6, 9, 0.3, 0.1}),
                           twist({0.2, -0.3, 1.6, -8, 2, 0.5})};
  Random random(7);
  double farthest = 0;
  for (int i = 0; i < 200; ++i) {
    PointCloud one;
    const Eigen::Vector3d p(random.uniform(-50, 50), random.uniform(-50, 50),
                            random.uniform(-2, 5));
    const double dt = random.uniform(-0.05, 0.05);
    one.position = {p.cast<float>()};
    one.normal = {Eigen::Vector3f::UnitY()};
    one.time = {float(dt)};
    PointCloud steady = one;
    compensate_sweep(one, motion, kKitti);
    compensate_sweep(steady, {motion.velocity}, kKitti);
    const RigidMotion T = integrated(motion, dt);
    EXPECT_LT((one.position[0].cast<double>() - T * p).norm(), 5e-4);
    EXPECT_LT((one.normal[0] - (T.linear() * Eigen::Vector3d::UnitY()).cast<float>()).norm(),
              1e-5f);
    farthest = std::max(farthest, (steady.position[0].cast<double>() - T * p).norm());
  }
  EXPECT_GT(farthest, 0.08);
}

TEST(MotionCompensation, TimesOfThePointsCountWhereThereAreAny) {
  const Twist velocity = twist({0.4, -0.2, 1.1, 12, 1, 2});
  Random random(6);
  PointCloud scan;
  for (int i = 0; i < 200; ++i) {
    scan.position.push_back(
        Eigen::Vector3d(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-2, 5))
            .cast<float>());
    scan.time.push_back(static_cast<float>(random.uniform(0, 0.1)));
  }
  const PointCloud measured = scan;
  compensate_sweep(scan, {velocity}, kKitti);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3d expected =
        exp_se3(double(measured.time[i]) * velocity) * measured.position[i].cast<double>();
    EXPECT_LT((scan.position[i].cast<double>() - expected).norm(), 2e-5);
  }
  // They are of the points as measured: nobody may compensate twice by them.
  EXPECT_TRUE(scan.time.empty());
  EXPECT_NO_THROW(scan.check());
}

/// Points of a wall, n * x = d in the frame of the stamp, as a turning and driving LiDAR sees them.
PointCloud scan_wall(const Eigen::Vector3d& n, double d, const Twist& velocity) {
  PointCloud scan;
  for (double azimuth = -1.2; azimuth <= 1.2; azimuth += 0.01) {
    const double dt = -azimuth / (2 * std::numbers::pi) * kPeriod;
    const RigidMotion T_stamp_now = exp_se3(dt * velocity);
    const Eigen::Vector3d ray(std::cos(azimuth), std::sin(azimuth), 0.05);
    const double range =
        (d - n.dot(T_stamp_now.translation())) / n.dot(T_stamp_now.rotation() * ray);
    scan.position.emplace_back((range * ray).cast<float>());
    scan.normal.emplace_back((-T_stamp_now.rotation().transpose() * n).cast<float>());
  }
  return scan;
}

TEST(MotionCompensation, StraightensAWallSeenFromACarInACurve) {
  const Twist velocity = twist({0, 0, 0.5, 10, 0.2, 0});
  const Eigen::Vector3d n(1, 0, 0);
  PointCloud wall = scan_wall(n, 12, velocity);
  const auto worst = [&] {
    double result = 0;
    for (const auto& p : wall.position) {
      result = std::max(result, std::abs(n.dot(p.cast<double>()) - 12));
    }
    return result;
  };
  EXPECT_GT(worst(), 0.2);
  compensate_sweep(wall, {velocity}, kKitti);
  EXPECT_LT(worst(), 1e-4);
  for (const auto& normal : wall.normal) EXPECT_LT((normal + n.cast<float>()).norm(), 1e-6f);
}

TEST(MotionCompensation, SameAtAnyNumberOfThreads) {
  Random random(9);
  PointCloud one;
  for (int i = 0; i < 50'000; ++i) {
    one.position.emplace_back(random.uniform(-50, 50), random.uniform(-50, 50), 0.f);
  }
  PointCloud many = one;
  const Twist velocity = twist({0.1, 0, 0.5, 10, 0, 0});
  {
    const ThreadLimit limit(1);
    compensate_sweep(one, {velocity}, kKitti);
  }
  compensate_sweep(many, {velocity}, kKitti);
  EXPECT_EQ(one.position, many.position);
}

TEST(MotionCompensation, EmptyScanAndForeignOrigin) {
  PointCloud scan;
  compensate_sweep(scan, {twist({0, 0, 1, 10, 0, 0})}, kKitti);
  EXPECT_TRUE(scan.empty());
  scan.origin.x() = 1;
  EXPECT_THROW(compensate_sweep(scan, SweepMotion(), kKitti), std::invalid_argument);
}

// A path tells the same motion as its velocity, also for normals and at any number of threads.
TEST(MotionCompensation, AlongAPath) {
  const Twist velocity = twist({0.3, -0.2, 6, 8, 1, -0.5});
  SweepMotion by_path{velocity};
  by_path.path = SweepPath{-0.055, 0.005, {}};
  for (int i = 0; i <= 22; ++i) {
    const RigidMotion T = exp_se3((-0.055 + 0.005 * i) * velocity);
    const Eigen::AngleAxisd turn(T.linear());
    by_path.path->placements.emplace_back() << turn.angle() * turn.axis(), T.translation();
  }
  Random random(5);
  PointCloud scan;
  for (int i = 0; i < 20'000; ++i) {
    scan.position.emplace_back(random.uniform(-40, 40), random.uniform(-40, 40),
                               random.uniform(-3, 3));
    scan.normal.emplace_back(0.f, 0.6f, 0.8f);
  }
  PointCloud expected = scan, actual = scan;
  compensate_sweep(expected, {velocity}, kKitti);
  compensate_sweep(actual, by_path, kKitti);
  for (std::size_t i = 0; i < scan.size(); ++i) {
    EXPECT_LT((actual.position[i] - expected.position[i]).norm(), 2e-3f) << i;
    EXPECT_LT((actual.normal[i] - expected.normal[i]).norm(), 1e-4f) << i;
  }
  const ThreadLimit limit(1);
  PointCloud alone = scan;
  compensate_sweep(alone, by_path, kKitti);
  EXPECT_EQ(alone.position, actual.position);
}

}  // namespace fovea::motion_compensation_test
