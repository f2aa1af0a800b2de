#include "fovea/mapping/calibration/imu_hand_eye.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "fovea/core/parallel.h"
#include "fovea/core/random.h"
#include "fovea/geometry/rotation_vector.h"

namespace fovea::imu_hand_eye_test {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Motion = std::function<Matrix3(double)>;  ///< R_world_lidar at a time (s)

constexpr TimeNs kStart = 1'700'000'000 * kNsPerSecond;

Matrix3 yaw_pitch_roll(double yaw, double pitch, double roll) {
  return rotation_of(yaw * Vector3::UnitZ()) * rotation_of(pitch * Vector3::UnitY()) *
         rotation_of(roll * Vector3::UnitX());
}

Matrix3 handheld(double t) {  // up to 100 deg/s
  return yaw_pitch_roll(0.8 * std::sin(1.3 * t) + 0.3 * std::sin(3.1 * t + 1),
                        0.4 * std::sin(1.7 * t + 2) + 0.1 * std::sin(4.3 * t),
                        0.4 * std::sin(2.1 * t + 0.5) + 0.12 * std::sin(3.7 * t + 2));
}

double heading(double t) { return 0.9 * std::sin(0.35 * t) + 0.25 * std::sin(0.9 * t); }
Matrix3 flat_vehicle(double t) { return yaw_pitch_roll(heading(t), 0, 0); }
Matrix3 vehicle(double t) {
  return yaw_pitch_roll(heading(t), 0.015 * std::sin(3 * t), 0.02 * std::sin(2.2 * t + 1));
}

struct Scene {
  Motion motion = handheld;
  double duration = 60;  // s
  double rate = 400;     // of samples, Hz
  double delay = 0;      // s
  Vector3 bias = {0.01, -0.012, 0.008};
  double rate_noise = 0;  // of a sample, rad/s
  double pose_noise = 0;  // of an orientation of a scan, rad
  double outliers = 0;    // share of turns
  double gap = 0;         // s without samples in each 5 s
  std::uint64_t seed = 1;
};

Scene noisy(const Motion& motion) {
  Scene scene;
  scene.motion = motion;
  scene.rate_noise = 1 * kDegree;
  scene.pose_noise = 0.1 * kDegree;
  scene.outliers = 0.05;
  return scene;
}

const Matrix3 kMount = rotation_of(Vector3(1.1, -0.7, 1.6));  ///< R_lidar_imu

struct Recording {
  std::vector<ScanTurn> turns;
  std::vector<ImuSample> samples;
};

Recording record(const Scene& scene) {
  Random random(scene.seed);
  const auto noise = [&](double sigma) {
    return Vector3(sigma * Vector3(random.normal(), random.normal(), random.normal()));
  };
  Recording recording;
  for (int i = 0; i < int((scene.duration + 1) * scene.rate); ++i) {
    const double stamp = i / scene.rate - 0.5, time = stamp + scene.delay;
    if (std::fmod(stamp + 1, 5) < scene.gap) continue;
    constexpr double kHalf = 1e-3;
    const Matrix3 turn = scene.motion(time - kHalf).transpose() * scene.motion(time + kHalf);
    const Vector3 rate = kMount.transpose() * rotation_vector(turn) / (2 * kHalf);
    recording.samples.push_back({kStart + from_seconds(stamp),
                                 rate + scene.bias + noise(scene.rate_noise), Vector3::Zero()});
  }
  Matrix3 last = scene.motion(0);
  for (int k = 0; k < int(scene.duration * 10); ++k) {
    const TimeNs begin = kStart + k * (kNsPerSecond / 10);
    const Matrix3 next = scene.motion((k + 1) * 0.1) * rotation_of(noise(scene.pose_noise));
    Matrix3 turn = last.transpose() * next;
    if (random.uniform() < scene.outliers) turn = rotation_of(noise(0.3)) * turn;
    recording.turns.push_back({begin, begin + kNsPerSecond / 10, rotation_vector(turn)});
    last = next;
  }
  return recording;
}

/// The present mount, which is wrong by an angle.
Matrix3 wrong_mount(double degrees) {
  return rotation_of(degrees * kDegree * Vector3(1, 2, -1).normalized()) * kMount;
}

ImuHandEye estimate(const Scene& scene, const Matrix3& R_lidar_imu) {
  const Recording recording = record(scene);
  return estimate_imu_hand_eye(recording.turns, recording.samples, R_lidar_imu);
}

/// Error of the corrected mount: a rotation about the axes of the LiDAR, rad.
Vector3 mount_error(const ImuHandEye& found, const Matrix3& R_lidar_imu) {
  return rotation_vector(Matrix3(kMount * (rotation_of(found.rotation) * R_lidar_imu).transpose()));
}

/// Expects errors within three standard deviations in about all trials, and that the standard
/// deviations are not too large.
void expect_honest(const std::vector<double>& normalized_errors) {
  double sum = 0;
  int large = 0;
  for (const double error : normalized_errors) {
    sum += error * error;
    if (std::abs(error) > 3) ++large;
  }
  EXPECT_LE(large, 1 + int(normalized_errors.size() / 100));
  const double rms = std::sqrt(sum / double(normalized_errors.size()));
  EXPECT_GT(rms, 0.5);
  EXPECT_LT(rms, 1.3);
}

TEST(ImuHandEye, FindsMountDelayAndBias) {
  for (const double degrees : {5, 30, 170}) {
    for (const double delay : {-0.1, 0.0, 0.1, 0.2}) {
      Scene scene;
      scene.duration = 20;
      scene.delay = delay;
      const Matrix3 R = wrong_mount(degrees);
      const ImuHandEye found = estimate(scene, R);
      EXPECT_TRUE(found.agrees && found.rotation_observable() && found.delay_observable);
      EXPECT_LT(mount_error(found, R).norm(), 1e-3 * kDegree);
      EXPECT_NEAR(found.delay, delay, 1e-5);
      EXPECT_LT((found.gyroscope_bias - scene.bias).norm(), 1e-3 * kDegree);
      EXPECT_NEAR(found.turn_ratio, 1, 0.1);
      EXPECT_EQ(missing_motion(found), "");
    }
  }
}

TEST(ImuHandEye, HasHonestErrorsInHand) {
  std::vector<double> rotations, delays, biases;
  for (const double duration : {60, 20}) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
      Scene scene = noisy(handheld);
      scene.pose_noise = (seed % 2 == 0 ? 0.05 : 0.2) * kDegree;
      scene.duration = duration;
      scene.delay = 0.1;
      scene.gap = seed % 4 < 2 ? 0 : 0.3;
      scene.rate = seed % 8 < 4 ? 400 : 100;
      scene.seed = seed;
      const Matrix3 R = wrong_mount(30);
      const ImuHandEye found = estimate(scene, R);
      ASSERT_TRUE(found.agrees && found.rotation_observable() && found.delay_observable);
      const Vector3 error = mount_error(found, R);
      EXPECT_LT(error.norm(), (duration > 20 ? 0.2 : 0.5) * kDegree);
      for (int i = 0; i < 3; ++i) {
        rotations.push_back(found.directions.col(i).dot(error) / found.direction_sigma[i]);
        biases.push_back((found.gyroscope_bias - scene.bias)[i] / found.gyroscope_bias_sigma[i]);
      }
      delays.push_back((found.delay - scene.delay) / found.delay_sigma);
      EXPECT_LT(found.delay_sigma, 0.001);
    }
  }
  expect_honest(rotations);
  expect_honest(delays);
  expect_honest(biases);
}

