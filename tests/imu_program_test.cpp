// A walk with a LiDAR, an IMU and a camera, by the program: poses against the truth.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/simulation/simulate.h"
#include "tests/program.h"

namespace fovea::imu_program_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// 21 m by 1.4 m/s, with turns of 100 degrees a second, under a VLP-16; without GPS/INS.
class HandHeld : public testing::Test {
 protected:
  static constexpr int kFrames = 150;

  HandHeld() {
    options_ = simulation_options(Scene::kStreet, "default");
    options_.seed = 3;
    options_.frames = kFrames;
    options_.format = DriveFormat::kGeneric;
    set_model(options_.lidar, LidarModel::kVlp16);
    options_.lidar.height = 1.5;
    options_.vehicle.carrier = Carrier::kWalker;
    options_.vehicle.speed = 1.4;
    options_.vehicle.turn_rate = 100 * kDegree;
    options_.imu.rate = 200;
    options_.imu.roll = 180 * kDegree;
    options_.imu.yaw = 30 * kDegree;
    options_.camera.cameras = {kitti_camera(2)};
    options_.camera.width = 128;
    options_.camera.height = 40;
    options_.camera.focal = 74;
    options_.camera.cx = 63;
    options_.camera.cy = 18;
  }

  std::string drive() const { return (scratch_ / "drive").string(); }
  std::string map() const { return (scratch_ / "map.fovea").string(); }

  void simulate_walk() const {
    std::filesystem::remove_all(drive());
    simulate(options_, drive());
    std::filesystem::remove(scratch_ / "drive" / "gnss.csv");
  }

  nlohmann::json scores(const std::string& map_options) const {
    const ProgramRun mapped =
        run_fovea(fmt::format("map '{}' -o '{}' --force {}", drive(), map(), map_options));
    EXPECT_EQ(mapped.exit_code, 0) << mapped.err;
    const std::string report = (scratch_ / "scores.json").string();
    const ProgramRun scored =
        run_fovea(fmt::format("evaluate '{}' '{}' --truth --json '{}'", map(), drive(), report));
    EXPECT_EQ(scored.exit_code, 0) << scored.err;
    return nlohmann::json::parse(read_text(report));
  }

  SimulationOptions options_;
  TemporaryFolder scratch_;
};

TEST_F(HandHeld, AnImuKeepsAWalkWithFastTurnsOnItsWay) {
  simulate_walk();
  const nlohmann::json with = scores("--quiet"), without = scores("--quiet --no-imu");
  EXPECT_LT(with["pose_drift_10m_percent"]["mean"].get<double>(), 0.2);
  EXPECT_LT(with["pose_drift_10m_percent"]["max"].get<double>(), 0.5);
  EXPECT_LT(with["pose_aligned_m"]["mean"].get<double>(), 0.02);
  EXPECT_LT(with["pose_aligned_deg"]["max"].get<double>(), 1.0 / 60 * 0.1 * kFrames);
  EXPECT_GT(without["pose_aligned_m"]["mean"].get<double>(),
            3 * with["pose_aligned_m"]["mean"].get<double>());
}

TEST_F(HandHeld, FaultsOfTheImuAreTold) {
  options_.frames = 12;
  options_.imu.gap_at = 0.5;
  options_.imu.gap_duration = 0.2;
  options_.imu.in_g = true;
  options_.imu.gyroscope_range = 40 * kDegree;
  simulate_walk();
  const ProgramRun run = run_fovea(fmt::format("map '{}' -o '{}'", drive(), map()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("1 gaps, the longest of 0.2"));
  EXPECT_THAT(run.out + run.err, HasSubstr("read as multiples of gravity"));
  EXPECT_THAT(run.err, HasSubstr("the IMU is saturated"));
}

TEST_F(HandHeld, AnImuWithAFlippedAxisIsNotUsed) {
  options_.frames = 60;
  options_.vehicle.turn_rate = 30 * kDegree;
  options_.vehicle.turn_angle = 20 * kDegree;
  options_.imu.flipped_axis = 3;
  simulate_walk();
  const ProgramRun run = run_fovea(fmt::format("map '{}' -o '{}'", drive(), map()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("the turns of the IMU are not those of the scans"));
  const double flipped = scores("--quiet")["pose_aligned_m"]["mean"].get<double>();
  const double without = scores("--quiet --no-imu")["pose_aligned_m"]["mean"].get<double>();
  EXPECT_LT(flipped, 2 * without + 0.02);
}

TEST_F(HandHeld, AnImuThatSitsOrTicksOtherwiseIsTold) {
  options_.frames = 60;
  options_.vehicle.turn_rate = 60 * kDegree;
  const auto messages = [&] {
    simulate_walk();
    const ProgramRun run = run_fovea(fmt::format("map '{}' -o '{}' --force --report '{}'", drive(),
                                                 map(), (scratch_ / "report.json").string()));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.out + run.err;
  };
  const auto found = [&] {
    const std::string report = read_text(scratch_ / "report.json");
    return nlohmann::json::parse(report)["map"]["imu_calibration"];
  };
  const char* const told = "mount and clock do not fit, --calibrate corrects this";
  EXPECT_THAT(messages(), AllOf(HasSubstr("IMU: rotation "), Not(HasSubstr(told))));
  EXPECT_EQ(found()["is_off"], false);

  options_.imu.rotation_error = {3 * kDegree, 0, 0};
  options_.imu.time_offset = -0.03;
  EXPECT_THAT(messages(), HasSubstr(told));
  EXPECT_EQ(found()["is_off"], true);
  EXPECT_NEAR(found()["time_offset_ms"].get<double>(), 30, 10);  // the scans follow the IMU
}

TEST_F(HandHeld, ARunGoesOnWithItsImuOnly) {
  options_.frames = 6;
  simulate_walk();
  const std::string command = fmt::format("map '{}' -o '{}' --quiet", drive(), map());
  ASSERT_EQ(run_fovea(command).exit_code, 0);
  const ProgramRun other = run_fovea(command + " --resume --no-imu");
  EXPECT_NE(other.exit_code, 0);
  EXPECT_THAT(other.err, HasSubstr("made with an IMU"));
}

}  // namespace fovea::imu_program_test
