#include "fovea/drive/navigation/navigation.h"

#include <gtest/gtest.h>

#include <numbers>
#include <stdexcept>

namespace fovea::navigation_test {

constexpr double kDegree = std::numbers::pi / 180;

/// Radii of curvature of the WGS84 ellipsoid at latitude 49 degrees, m: of the meridian and across.
struct Curvature {
  double M, N;
  Curvature() {
    constexpr double a = 6378137, f = 1 / 298.257223563, e2 = f * (2 - f);
    const double w = 1 - e2 * std::pow(std::sin(49 * kDegree), 2);
    M = a * (1 - e2) / std::pow(w, 1.5);
    N = a / std::sqrt(w);
  }
};

/// Two records a second apart: 1e-4 degrees north (11.12 m), heading north.
std::vector<StampedOxts> drive_north() {
  OxtsRecord a{{49, 8.4, 100}, 0, 0, std::numbers::pi / 2}, b = a;
  b.position.latitude += 1e-4;
  return {{0, a}, {kNsPerSecond, b}};
}

TEST(Navigation, PositionsFollowTheEllipsoid) {
  const double step = 1e-4 * kDegree * (Curvature().M + 100);
  const Navigation north = make_navigation(drive_north(), RigidMotion::Identity(), 0);
  const auto& poses = north.trajectory.poses();
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_LT(poses[0].T_local_body.translation().norm(), 1e-6);
  EXPECT_LT((poses[1].T_local_body.translation() - Eigen::Vector3d(0, step, 0)).norm(), 1e-4);
  EXPECT_LT(
      (north.trajectory.at(from_seconds(0.3))->translation() - Eigen::Vector3d(0, 0.3 * step, 0))
          .norm(),
      1e-4);
}

TEST(Navigation, OriginIsTheLidarAtTheTimeAskedFor) {
  // The LiDAR sits 1 m ahead, 0.5 m to the right and 2 m above the imu; the car heads north.
  RigidMotion T_imu_lidar = RigidMotion::Identity();
  T_imu_lidar.translation() = Eigen::Vector3d(1, -0.5, 2);
  const TimeNs half = kNsPerSecond / 2;
  const Navigation navigation = make_navigation(drive_north(), T_imu_lidar, half);
  EXPECT_LT(navigation.trajectory.at(half)->translation().norm(), 1e-6);
  const Curvature radius;
  EXPECT_NEAR(navigation.origin->altitude, 102, 1e-4);
  EXPECT_NEAR(navigation.origin->latitude, 49 + 0.5e-4 + 1 / (radius.M + 100) / kDegree, 1e-9);
  EXPECT_NEAR(navigation.origin->longitude,
              8.4 + 0.5 / (radius.N + 100) / std::cos(49 * kDegree) / kDegree, 1e-9);
  // Forward of the LiDAR points north (y), its left west.
  const Eigen::Matrix3d R = navigation.trajectory.at(half)->rotation();
  EXPECT_LT((R.col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-5);
  EXPECT_LT((R.col(1) + Eigen::Vector3d::UnitX()).norm(), 1e-5);
}

TEST(Navigation, OriginBeyondTheRecordsIsTheFirst) {
  const Navigation navigation =
      make_navigation(drive_north(), RigidMotion::Identity(), 10 * kNsPerSecond);
  EXPECT_NEAR(navigation.origin->latitude, 49, 1e-12);
}

TEST(Navigation, MeasuredVelocityIsThatOfTheLidar) {
  // Turning left by 0.5 rad/s at 10 m/s, the LiDAR 2 m ahead of the imu and looking to its left:
  // it goes 10 m/s to its own right and, swung around, 1 m/s forward.
  std::vector<StampedOxts> records = drive_north();
  records[1].record.velocity.emplace() << 0, 0, 0.5, 10, 0, 0;
  RigidMotion T_imu_lidar(Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  T_imu_lidar.pretranslate(Eigen::Vector3d(2, 0, 0));
  const auto poses = make_navigation(records, T_imu_lidar, 0).trajectory.poses();
  EXPECT_FALSE(poses[0].velocity);
  Twist expected;
  expected << 0, 0, 0.5, 1, -10, 0;
  EXPECT_LT((poses[1].velocity.value() - expected).norm(), 1e-12);
}

TEST(Navigation, AFrozenUnitMeasuresNoVelocity) {
  std::vector<StampedOxts> records = drive_north();
  for (StampedOxts& record : records) record.record.velocity = Twist::Ones();
  for (int i = 2; i < 4; ++i) records.push_back({i * kNsPerSecond, records[1].record});
  const auto poses = make_navigation(records, RigidMotion::Identity(), 0).trajectory.poses();
  EXPECT_TRUE(poses[0].velocity);
  EXPECT_TRUE(poses[1].velocity);
  EXPECT_FALSE(poses[2].velocity);
  EXPECT_FALSE(poses[3].velocity);
}

TEST(Navigation, WithoutAFixThereIsNoOrigin) {
  std::vector<StampedOxts> records = drive_north();
  for (StampedOxts& record : records) record.record.satellites = 0;
  EXPECT_FALSE(make_navigation(records, RigidMotion::Identity(), 0).origin);
  records[1].record.satellites = 5;
  EXPECT_TRUE(make_navigation(records, RigidMotion::Identity(), 0).origin);
}

TEST(Navigation, PositionsOutOfReachAreFar) {
  std::vector<GeodeticPose> poses;
  for (int i = 0; i < 20; ++i) {
    GeodeticPose pose;
    pose.time = i * kNsPerSecond;
    pose.position = {49 + 1e-4 * i, 179.9999 + 2e-5 * i, 100};  // 11 m a second
    if (pose.position.longitude > 180) pose.position.longitude -= 360;
    poses.push_back(pose);
  }
  EXPECT_EQ(far_positions(poses), std::vector<bool>(20, false));
  poses[3].position.latitude += 0.1;  // 11 km, with 19 s to get there
  poses[7].position.longitude = 0;
  const std::vector<bool> far = far_positions(poses);
  for (std::size_t i = 0; i < far.size(); ++i) EXPECT_EQ(far[i], i == 3 || i == 7) << i;
  // Most positions lack a fix: those with one count.
  for (std::size_t i = 0; i < 15; ++i) {
    poses[i].accuracy = std::numeric_limits<double>::infinity();
    poses[i].position = {10, 10, 0};
  }
  for (std::size_t i = 0; i < far.size(); ++i) EXPECT_EQ(far_positions(poses)[i], i < 15) << i;
  EXPECT_TRUE(far_positions({}).empty());
}

TEST(Navigation, NeedsARecord) {
  EXPECT_THROW(make_navigation({}, RigidMotion::Identity(), 0), std::invalid_argument);
}

}  // namespace fovea::navigation_test
