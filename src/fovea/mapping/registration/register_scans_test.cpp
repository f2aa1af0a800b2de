#include <gmock/gmock.h>

#include <functional>
#include <limits>
#include <stdexcept>

#include "fovea/mapping/registration/test_scenes.h"
#include "fovea/registration.h"

namespace fovea::register_scans_test {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

/// A scan of the room from a pose in it.
PointCloud scan_at(const RigidMotion& T_room_sensor, std::uint64_t seed) {
  PointCloud scan;
  const RigidMotion T_sensor_room = T_room_sensor.inverse();
  for (const Eigen::Vector3f& p : test::sample(test::room_corner(), 60, seed, 0.005)) {
    scan.position.push_back((T_sensor_room * p.cast<double>()).cast<float>());
  }
  return scan;
}

const RigidMotion kStep = exp_se3((Twist() << 0, 0, 0.05, 0.6, 0.2, 0).finished());

TEST(RegisterScans, FindsTheStepAndTheScansFit) {
  const PointCloud first = scan_at(RigidMotion::Identity(), 1), second = scan_at(kStep, 2);
  const RegistrationResult result = register_scans(first, second);
  EXPECT_TRUE(result.converged);
  EXPECT_LT(log_se3(result.T_target_source.inverse() * kStep).norm(), 0.02);
  const ScanFit fit = scan_fit(first, second, result.T_target_source);
  EXPECT_TRUE(fit.shows_one_place());
  EXPECT_GT(fit.overlap, 0.95);
  EXPECT_GT(fit.on_plane, 0.9);
}

TEST(RegisterScans, AWrongPoseDoesNotFitAlthoughTheStepsEnd) {
  const PointCloud first = scan_at(RigidMotion::Identity(), 1);
  RegistrationOptions options;
  options.max_distance = 3;
  for (const double turn : {1.5, 3.0}) {
    const RigidMotion turned = exp_se3((Twist() << 0, 0, turn, 0, 0, 0).finished());
    const PointCloud second = scan_at(turned, 2);
    const RegistrationResult result =
        register_scans(first, second, RigidMotion::Identity(), options);
    ASSERT_GT(log_se3(result.T_target_source.inverse() * turned).norm(), 0.5) << turn;
    EXPECT_FALSE(scan_fit(first, second, result.T_target_source).shows_one_place()) << turn;
    EXPECT_TRUE(scan_fit(first, second, turned).shows_one_place()) << turn;
  }
}

TEST(RegisterScans, ScansWithoutWallsConfirmNothing) {
  PointCloud floor;
  for (int i = 0; i < 10'000; ++i) {
    floor.position.emplace_back(float(i % 100) * 0.1f, float(i / 100) * 0.1f, -1.7f);
  }
  const ScanFit fit = scan_fit(floor, floor, RigidMotion::Identity());
  EXPECT_EQ(fit.vertical, 0u);
  EXPECT_FALSE(fit.shows_one_place());
  EXPECT_FALSE(scan_fit({}, {}, RigidMotion::Identity()).shows_one_place());
}

TEST(RegisterScans, WrongArgumentsAreNamed) {
  const PointCloud scan = scan_at(RigidMotion::Identity(), 1);
  const auto with = [&](const std::function<void(RegistrationOptions&)>& change) {
    return [&scan, change] {
      RegistrationOptions options;
      change(options);
      register_scans(scan, scan, RigidMotion::Identity(), options);
    };
  };
  const auto names = [](const char* text) {
    return ThrowsMessage<std::invalid_argument>(HasSubstr(text));
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(with([](auto& o) { o.max_distance = -1; }), names("max_distance is -1"));
  EXPECT_THAT(with([](auto& o) { o.max_distance = 0; }), names("max_distance is 0"));
  EXPECT_THAT(with([&](auto& o) { o.voxel = nan; }), names("voxel is nan"));
  EXPECT_THAT(with([](auto& o) { o.robust_width = -1; }), names("robust_width is -1"));
  EXPECT_THAT(with([](auto& o) { o.neighbors = 0; }), names("neighbors is 0"));
  EXPECT_THAT(with([](auto& o) { o.max_iterations = -1; }), names("max_iterations is -1"));
  EXPECT_THAT(with([](auto& o) { o.max_points = -1; }), names("max_points is -1"));

  RigidMotion scaled = RigidMotion::Identity();
  scaled.linear() *= 2;
  EXPECT_THAT([&] { register_scans(scan, scan, scaled); }, names("no rigid motion"));
  PointCloud moved = scan;
  moved.origin.x() = 1;
  EXPECT_THAT([&] { register_scans(scan, moved); }, names("the origin of the source"));
}

}  // namespace fovea::register_scans_test
