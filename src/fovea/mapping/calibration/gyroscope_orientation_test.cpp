#include "fovea/mapping/calibration/gyroscope_orientation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::gyroscope_orientation_test {

using Vector3 = Eigen::Vector3d;

/// Rates about z that increase by 2 rad/s^2, at 100 Hz, with an offset of the times.
std::vector<ImuSample> accelerating(int count) {
  std::vector<ImuSample> samples;
  for (int i = 0; i < count; ++i) {
    samples.push_back({kNsPerSecond + i * (kNsPerSecond / 100), {0, 0, 0.02 * i}, Vector3::Zero()});
  }
  return samples;
}

TEST(GyroscopeOrientation, IntegratesBetweenSamples) {
  const std::vector<ImuSample> samples = accelerating(100);
  const GyroscopeOrientation orientation(samples);
  const auto stamp = [](double time) { return kNsPerSecond + from_seconds(time); };
  const auto angle = [](double time) { return time * time; };
  for (const double begin : {0.0, 0.103, 0.5}) {
    for (const double end : {0.508, 0.71, 0.9}) {
      const Vector3 turn = orientation.turn(stamp(begin), stamp(end));
      EXPECT_LT((turn - Vector3(0, 0, angle(end) - angle(begin))).norm(), 1e-9);
    }
  }
  const GyroscopeOrientation scaled(samples, 0.5);
  EXPECT_NEAR(scaled.turn(stamp(0.1), stamp(0.503)).z(), (angle(0.503) - angle(0.1)) / 2, 1e-9);
}

TEST(GyroscopeOrientation, ComposesRotationsAboutSeveralAxes) {
  // A quarter turn about z, then one about x. The rate changes within a nanosecond.
  const double rate = std::acos(-1.0) / 2;
  const Vector3 about_z = rate * Vector3::UnitZ(), about_x = rate * Vector3::UnitX();
  const std::vector<ImuSample> samples{{0, about_z, Vector3::Zero()},
                                       {kNsPerSecond, about_z, Vector3::Zero()},
                                       {kNsPerSecond + 1, about_x, Vector3::Zero()},
                                       {2 * kNsPerSecond, about_x, Vector3::Zero()}};
  const GyroscopeOrientation orientation(samples);
  const Eigen::Quaterniond turned = orientation.at(2 * kNsPerSecond);
  EXPECT_LT((turned * Vector3::UnitX() - Vector3::UnitY()).norm(), 1e-6);
  EXPECT_LT((turned * Vector3::UnitY() - Vector3::UnitZ()).norm(), 1e-6);
}

TEST(GyroscopeOrientation, CoversNoGapsAndNothingOutside) {
  std::vector<ImuSample> samples = accelerating(100);
  samples.erase(samples.begin() + 40, samples.begin() + 45);
  const GyroscopeOrientation orientation(samples);
  const auto covers = [&](double begin, double end) {
    return orientation.covers(kNsPerSecond + from_seconds(begin), kNsPerSecond + from_seconds(end));
  };
  EXPECT_TRUE(covers(0, 0.39));
  EXPECT_TRUE(covers(0.45, 0.99));
  EXPECT_FALSE(covers(0.3, 0.395));
  EXPECT_FALSE(covers(0.42, 0.6));
  EXPECT_FALSE(covers(0.3, 0.6));
  EXPECT_FALSE(covers(-0.01, 0.1));
  EXPECT_FALSE(covers(0.9, 1));
  const std::vector<ImuSample> none;
  EXPECT_FALSE(GyroscopeOrientation(none).covers(0, 1));
  EXPECT_EQ(GyroscopeOrientation(none).turn(0, 1), Vector3::Zero());
}

}  // namespace fovea::gyroscope_orientation_test