TEST(ImuHandEye, LeavesTheYawOfAVehiclesMount) {
  std::vector<double> tilts, delays;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Scene scene = noisy(flat_vehicle);
    scene.pose_noise = 0.05 * kDegree;
    scene.duration = 120;
    scene.delay = -0.1;
    scene.seed = seed;
    const Matrix3 R = wrong_mount(30);
    const ImuHandEye found = estimate(scene, R);
    ASSERT_TRUE(found.agrees && found.delay_observable);
    ASSERT_EQ(found.observable_directions, 2);
    EXPECT_GT(std::abs(found.directions(2, 2)), 0.9999);
    EXPECT_NEAR(found.rotation.dot(found.directions.col(2)), 0, 1e-9);
    EXPECT_GT(found.direction_sigma[2], 1 * kDegree);
    EXPECT_EQ(missing_motion(found), "turn about another axis than (0.00 0.00 1.00) of the LiDAR");
    const Vector3 error = mount_error(found, R);  // nearly a rotation about z
    EXPECT_GT(std::abs(error.z()), 5 * kDegree);
    EXPECT_LT(error.head<2>().norm(), 0.2 * kDegree);
    for (int i = 0; i < 2; ++i) {
      tilts.push_back(found.directions.col(i).dot(error) / found.direction_sigma[i]);
    }
    delays.push_back((found.delay - scene.delay) / found.delay_sigma);
  }
  expect_honest(tilts);
  expect_honest(delays);
}

TEST(ImuHandEye, FindsTheYawFromRollAndPitch) {
  Scene scene = noisy(vehicle);
  scene.duration = 300;
  scene.delay = 0.1;
  const Matrix3 R = wrong_mount(5);
  const ImuHandEye found = estimate(scene, R);
  EXPECT_TRUE(found.agrees && found.rotation_observable() && found.delay_observable);
  EXPECT_LT(mount_error(found, R).norm(), 0.5 * kDegree);
  EXPECT_NEAR(found.delay, 0.1, 3 * found.delay_sigma);
  EXPECT_GT(found.rotation_sigma().z(), 2 * found.rotation_sigma().x());
}

