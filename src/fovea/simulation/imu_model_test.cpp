#include "fovea/simulation/imu_model.h"

#include <gtest/gtest.h>

#include "fovea/mapping/inertial_filter.h"
#include "fovea/simulation/drive_texts.h"

namespace fovea::imu_model_test {

using Vector3 = Eigen::Vector3d;

/// A person who carries the sensors along a bending way, without errors.
struct Walk {
  SimulationOptions options;
  Path path;

  Walk()
      : options(simulation_options(Scene::kStreet, "none")),
        path([](double s) { return 0.02 * s; }, [](double) { return 0.02; }, -20, 200) {
    options.format = DriveFormat::kGeneric;
    options.frames = 40;
    options.vehicle.carrier = Carrier::kWalker;
    options.vehicle.speed = 1.4;
    options.vehicle.turn_rate = 100 * kDegree;
    options.imu.rate = 200;
    options.imu.roll = 180 * kDegree;
    options.imu.yaw = 30 * kDegree;
  }
  VehicleMotion motion() const { return VehicleMotion(path, 0, options.vehicle, options.seed); }
  std::vector<ImuRecord> records() const {
    return simulate_imu(motion(), make_rig(options), options);
  }
};

TEST(SimulatedImu, IntegratesToTheMotion) {
  const Walk walk;
  const VehicleMotion motion = walk.motion();
  const Rig rig = make_rig(walk.options);
  const auto T_world_lidar = [&](double time) -> RigidMotion {
    return motion.T_world_vehicle(time) * rig.T_vehicle_lidar;
  };
  ImuData imu;
  imu.T_lidar_imu = rig.T_lidar_imu;
  for (const ImuRecord& record : walk.records()) {
    imu.samples.push_back({record.time, record.rate, record.force});
  }
  InertialFilter filter(imu);
  const TimeNs start = stamp_of(0, walk.options);
  InertialStart first{T_world_lidar(0),
                      velocity_between(T_world_lidar(-1e-4), T_world_lidar(1e-4), 2e-4),
                      /*is_level=*/true};
  filter.begin(start, first);
  const RigidMotion end = filter.predict(start + kNsPerSecond).T_odom_lidar;
  EXPECT_LT((end.translation() - T_world_lidar(1).translation()).norm(), 0.005);
  EXPECT_LT(rotation_angle(end.linear().transpose() * T_world_lidar(1).linear()), 1e-3);
}

TEST(SimulatedImu, TurnsAsFastAsAskedFor) {
  double fastest = 0;
  for (const ImuRecord& record : Walk().records()) fastest = std::max(fastest, record.rate.norm());
  EXPECT_GT(fastest, 95 * kDegree);
  EXPECT_LT(fastest, 200 * kDegree);  // with the sway of a walk
}

TEST(SimulatedImu, StairsLeadUpAndDown) {
  Walk walk;
  walk.options.vehicle.stairs = 3;
  double lowest = 9, highest = -9;
  for (double time = 0; time < 20; time += 0.1) {
    const double z = walk.motion().T_world_vehicle(time).translation().z();
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  EXPECT_NEAR(lowest, 0, 0.06);
  EXPECT_NEAR(highest, 3, 0.06);
}

TEST(SimulatedImu, FaultsArePlanted) {
  Walk walk;
  const std::vector<ImuRecord> right = walk.records();
  ImuOptions& imu = walk.options.imu;
  imu.in_degrees = imu.in_g = true;
  imu.flipped_axis = 2;
  imu.time_offset = 0.05;
  const std::vector<ImuRecord> wrong = walk.records();
  ASSERT_EQ(wrong.size(), right.size());
  EXPECT_EQ(wrong[9].time - right[9].time, from_seconds(0.05));
  EXPECT_NEAR(wrong[9].rate.x(), right[9].rate.x() / kDegree, 1e-9);
  EXPECT_NEAR(wrong[9].force.y(), -right[9].force.y() / 9.81, 1e-9);
  imu = Walk().options.imu;
  imu.gap_at = 1;
  imu.gap_duration = 0.5;
  imu.gyroscope_range = 50 * kDegree;
  const std::vector<ImuRecord> cut = walk.records();
  EXPECT_EQ(right.size() - cut.size(), 100u);
  for (const ImuRecord& record : cut) {
    EXPECT_LE(record.rate.cwiseAbs().maxCoeff(), 50 * kDegree);
  }
}

TEST(SimulatedImu, ErrorsAreAsLargeAsStated) {
  Walk walk;
  const std::vector<ImuRecord> exact = walk.records();
  walk.options.imu = ImuOptions();
  walk.options.imu.rate = 200;
  walk.options.imu.roll = 180 * kDegree;
  walk.options.imu.yaw = 30 * kDegree;
  walk.options.imu.gyroscope_bias = walk.options.imu.accelerometer_bias = 0;
  const std::vector<ImuRecord> noisy = walk.records();
  double rates = 0, forces = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    rates += (noisy[i].rate - exact[i].rate).squaredNorm() / 3;
    forces += (noisy[i].force - exact[i].force).squaredNorm() / 3;
  }
  const double root = std::sqrt(200 / double(exact.size()));
  EXPECT_NEAR(std::sqrt(rates) * root / 200, walk.options.imu.gyroscope_noise, 4e-5);
  EXPECT_NEAR(std::sqrt(forces) * root / 200, walk.options.imu.accelerometer_noise, 3e-4);
}

TEST(SimulatedWheels, TellTheSpeedAhead) {
  Walk walk;
  walk.options.vehicle = VehicleOptions();
  walk.options.vehicle.speed_variation = 0;
  walk.options.wheels = {.rate = 50, .noise = 0, .scale = 1.02};
  const auto records = simulate_wheels(walk.motion(), make_rig(walk.options), walk.options);
  ASSERT_GT(records.size(), 150u);
  for (const WheelRecord& record : records) EXPECT_NEAR(record.speed, 1.02 * 9, 0.15);
}

}  // namespace fovea::imu_model_test
