#include "fovea/mapping/calibration/calibration_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fovea/core/angle.h"
#include "fovea/core/parallel.h"
#include "fovea/core/random.h"

namespace fovea::calibration_estimate_test {

struct Drive {
  int frames = 20, edges = 100;  ///< a frame
  double speed = 9;              ///< m/s
  double clutter = 1;            ///< strength of other edges over that of the right one
  double present = 0.7;          ///< share of edges that the image shows at all
  double left_end = -0.8;        ///< of the view, x / z
  bool one_place = false;        ///< all objects are at one place next to the road
  bool same_frames = false;      ///< every frame equals the first
};

/// Profiles of objects spread over the view of a camera that drives forward. Images show the edge
/// at the position given by `truth`, a pixel wide, and clutter anywhere.
std::vector<EdgeProfile> profiles_of(const Drive& drive, const CalibrationVector& truth,
                                     std::uint64_t seed = 1) {
  Random random(seed);
  std::vector<EdgeProfile> profiles;
  for (int i = 0; i < drive.frames * drive.edges; ++i) {
    if (drive.same_frames && i >= drive.edges) {
      profiles.push_back(profiles[static_cast<std::size_t>(i % drive.edges)]);
      profiles.back().frame = i / drive.edges;
      continue;
    }
    constexpr double kF = 700;
    double x = random.uniform(drive.left_end, 0.8), y = random.uniform(-0.2, 0.2),
           z = random.uniform(5, 30);
    if (drive.one_place) x = 0.5, y *= 0.1, z = 10;
    EdgeProfile profile;
    profile.frame = i / drive.edges;
    profile.place = {i, 0, 0};
    profile.J << static_cast<float>(kF * x * y), static_cast<float>(-kF * (1 + x * x)),
        static_cast<float>(kF * y), static_cast<float>(kF / z), 0, static_cast<float>(-kF * x / z),
        static_cast<float>(kF * x / z * drive.speed), static_cast<float>(kF * (1 + y * y)),
        static_cast<float>(-kF * x * y), static_cast<float>(-kF * x), 0, static_cast<float>(kF / z),
        static_cast<float>(-kF * y / z), static_cast<float>(kF * y / z * drive.speed);
    const bool level = random.uniform() < 0.4;
    const double angle = random.uniform(-0.4, 0.4) + (level ? std::numbers::pi / 2 : 0);
    const Eigen::Vector2f along(static_cast<float>(std::cos(angle)),
                                static_cast<float>(std::sin(angle)));
    profile.J_along << (along.transpose() * profile.J).transpose(), level ? 0.0f : 1.0f,
        level ? along.y() : 0.0f;
    profile.half_gap = 1.0f;
    const double place = profile.J_along.cast<double>().dot(truth) + random.uniform(-1, 1);
    const bool shown = random.uniform() < drive.present;
    float sum = 0.5f;
    for (int k = 0; k < EdgeProfile::kSize; ++k) {
      const double away = k - EdgeProfile::kReach - place;
      const double strength = (shown ? std::exp(-away * away / 2) : 0) +
                              (random.uniform() < 0.1 ? drive.clutter * random.uniform() : 0);
      profile.strength[std::size_t(k)] = static_cast<float>(strength);
      sum += profile.strength[std::size_t(k)];
    }
    for (float& strength : profile.strength) strength /= sum;
    profiles.push_back(profile);
  }
  return profiles;
}

CalibrationVector planted(double x, double y, double z, double ms) {
  return (CalibrationVector() << x * kDegree, y * kDegree, z * kDegree, 0, 0, 0, 1e-3 * ms, 0.6,
          -0.8)
      .finished();
}

TEST(CalibrationEstimate, FindsTheTrueErrorWithinItsSigmas) {
  for (const auto& truth :
       {planted(0, 0, 0, 0), planted(0.3, 0, 0, 0), planted(0, -0.3, 0, 0), planted(0, 0, 0.3, 0),
        planted(0, 0, 0, 20), planted(0.3, 0.3, -0.3, -20)}) {
    const CalibrationEstimate e = estimate_calibration(profiles_of({}, truth));
    ASSERT_TRUE(e.rotation_observable() && e.delay_observable());
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(e.correction.rotation[k], truth[k], 4 * e.sigma.rotation[k]) << k;
      EXPECT_GT(e.sigma.rotation[k], 1e-3 * kDegree);
      EXPECT_LT(e.sigma.rotation[k], 0.04 * kDegree);
    }
    EXPECT_NEAR(e.correction.delay, truth[kCamDelay], 4 * e.sigma.delay);
    EXPECT_LT(e.sigma.delay, 1e-3);
    EXPECT_EQ(e.frames, 20);
    EXPECT_EQ(e.edges, 2000u);
    EXPECT_EQ(e.off_by_a_pixel(), truth.head<kCalibrationSize>().norm() > 0) << truth.transpose();
  }
}

