#include "fovea/simulation/navigation_errors.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::navigation_errors_test {

constexpr double kPeriod = 0.1;

NavigationOptions exact() {
  NavigationOptions options;
  options.position_noise = options.position_walk = options.position_bias = 0;
  options.angle_noise = options.angle_walk = options.jump_rate = 0;
  options.velocity_noise = options.rate_noise = 0;
  return options;
}

std::vector<double> times(int count) {
  std::vector<double> result;
  for (int i = 0; i < count; ++i) result.push_back(i * kPeriod);
  return result;
}

/// Sum of squares of a sample that has n degrees of freedom and, in truth, this standard deviation:
/// its mean lies within five standard errors (sqrt(2 / n) for a normal).
void expect_deviation(double sum_of_squares, int n, double deviation) {
  const double variance = deviation * deviation;
  EXPECT_NEAR(sum_of_squares / n, variance, 5 * variance * std::sqrt(2.0 / n));
}

TEST(NavigationErrors, NoneIsExact) {
  for (const NavigationError& error : navigation_errors(times(500), exact(), 3)) {
    EXPECT_EQ(error.position, Eigen::Vector3d::Zero());
    EXPECT_EQ(error.angles, Eigen::Vector3d::Zero());
    EXPECT_EQ(error.velocity, Eigen::Vector3d::Zero());
    EXPECT_EQ(error.rate, Eigen::Vector3d::Zero());
    EXPECT_FALSE(error.outage);
    EXPECT_EQ(error.accuracy, 0);
  }
}

TEST(NavigationErrors, BiasIsConstantAndOfItsSize) {
  NavigationOptions options = exact();
  options.position_bias = 0.4;
  double squares = 0;
  constexpr int kSeeds = 2000;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const auto errors = navigation_errors(times(3), options, seed);
    EXPECT_EQ(errors[0].position, errors[2].position);
    squares += errors[0].position.squaredNorm();
  }
  expect_deviation(squares, 3 * kSeeds, 0.4);
}

TEST(NavigationErrors, WhiteNoiseIsOfItsSizeAndWhite) {
  NavigationOptions options = exact();
  options.position_noise = 0.01;
  options.angle_noise = 0.0002;
  options.velocity_noise = 0.02;
  options.rate_noise = 0.001;
  constexpr int n = 20'000;
  const auto errors = navigation_errors(times(n), options, 1);
  double position = 0, angles = 0, velocity = 0, rate = 0, neighbours = 0;
  for (int i = 0; i < n; ++i) {
    position += errors[i].position.squaredNorm();
    angles += errors[i].angles.squaredNorm();
    velocity += errors[i].velocity.squaredNorm();
    rate += errors[i].rate.squaredNorm();
    if (i > 0) neighbours += errors[i].position.dot(errors[i - 1].position);
  }
  expect_deviation(position, 3 * n, 0.01);
  expect_deviation(angles, 3 * n, 0.0002);
  expect_deviation(velocity, 3 * n, 0.02);
  expect_deviation(rate, 3 * n, 0.001);
  EXPECT_NEAR(neighbours / position, 0, 5 / std::sqrt(3.0 * n));
}

TEST(NavigationErrors, WalksGrowWithTheRootOfTime) {
  NavigationOptions options = exact();
  options.position_walk = 0.03;
  options.angle_walk = 0.0003;
  double early = 0, late = 0, angles = 0;
  constexpr int kSeeds = 500;
  for (int seed = 0; seed < kSeeds; ++seed) {
    const auto errors = navigation_errors(times(401), options, seed);
    early += errors[100].position.squaredNorm();
    late += errors[400].position.squaredNorm();
    angles += errors[400].angles.squaredNorm();
  }
  expect_deviation(early, 3 * kSeeds, 0.03 * std::sqrt(10.0));
  expect_deviation(late, 3 * kSeeds, 0.03 * std::sqrt(40.0));
  expect_deviation(angles, 3 * kSeeds, 0.0003 * std::sqrt(40.0));
}

TEST(NavigationErrors, JumpsComeAtTheirRateAndStay) {
  NavigationOptions options = exact();
  options.jump_rate = 0.02;
  options.jump_size = 0.4;
  constexpr int n = 200'000;  // 20,000 s: 400 jumps, give or take 20
  const auto errors = navigation_errors(times(n), options, 7);
  int jumps = 0;
  double squares = 0;
  for (int i = 1; i < n; ++i) {
    const Eigen::Vector3d step = errors[i].position - errors[i - 1].position;
    if (step.norm() > 0) ++jumps;
    squares += step.squaredNorm();
  }
  EXPECT_NEAR(jumps, 400, 100);
  expect_deviation(squares, 3 * jumps, 0.4);
}

TEST(NavigationErrors, OutagesDriftTenfoldAndPass) {
  NavigationOptions options = exact();
  options.position_walk = 0.03;
  options.outages = true;
  double inside = 0, outside = 0;
  int n_inside = 0, n_outside = 0;
  for (int seed = 0; seed < 50; ++seed) {
    const auto errors = navigation_errors(times(400), options, seed);
    int lost = 0;
    for (std::size_t i = 1; i < errors.size(); ++i) {
      const double step = (errors[i].position - errors[i - 1].position).squaredNorm();
      if (errors[i].outage) ++lost;
      if (errors[i].outage && errors[i - 1].outage) {
        inside += step;
        n_inside += 3;
        EXPECT_GT(errors[i].accuracy, errors[i - 1].accuracy);
      } else if (!errors[i].outage && !errors[i - 1].outage) {
        outside += step;
        n_outside += 3;
        EXPECT_EQ(errors[i].accuracy, 0);
      }
    }
    EXPECT_GE(lost, 2 * 39);  // two outages of 4 to 10 s in 40 s
    EXPECT_LE(lost, 2 * 101);
    bool early = false;  // also in a drive of 100 frames
    for (int i = 0; i < 100; ++i) early = early || errors[i].outage;
    EXPECT_TRUE(early) << seed;
  }
  expect_deviation(outside, n_outside, 0.03 * std::sqrt(kPeriod));
  expect_deviation(inside, n_inside, 0.03 * std::sqrt(101 * kPeriod));  // 10 x and the walk itself
}

TEST(NavigationErrors, InAnOutageTheVelocityDriftsToo) {
  NavigationOptions options = exact();
  options.velocity_noise = 0.02;
  options.outages = true;
  double steps = 0;
  int n = 0;
  for (int seed = 0; seed < 50; ++seed) {
    const auto errors = navigation_errors(times(400), options, seed);
    for (std::size_t i = 1; i < errors.size(); ++i) {
      if (!errors[i].outage || !errors[i - 1].outage) continue;
      steps += (errors[i].velocity - errors[i - 1].velocity).squaredNorm();
      n += 3;
    }
  }
  // White noise of two records, and the walk between them. Neighbouring steps share a record's: a
  // wider bound.
  const double variance = 0.02 * 0.02 * (2 + 25 * kPeriod);
  EXPECT_NEAR(steps / n, variance, 10 * variance * std::sqrt(2.0 / n));
}

TEST(NavigationErrors, DoNotDependOnWhatFollows) {
  NavigationOptions options;
  options.outages = true;
  options.jump_rate = 1;
  const auto few = navigation_errors(times(50), options, 4),
             many = navigation_errors(times(90), options, 4);
  const auto other = navigation_errors(times(50), options, 5);
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(few[i].position, many[i].position);
    EXPECT_EQ(few[i].angles, many[i].angles);
    EXPECT_NE(few[i].position, other[i].position);
  }
}

}  // namespace fovea::navigation_errors_test
