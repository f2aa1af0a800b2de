#include "fovea/simulation/vehicle_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/simulation/rig.h"

namespace fovea::vehicle_motion_test {

Path bends(double swing) {
  return Path([=](double s) { return swing * std::sin(s / 18); },
              [=](double s) { return swing / 18 * std::cos(s / 18); }, -20, 1000);
}

VehicleOptions steady() {
  VehicleOptions options;
  options.speed_variation = options.weave = options.sway = options.heave = 0;
  return options;
}

TEST(VehicleMotion, TwistIsConstantOnACircleWithoutVariations) {
  for (const double curvature : {0.0, 0.02, -0.05}) {
    const Path path([=](double s) { return 0.4 + curvature * s; },
                    [=](double) { return curvature; }, -20, 300);
    const VehicleMotion motion(path, -1.7, steady(), 5);
    const RigidMotion T_vehicle_lidar = make_rig({}).T_vehicle_lidar;
    const auto twist = [&](double t, double dt) -> Twist {
      const RigidMotion T0 = motion.T_world_vehicle(t) * T_vehicle_lidar;
      const RigidMotion T1 = motion.T_world_vehicle(t + dt) * T_vehicle_lidar;
      return log_se3(T0.inverse() * T1) / dt;
    };
    const Twist expected = twist(0, 0.1);
    EXPECT_NEAR(expected.head<3>().norm(), std::abs(9 * curvature), 1e-9);
    for (const double t : {-0.05, 1.0, 7.77, 30.0}) {
      for (const double dt : {0.05, 0.1, 0.4}) {
        EXPECT_LT((twist(t, dt) - expected).cwiseAbs().maxCoeff(), 1e-9) << t << ' ' << dt;
      }
    }
  }
}

TEST(VehicleMotion, WayIncreasesAtTheMeanSpeed) {
  const Path path = bends(0);
  VehicleOptions options;
  options.speed_variation = 0.99;
  for (int seed = 1; seed < 20; ++seed) {
    const VehicleMotion motion(path, 0, options, seed);
    EXPECT_DOUBLE_EQ(motion.way(0), 0);
    for (double t = -1; t < 60; t += 0.05) EXPECT_GT(motion.way(t + 0.05), motion.way(t));
    EXPECT_NEAR(motion.way(60) / 60, options.speed, 1);
    EXPECT_LE(motion.way(60), longest_way(options, 60));
    EXPECT_LE(-motion.way(-1), longest_way(options, 1));
  }
}

TEST(VehicleMotion, StopsAndGoesOn) {
  const Path path = bends(0);
  VehicleOptions options = steady();
  options.stop_at = 2;
  options.stop_braking = 3;
  options.stop_duration = 4;
  const VehicleMotion motion(path, 0, options, 1);
  EXPECT_DOUBLE_EQ(motion.way(2), 18);
  EXPECT_DOUBLE_EQ(motion.way(5), 18 + 9 * 1.5);  // the mean of 9 and 0 m/s for 3 s
  EXPECT_DOUBLE_EQ(motion.way(9), motion.way(5));
  EXPECT_DOUBLE_EQ(motion.way(12), motion.way(9) + 9 * 1.5);
  EXPECT_DOUBLE_EQ(motion.way(13), motion.way(12) + 9);
  for (double t = 0; t < 15; t += 0.01) {  // 3 m/s^2
    const double change = (motion.way(t + 0.02) - 2 * motion.way(t + 0.01) + motion.way(t)) / 1e-4;
    EXPECT_LT(std::abs(change), 3.001) << t;
  }
}

TEST(VehicleMotion, PointsWhereItGoes) {
  const Path path = bends(0.3);
  VehicleOptions options;
  options.sway = options.heave = 0;
  options.weave = 1;
  const VehicleMotion motion(path, -1.7, options, 3);
  for (double t = 0; t < 40; t += 0.7) {
    const RigidMotion T = motion.T_world_vehicle(t);
    const Eigen::Vector3d velocity = (motion.T_world_vehicle(t + 1e-4).translation() -
                                      motion.T_world_vehicle(t - 1e-4).translation()) /
                                     2e-4;
    const Eigen::Vector3d velocity_vehicle = T.linear().transpose() * velocity;
    EXPECT_GT(velocity_vehicle.x(), 4);
    EXPECT_NEAR(velocity_vehicle.y(), 0, 1e-6);
    EXPECT_NEAR(velocity_vehicle.z(), 0, 1e-6);
  }
}

TEST(VehicleMotion, SwaysByItsAmplitudesAndTheSeed) {
  const Path path = bends(0);
  const VehicleOptions options;
  const VehicleMotion motion(path, 0, options, 1), other(path, 0, options, 2);
  double highest = 0, most_tilted = 0, farthest = 0, difference = 0;
  for (double t = 0; t < 90; t += 0.01) {
    const RigidMotion T = motion.T_world_vehicle(t);
    highest = std::max(highest, std::abs(T.translation().z()));
    farthest = std::max(farthest, std::abs(T.translation().y()));
    most_tilted = std::max(most_tilted, std::acos(T.linear()(2, 2)));
    difference =
        std::max(difference,
                 (T.translation() - other.T_world_vehicle(t).translation()).cwiseAbs().maxCoeff());
  }
  EXPECT_LE(highest, options.heave);
  EXPECT_GT(highest, 0.7 * options.heave);
  EXPECT_LE(farthest, options.weave);
  EXPECT_GT(farthest, 0.7 * options.weave);
  EXPECT_LE(most_tilted, 1.5 * options.sway);
  EXPECT_GT(most_tilted, 0.7 * options.sway);
  EXPECT_GT(difference, 0.1);
}

// The sensors' readers interpolate between poses a sweep apart: what is smooth enough for that
// keeps their error below what a map shows.
TEST(VehicleMotion, IsGentleEnoughToInterpolate) {
  const SimulationOptions options;
  const Path path = bends(options.bends);
  const double period = options.lidar.period;
  double worst = 0;
  for (int seed = 1; seed <= 5; ++seed) {
    const VehicleMotion motion(path, -1.7, options.vehicle, seed);
    for (int i = 0; i < 900; ++i) {
      const double t = i * period;
      const RigidMotion middle =
          interpolate(motion.T_world_vehicle(t), motion.T_world_vehicle(t + period), 0.5);
      const RigidMotion error = middle.inverse() * motion.T_world_vehicle(t + 0.5 * period);
      for (const Eigen::Vector3d& p : {Eigen::Vector3d(15, 0, 0), Eigen::Vector3d(0, 15, 0),
                                       Eigen::Vector3d(0, -15, 0), Eigen::Vector3d(-15, 0, 0)}) {
        worst = std::max(worst, (error * p - p).norm());
      }
    }
  }
  RecordProperty("worst_mm", std::to_string(worst * 1000));
  EXPECT_LT(worst, 0.004);
  EXPECT_GT(worst, 0.0005);  // there is something to interpolate
}

TEST(Rig, IsArrangedLikeKittis) {
  SimulationOptions options;
  options.camera.cameras = {{0, 0, true}, {2, -0.06, false}, {3, 0.473, false}};
  const Rig rig = make_rig(options);
  ASSERT_EQ(rig.cameras.size(), 3u);
  EXPECT_NEAR(rig.T_vehicle_lidar.translation().z(), 1.73, 1e-12);
  EXPECT_LT((rig.T_imu_lidar.inverse().translation() - Eigen::Vector3d(-0.8, 0.32, -0.81)).norm(),
            1e-12);
  // In front, a little below the LiDAR, side by side.
  const Eigen::Vector3d left = rig.cameras[1].center_lidar(), right = rig.cameras[2].center_lidar();
  EXPECT_NEAR(left.x(), 0.27, 0.02);
  EXPECT_NEAR(left.z(), -0.08, 0.03);
  EXPECT_NEAR((left - right).norm(), 0.533, 1e-3);
  EXPECT_NEAR(left.y() - right.y(), 0.533, 2e-3);
  // The rectified camera looks forward, about level.
  EXPECT_GT(rig.cameras[1].T_cam_lidar.linear().row(2).x(), 0.999);
  for (const Eigen::Matrix3d& R : {Eigen::Matrix3d(rig.T_imu_lidar.linear()),
                                   Eigen::Matrix3d(rig.T_vehicle_lidar.linear()), rig.R_rect}) {
    EXPECT_TRUE(is_rotation(R, 1e-12));
    EXPECT_GT(rotation_angle(R), 0.003);  // one that is forgotten shows
    EXPECT_LT(rotation_angle(R), 0.02);
  }
}

}  // namespace fovea::vehicle_motion_test