TEST(ImuHandEye, ReportsWrongUnits) {
  for (const auto& motion : {handheld, vehicle}) {
    for (const double factor : {1 / kDegree, kDegree, 0.0}) {
      Recording recording = record(noisy(motion));
      for (ImuSample& sample : recording.samples) sample.rate *= factor;
      const ImuHandEye found = estimate_imu_hand_eye(recording.turns, recording.samples, kMount);
      EXPECT_FALSE(found.agrees);
      EXPECT_FALSE(found.mirrored);
      EXPECT_NEAR(found.turn_ratio, factor, 0.15 * factor);
      EXPECT_EQ(found.rotation, Vector3::Zero());
      EXPECT_EQ(found.observable_directions, 0);
      EXPECT_FALSE(found.delay_observable);
    }
  }
}

TEST(ImuHandEye, ReportsAMirroredAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    Recording recording = record(noisy(handheld));
    for (ImuSample& sample : recording.samples) sample.rate[axis] *= -1;
    const ImuHandEye found = estimate_imu_hand_eye(recording.turns, recording.samples, kMount);
    EXPECT_FALSE(found.agrees);
    EXPECT_TRUE(found.mirrored);
    EXPECT_NEAR(found.turn_ratio, 1, 0.1);
  }
}

TEST(ImuHandEye, ReportsAnotherClock) {
  Recording recording = record(noisy(handheld));
  for (ImuSample& sample : recording.samples) sample.time += 11 * kNsPerSecond;
  const ImuHandEye found = estimate_imu_hand_eye(recording.turns, recording.samples, kMount);
  EXPECT_FALSE(found.agrees);
  EXPECT_FALSE(found.mirrored);
  EXPECT_EQ(missing_motion(found), "");
}

TEST(ImuHandEye, ObservesNothingWithoutMotion) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Scene scene = noisy([](double) { return Matrix3(Matrix3::Identity()); });
    scene.pose_noise = 0.2 * kDegree;
    scene.seed = seed;
    const ImuHandEye found = estimate(scene, wrong_mount(30));
    EXPECT_TRUE(found.agrees);
    EXPECT_EQ(found.moving_turns, 0);
    EXPECT_EQ(found.observable_directions, 0);
    EXPECT_FALSE(found.delay_observable);
    EXPECT_EQ(found.rotation, Vector3::Zero());
    EXPECT_EQ(found.delay, 0);
    EXPECT_LT((found.gyroscope_bias - scene.bias).norm(), 0.3 * kDegree);
    EXPECT_EQ(missing_motion(found), "turn about several axes, faster and slower");
  }
}

TEST(ImuHandEye, ObservesNothingInAConstantTurn) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Scene scene = noisy([](double t) { return yaw_pitch_roll(0.5 * t, 0, 0); });
    scene.seed = seed;
    const ImuHandEye found = estimate(scene, wrong_mount(5));
    EXPECT_TRUE(found.agrees);
    EXPECT_EQ(found.observable_directions, 0);  // a tilt of the mount looks like a bias
    EXPECT_FALSE(found.delay_observable);
    EXPECT_EQ(found.delay, 0);
    EXPECT_NE(missing_motion(found).find("faster and slower"), std::string::npos);
  }
}

TEST(ImuHandEye, NeedsTurnsAndSamples) {
  Recording recording = record(Scene{});
  const std::vector<ScanTurn> few(recording.turns.begin(), recording.turns.begin() + 9);
  for (const auto& found : {estimate_imu_hand_eye(few, recording.samples, kMount),
                            estimate_imu_hand_eye({}, recording.samples, kMount),
                            estimate_imu_hand_eye(recording.turns, {}, kMount),
                            estimate_imu_hand_eye(recording.turns, {{kStart, {}, {}}}, kMount)}) {
    EXPECT_TRUE(found.agrees);
    EXPECT_LT(found.moving_turns, 10);
    EXPECT_EQ(found.observable_directions, 0);
    EXPECT_FALSE(found.delay_observable);
    EXPECT_TRUE(found.rotation_covariance.allFinite());
  }
}

TEST(ImuHandEye, DependsOnNeitherThreadsNorOrder) {
  Recording recording = record(noisy(handheld));
  const ImuHandEye found = estimate_imu_hand_eye(recording.turns, recording.samples, kMount);
  std::reverse(recording.turns.begin(), recording.turns.end());
  const ThreadLimit limit(1);
  const ImuHandEye again = estimate_imu_hand_eye(recording.turns, recording.samples, kMount);
  EXPECT_EQ(found.rotation, again.rotation);
  EXPECT_EQ(found.delay, again.delay);
  EXPECT_EQ(found.rotation_covariance, again.rotation_covariance);
}

}  // namespace fovea::imu_hand_eye_test