// Over 30 drives the errors of the estimates, in sigmas, have a spread of 1.
TEST(CalibrationEstimate, SigmasAreTheScatter) {
  Drive drive;
  drive.frames = 15;
  drive.edges = 40;
  const CalibrationVector truth = planted(0.1, -0.1, 0.1, 5);
  Eigen::Vector4d square = Eigen::Vector4d::Zero();
  constexpr int kDrives = 30;
  for (int i = 0; i < kDrives; ++i) {
    const CalibrationEstimate e =
        estimate_calibration(profiles_of(drive, truth, 100 + static_cast<std::uint64_t>(i)));
    ASSERT_TRUE(e.delay_observable());
    for (int k = 0; k < 3; ++k) {
      square[k] += std::pow((e.correction.rotation[k] - truth[k]) / e.sigma.rotation[k], 2);
    }
    square[3] += std::pow((e.correction.delay - truth[kCamDelay]) / e.sigma.delay, 2);
  }
  for (int k = 0; k < 4; ++k) {
    EXPECT_GT(std::sqrt(square[k] / kDrives), 0.6) << k;
    EXPECT_LT(std::sqrt(square[k] / kDrives), 1.6) << k;
  }
}

TEST(CalibrationEstimate, AStandingVehicleShowsNoDelay) {
  for (const double speed : {0.0, 0.05}) {
    Drive drive;
    drive.speed = speed;
    const CalibrationEstimate e = estimate_calibration(profiles_of(drive, planted(0, 0.3, 0, 20)));
    EXPECT_TRUE(e.rotation_observable());
    EXPECT_FALSE(e.delay_observable());
    EXPECT_EQ(e.correction.delay, 0);
    EXPECT_NEAR(e.correction.rotation.y(), 0.3 * kDegree, 0.05 * kDegree);
  }
}

// On a straight road a delay moves objects at one place as a yaw does, so the two are ambiguous.
TEST(CalibrationEstimate, ADelayThatLooksLikeYawIsNotTold) {
  Drive drive;
  drive.one_place = true;
  for (const auto& truth : {planted(0, 0, 0, 20), planted(0, 0.3, 0, 0)}) {
    const CalibrationEstimate e = estimate_calibration(profiles_of(drive, truth));
    EXPECT_FALSE(e.delay_observable());
    EXPECT_EQ(e.correction.delay, 0);
    EXPECT_FALSE(e.off_by_a_pixel());
  }
}

// A slow drive with few edges, all on the right: the rotation's deviations include the unknown
// delay.
TEST(CalibrationEstimate, AnUnknownDelayMakesTheRotationLessSure) {
  Drive drive;
  drive.speed = 2.2;
  drive.frames = 8;
  drive.edges = 25;
  drive.present = 0.45;
  drive.left_end = 0.3;
  int unknown = 0;
  double square = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const CalibrationVector truth = planted(0.1, 0.2, 0, 20);
    const CalibrationEstimate e = estimate_calibration(profiles_of(drive, truth, seed));
    if (e.delay_observable() || !e.rotation_observable()) continue;
    ++unknown;
    square += std::pow((e.correction.rotation.y() - truth[1]) / e.sigma.rotation.y(), 2);
  }
  EXPECT_GT(unknown, 20);
  EXPECT_LT(std::sqrt(square / unknown), 1.25);  // 1.8 if the delay were assumed to be 0
}

// Two looks at the same objects do not reduce the deviations.
TEST(CalibrationEstimate, SigmasCountObjectsAndNotFrames) {
  Drive once, again;
  again.edges = once.frames * once.edges;
  again.frames = 10;
  again.same_frames = true;
  const CalibrationVector truth = planted(0.1, -0.1, 0.1, 5);
  const CalibrationEstimate a = estimate_calibration(profiles_of(once, truth));
  const CalibrationEstimate b = estimate_calibration(profiles_of(again, truth));
  ASSERT_TRUE(a.delay_observable() && b.delay_observable());
  EXPECT_EQ(b.edges, 10 * a.edges);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(a.correction.rotation[k], b.correction.rotation[k], 1e-6);
    EXPECT_GT(b.sigma.rotation[k], 0.5 * a.sigma.rotation[k]);
  }
  EXPECT_GT(b.sigma.delay, 0.5 * a.sigma.delay);
}

TEST(CalibrationEstimate, TooLittleShowsNothing) {
  const CalibrationVector truth = planted(0.3, 0, 0, 0);
  Drive few_frames, few_edges, blank;
  few_frames.frames = 4;
  few_edges.edges = 5;
  blank.present = blank.clutter = 0;
  for (const auto& profiles : {std::vector<EdgeProfile>{}, profiles_of(few_frames, truth),
                               profiles_of(few_edges, truth), profiles_of(blank, truth)}) {
    const CalibrationEstimate e = estimate_calibration(profiles);
    EXPECT_FALSE(e.rotation_observable() || e.delay_observable());
    EXPECT_EQ(e.correction.rotation.norm() + std::abs(e.correction.delay) + e.pixels, 0);
    EXPECT_FALSE(e.off_by_a_pixel());
  }
}

