// fovea calibrate: a hand-held rig whose camera and IMU sit and tick otherwise than its drive says.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/drive/frame_source.h"
#include "fovea/simulation/simulate.h"
#include "tests/program.h"

namespace fovea::calibrate_command_test {

using testing::HasSubstr;
namespace fs = std::filesystem;

const Eigen::Vector3d kCameraTurn(2, -1.5, 1.5);  // degrees, simulated as turns of the camera
const Eigen::Vector3d kImuTurn(1.5, -2, 1.5);     // degrees
constexpr double kCameraDelay = 0.05, kImuDelay = -0.05;  // s

/// 60 frames of a walk with turns, without GPS/INS.
class CalibrateCommand : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    SimulationOptions options = simulation_options(Scene::kStreet, "default");
    options.seed = 3;
    options.frames = 60;
    options.format = DriveFormat::kGeneric;
    options.vehicle.carrier = Carrier::kWalker;
    options.vehicle.speed = 1.4;
    options.vehicle.turn_rate = 60 * kDegree;
    options.lidar.height = 1.5;
    options.imu.rate = 200;
    options.imu.rotation_error = kImuTurn * kDegree;
    options.imu.time_offset = -kImuDelay;
    options.camera.cameras = {kitti_camera(2)};
    options.camera.width = 620;
    options.camera.height = 300;
    options.camera.focal = 360;
    options.camera.cx = 305;
    options.camera.cy = 150;
    options.camera.rotation_error = kCameraTurn * kDegree;
    options.camera.trigger_delay = kCameraDelay;
    simulate(options, *scratch_ / "rig");
    fs::remove(*scratch_ / "rig" / "gnss.csv");
  }
  static void TearDownTestSuite() { delete scratch_; }

  static std::string drive() { return (*scratch_ / "rig").string(); }
  std::string own(const char* name) const { return (own_ / name).string(); }
  ProgramRun calibrate(const std::string& more = "") const {
    return run_fovea(fmt::format("calibrate '{}' -o '{}' --json '{}' {}", drive(), own("right"),
                                 own("values.json"), more));
  }

  static TemporaryFolder* scratch_;
  TemporaryFolder own_;
};
TemporaryFolder* CalibrateCommand::scratch_ = nullptr;

double degrees_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return rotation_angle(a.transpose() * b) / kDegree;
}

TEST_F(CalibrateCommand, FindsHowCameraAndImuSit) {
  const ProgramRun run = calibrate();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("camera 2: corrected, edges lay "));
  EXPECT_THAT(run.out, HasSubstr("IMU: rotation "));
  const auto json = nlohmann::json::parse(read_text(own("values.json")));
  const auto& camera = json.at("calibration").at(0);
  EXPECT_NEAR(camera.at("time_offset_ms"), 1e3 * kCameraDelay, 3);
  EXPECT_EQ(json.at("imu_calibration").at("observable_directions"), 3);
  EXPECT_NEAR(json.at("imu_calibration").at("time_offset_ms"), 1e3 * kImuDelay, 1);

  // The written drive has the true calibration, to which a second run adds next to nothing.
  const auto given = open_drive(drive(), {}), right = open_drive(own("right"), {});
  const RigidMotion& T_lidar_imu = given->info().imu->T_lidar_imu;
  EXPECT_NEAR(degrees_between(T_lidar_imu.linear(), right->info().imu->T_lidar_imu.linear()),
              kImuTurn.norm(), 0.1);
  EXPECT_NEAR(degrees_between(given->info().calibration.cameras[0].T_cam_lidar.linear(),
                              right->info().calibration.cameras[0].T_cam_lidar.linear()),
              kCameraTurn.norm(), 0.15);
  const ProgramRun again = run_fovea(fmt::format("calibrate '{}' -o '{}' --json '{}'", own("right"),
                                                 own("again"), own("again.json")));
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const auto rest = nlohmann::json::parse(read_text(own("again.json"))).at("calibration").at(0);
  EXPECT_LT(rest.at("pixels"), 1);

  const std::string page = read_text(own("right/calibration.html"));
  EXPECT_THAT(page, HasSubstr("data:image/jpeg"));
  EXPECT_EQ(run_fovea(fmt::format("map '{}' -o '{}' --frames 0:10", own("right"), own("a.fovea")))
                .exit_code,
            0);
}

TEST_F(CalibrateCommand, WritesTheSameAtAnyNumberOfThreads) {
  ASSERT_EQ(calibrate("--threads 1 --frames 0:20").exit_code, 0);
  const std::string one = read_text(own("right/drive.toml"));
  ASSERT_EQ(calibrate("--threads 2 --frames 0:20 --force").exit_code, 0);
  EXPECT_EQ(read_text(own("right/drive.toml")), one);
}

TEST_F(CalibrateCommand, ReplacesNoDrive) {
  const ProgramRun onto_itself =
      run_fovea(fmt::format("calibrate '{0}' -o '{0}' --force", drive()));
  EXPECT_EQ(onto_itself.exit_code, 1);
  fs::create_directory(own("right"));
  std::ofstream(own("right/drive.toml")) << "version = 1\n[lidar]\n";
  const ProgramRun run = calibrate("--force");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("drive.toml"));
  EXPECT_FALSE(fs::exists(own("right/calibration.html")));
}

}  // namespace fovea::calibrate_command_test
