// What is written is read back by the product's own reader.
#include "fovea/simulation/navigation_model.h"

#include <gtest/gtest.h>

#include <numbers>

#include "fovea/core/read_file.h"
#include "fovea/drive/kitti/oxts.h"
#include "fovea/drive/navigation/navigation.h"
#include "fovea/drive/time_stamps.h"
#include "fovea/simulation/drive_texts.h"

namespace fovea::navigation_model_test {

/// A drive in a turning street, as its simulator makes it.
struct Drive {
  SimulationOptions options;
  Rig rig;
  Path path;
  VehicleMotion motion;
  RigidMotion T_world_local = RigidMotion::Identity();

  explicit Drive(const SimulationOptions& o)
      : options(o),
        rig(make_rig(o)),
        path(
            [b = o.bends, c = o.curvature](double s) { return 0.7 + c * s + b * std::sin(s / 18); },
            [b = o.bends, c = o.curvature](double s) { return c + b / 18 * std::cos(s / 18); }, -20,
            longest_way(o.vehicle, o.frames * o.lidar.period + 0.5)),
        motion(path, -1.7, o.vehicle, o.seed) {
    T_world_local.translation() = T_world_lidar(0).translation();
  }
  RigidMotion T_world_lidar(double time) const {
    return motion.T_world_vehicle(time) * rig.T_vehicle_lidar;
  }
  RigidMotion T_local_lidar(TimeNs time) const {
    return T_world_local.inverse() * T_world_lidar(seconds(time - stamp_of(0, options)));
  }
  std::vector<NavigationRecord> records() const {
    return simulate_navigation(motion, rig, T_world_local, options);
  }
};

SimulationOptions exact() {
  SimulationOptions options;
  options.frames = 120;
  NavigationOptions& n = options.navigation;
  n.position_noise = n.position_walk = n.position_bias = n.angle_noise = n.angle_walk =
      n.velocity_noise = n.rate_noise = n.jump_rate = 0;
  return options;
}

std::vector<StampedOxts> read(const std::vector<NavigationRecord>& records) {
  std::vector<StampedOxts> result;
  for (const NavigationRecord& record : records) {
    result.push_back({record.time, std::get<OxtsRecord>(parse_oxts(record.text))});
  }
  return result;
}

/// The reader's poses in the truth's local frame.
Trajectory read_trajectory(const Drive& drive) {
  const Navigation navigation =
      make_navigation(read(drive.records()), drive.rig.T_imu_lidar, stamp_of(0, drive.options));
  const RigidMotion T_truth_local =
      LocalTangentPlane(drive.options.navigation.origin).T_local_enu(*navigation.origin);
  std::vector<StampedPose> poses = navigation.trajectory.poses();
  for (StampedPose& pose : poses) pose.T_local_body = T_truth_local * pose.T_local_body;
  return Trajectory(poses);
}

void expect_same(const RigidMotion& actual, const RigidMotion& expected, double position,
                 double angle) {
  EXPECT_LT((actual.translation() - expected.translation()).norm(), position);
  EXPECT_LT(rotation_angle(actual.linear().transpose() * expected.linear()), angle);
}

TEST(SimulatedNavigation, ReaderFindsTheTruthAtTheRecords) {
  const Drive drive(exact());
  const Trajectory trajectory = read_trajectory(drive);
  ASSERT_EQ(trajectory.poses().size(), 120u);
  for (const StampedPose& pose : trajectory.poses()) {
    expect_same(pose.T_local_body, drive.T_local_lidar(pose.time), 1e-6, 1e-7);
  }
}

TEST(SimulatedNavigation, ReaderInterpolatesAConstantTwistExactly) {
  SimulationOptions options = exact();
  options.bends = 0;
  options.curvature = 0.02;
  options.vehicle.speed_variation = options.vehicle.weave = options.vehicle.sway =
      options.vehicle.heave = 0;
  const Drive drive(options);
  const Trajectory trajectory = read_trajectory(drive);
  for (int frame = 0; frame < options.frames; ++frame) {
    const TimeNs stamp = stamp_of(frame, options);
    expect_same(trajectory.at(stamp).value(), drive.T_local_lidar(stamp), 1e-4, 1e-7);
  }
}

TEST(SimulatedNavigation, ReaderInterpolatesTheDefaultDriveToMillimetres) {
  const Drive drive(exact());
  const Trajectory trajectory = read_trajectory(drive);
  for (int frame = 1; frame < drive.options.frames; ++frame) {
    const TimeNs stamp = stamp_of(frame, drive.options);
    expect_same(trajectory.at(stamp).value(), drive.T_local_lidar(stamp), 0.003, 4e-4);
  }
}

TEST(SimulatedNavigation, RecordsLieAfterTheirScansByTheDelay) {
  SimulationOptions options = exact();
  options.frames = 1000;
  double sum = 0;
  const auto records = Drive(options).records();
  for (int frame = 0; frame < options.frames; ++frame) {
    const double delay = seconds(records[frame].time - stamp_of(frame, options));
    EXPECT_GE(delay, options.navigation.min_delay);
    EXPECT_LE(delay, options.navigation.max_delay);
    sum += delay;
  }
  EXPECT_NEAR(sum / options.frames, 0.0245, 0.0013);  // uniform: five standard errors
}

TEST(SimulatedNavigation, ReaderFindsTheVelocityOfTheLidar) {
  const Drive drive(exact());
  const auto records = drive.records();
  const Trajectory trajectory = read_trajectory(drive);
  for (std::size_t i = 0; i < records.size(); ++i) {
    constexpr TimeNs kHalf = kNsPerSecond / 500;
    const RigidMotion before = drive.T_local_lidar(records[i].time - kHalf),
                      after = drive.T_local_lidar(records[i].time + kHalf);
    const Twist expected = log_se3(before.inverse() * after) / seconds(2 * kHalf);
    EXPECT_LT((trajectory.poses()[i].velocity.value() - expected).norm(), 2e-3);
    // What the generic format is given is what is read from KITTI's.
    const OxtsRecord read = std::get<OxtsRecord>(parse_oxts(records[i].text));
    EXPECT_LT((records[i].velocity - read.velocity.value()).norm(), 1e-12);
  }
}

TEST(SimulatedNavigation, VelocitiesAccelerationsAndRatesFitThePoses) {
  const Drive drive(exact());
  const auto records = drive.records();
  const auto T_world_imu = [&](double time) -> RigidMotion {
    return drive.T_world_lidar(time) * drive.rig.T_imu_lidar.inverse();
  };
  for (std::size_t i = 0; i < records.size(); i += 7) {
    const auto n = parse_numbers(records[i].text).value();
    ASSERT_EQ(n.size(), 30u);
    // A step other than the model's own.
    const double t = seconds(records[i].time - stamp_of(0, drive.options)), h = 0.002;
    const RigidMotion before = T_world_imu(t - h), now = T_world_imu(t), after = T_world_imu(t + h);
    const Eigen::Vector3d velocity = (after.translation() - before.translation()) / (2 * h);
    EXPECT_NEAR(n[6], velocity.y(), 1e-3);
    EXPECT_NEAR(n[7], velocity.x(), 1e-3);
    EXPECT_NEAR(n[8] * n[8] + n[9] * n[9], velocity.head<2>().squaredNorm(), 2e-2);
    EXPECT_GT(n[8], 5);
    EXPECT_NEAR(n[10], velocity.z(), 1e-3);
    const Eigen::Vector3d force =
        (after.translation() - 2 * now.translation() + before.translation()) / (h * h) +
        Eigen::Vector3d(0, 0, 9.81);
    const Eigen::Vector3d force_imu = now.linear().transpose() * force;
    EXPECT_LT((Eigen::Vector3d(n[11], n[12], n[13]) - force_imu).norm(), 2e-3);
    EXPECT_NEAR(n[16], force.z(), 2e-3);
    EXPECT_NEAR(Eigen::Vector3d(n[14], n[15], n[16]).norm(), force.norm(), 2e-3);
    RigidMotion turn = RigidMotion::Identity();
    turn.linear() = before.linear().transpose() * after.linear();
    const Eigen::Vector3d rate = log_se3(turn).head<3>() / (2 * h);
    EXPECT_LT((Eigen::Vector3d(n[17], n[18], n[19]) - rate).norm(), 1e-4);
    EXPECT_NEAR(n[22], (now.linear() * rate).z(), 1e-4);
    EXPECT_EQ(n[25], 4);
    EXPECT_EQ(n[26], 8);
  }
}

TEST(SimulatedNavigation, ErrorsShowInTheRecords) {
  SimulationOptions options = exact();
  options.navigation.position_bias = 0.4;
  options.navigation.outages = true;
  const Drive drive(options);
  const Trajectory trajectory = read_trajectory(drive);
  const auto error_at = [&](std::size_t i) -> Eigen::Vector3d {
    const StampedPose& pose = trajectory.poses()[i];
    return pose.T_local_body.translation() - drive.T_local_lidar(pose.time).translation();
  };
  EXPECT_GT(error_at(0).norm(), 0.05);
  EXPECT_LT((error_at(0) - error_at(119)).norm(), 1e-3);
  int without_satellites = 0;
  for (const NavigationRecord& record : drive.records()) {
    const auto n = parse_numbers(record.text).value();
    EXPECT_GE(n[23], 0.4);
    if (n[26] == 0) ++without_satellites;
  }
  EXPECT_GT(without_satellites, 30);
  EXPECT_LT(without_satellites, 105);
}

TEST(DriveTexts, StampsReadBack) {
  SimulationOptions options;
  options.frames = 300;
  const std::string text = stamps_text(options), start = stamps_text(options, -0.5),
                    end = stamps_text(options, 0.5);
  EXPECT_EQ(text.substr(0, 30), "2026-01-01 12:00:00.000000000\n");
  for (int frame = 0; frame < options.frames; ++frame) {
    const auto line = [&](const std::string& lines) {
      return parse_date_time(lines.substr(std::size_t(frame) * 30, 29)).value();
    };
    EXPECT_EQ(line(text), stamp_of(frame, options));
    EXPECT_EQ((line(start) + line(end)) / 2, stamp_of(frame, options));
    EXPECT_EQ(line(end) - line(start), from_seconds(options.lidar.period));
  }
  EXPECT_EQ(date_time_text(stamp_of(0, options) - 1), "2026-01-01 11:59:59.999999999");
}

}  // namespace fovea::navigation_model_test