// Only clutter: its maximum is no correction, and camera and LiDAR disagree.
TEST(CalibrationEstimate, ClutterAloneDisagrees) {
  Drive drive;
  drive.present = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const CalibrationEstimate e =
        estimate_calibration(profiles_of(drive, planted(0, 0, 0, 0), seed));
    EXPECT_FALSE(e.rotation_observable() || e.off_by_a_pixel());
    EXPECT_TRUE(e.disagrees);
  }
}

// Beyond the reach of the profiles, which is 2 degrees here.
TEST(CalibrationEstimate, ATurnBeyondReachDisagrees) {
  for (const auto& truth : {planted(4, 0, 0, 0), planted(0, -5, 0, 0), planted(0, 0, 20, 0)}) {
    const CalibrationEstimate e = estimate_calibration(profiles_of({}, truth));
    EXPECT_FALSE(e.rotation_observable()) << truth.transpose();
    EXPECT_TRUE(e.disagrees) << truth.transpose();
  }
  EXPECT_FALSE(estimate_calibration(profiles_of({}, planted(0.3, 0, 0, 0))).disagrees);
}

// Three frames are too few for a correction, but enough for a disagreement.
TEST(CalibrationEstimate, ThreeFramesAreEnoughToDisagree) {
  Drive drive;
  for (const int frames : {2, 3}) {
    drive.frames = frames;
    const CalibrationEstimate wrong = estimate_calibration(profiles_of(drive, planted(0, 5, 0, 0)));
    EXPECT_FALSE(wrong.rotation_observable());
    EXPECT_EQ(wrong.disagrees, frames == 3);
    EXPECT_FALSE(estimate_calibration(profiles_of(drive, planted(0, 0, 0, 0))).disagrees);
  }
}

// Sparse rings make only the pitch uncertain, which all their edges share.
TEST(CalibrationEstimate, SparseRingsMakePitchLessSure) {
  auto dense = profiles_of({}, planted(0.1, 0, 0, 0));
  for (EdgeProfile& profile : dense) profile.ring_spacing = float(0.4 * kDegree);
  auto sparse = dense;
  for (EdgeProfile& profile : sparse) profile.ring_spacing = float(1.7 * kDegree);
  const CalibrationEstimate a = estimate_calibration(dense), b = estimate_calibration(sparse);
  EXPECT_EQ(a.correction.rotation, b.correction.rotation);
  EXPECT_GT(b.sigma.rotation.x(), 0.15 * kDegree);
  EXPECT_EQ(a.sigma.rotation.tail<2>(), b.sigma.rotation.tail<2>());
  EXPECT_TRUE(a.off_by_a_pixel());
  EXPECT_FALSE(b.off_by_a_pixel());
}

// One half of the frames is rotated, the other is not: no calibration is right for both.
TEST(CalibrationEstimate, HalvesThatContradictEachOtherConfirmNothing) {
  auto profiles = profiles_of({}, planted(0, 0.8, 0, 0));
  const auto others = profiles_of({}, planted(0, -0.8, 0, 0), 2);
  for (std::size_t i = profiles.size() / 2; i < profiles.size(); ++i) {
    const int frame = profiles[i].frame;
    profiles[i] = others[i];
    profiles[i].frame = frame;
  }
  const CalibrationEstimate e = estimate_calibration(profiles);
  EXPECT_FALSE(e.off_by_a_pixel());
}

TEST(CalibrationEstimate, SameAtAnyNumberOfThreads) {
  const auto profiles = profiles_of({}, planted(0.1, 0.2, -0.3, 8));
  CalibrationEstimate one, two;
  {
    const ThreadLimit limit(1);
    one = estimate_calibration(profiles);
  }
  {
    const ThreadLimit limit(2);
    two = estimate_calibration(profiles);
  }
  EXPECT_EQ(one.correction.rotation, two.correction.rotation);
  EXPECT_EQ(one.correction.delay, two.correction.delay);
  EXPECT_EQ(one.sigma.delay, two.sigma.delay);
}

TEST(CalibrationEstimate, CorrectsACamera) {
  Camera camera;
  camera.T_cam_lidar.translation() = Eigen::Vector3d(1, 2, 3);
  camera.image_delay = 0.01;
  CameraCorrection estimate;
  estimate.rotation = {0, 0, std::numbers::pi / 2};
  estimate.delay = 0.02;
  const Camera right = corrected(camera, estimate);
  EXPECT_LT((right.T_cam_lidar * Eigen::Vector3d::Zero() - Eigen::Vector3d(-2, 1, 3)).norm(),
            1e-12);
  EXPECT_NEAR(right.image_delay, 0.03, 1e-15);
}

}  // namespace fovea::calibration_estimate_test
