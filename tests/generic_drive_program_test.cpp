// Drives with a drive.toml from the simulator through the program: mapped, scored, refused.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "fovea/core/cloud_columns.h"
#include "fovea/map/map_store.h"
#include "fovea/simulation/simulate.h"
#include "tests/program.h"

namespace fovea::generic_drive_program_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// A street with smaller images than usual.
SimulationOptions small_street(int frames) {
  SimulationOptions options = simulation_options(Scene::kStreet, "default");
  options.frames = frames;
  options.camera.width = 480;
  options.camera.height = 160;
  options.camera.focal = 270;
  options.camera.cx = 238.5;
  options.camera.cy = 72.25;
  return options;
}

class GenericDriveProgram : public testing::Test {
 protected:
  std::string quoted(const std::string& name) const {
    return fmt::format("'{}'", (folder_ / name).string());
  }
  void map(const std::string& drive, const std::string& output, const std::string& more) const {
    const ProgramRun run =
        run_fovea("map " + quoted(drive) + " -o " + quoted(output) + " --quiet " + more);
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  void expect_refused(const std::string& drive, const std::string& more,
                      const std::string& why) const {
    const ProgramRun run =
        run_fovea("map " + quoted(drive) + " -o " + quoted("none.fovea") + " " + more);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, AllOf(StartsWith("fovea: error: "), HasSubstr(why)));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "none.fovea"));
  }

  TemporaryFolder folder_;
};

TEST_F(GenericDriveProgram, TheSameDriveInEitherFormatGivesTheSameMap) {
  SimulationOptions options = small_street(8);
  options.camera.cameras = {kitti_camera(2), kitti_camera(3)};
  options.lidar.point_times = false;  // which KITTI's format cannot say
  simulate(options, folder_ / "kitti");
  options.format = DriveFormat::kGeneric;
  simulate(options, folder_ / "generic");
  for (const char* drive : {"kitti", "generic"}) {
    map(drive, std::string(drive) + ".fovea", "--cameras 2,3");
  }
  // Not the same digest: that is of the drive's name, too, and of all digits of the poses, of which
  // the last differ because KITTI's calibration is a product of matrices.
  const MapReader kitti(folder_ / "kitti.fovea"), generic(folder_ / "generic.fovea");
  const PointCloud a = kitti.all_points_local(), b = generic.all_points_local();
  EXPECT_GT(a.size(), 100'000u);
  EXPECT_LT((a.origin - b.origin).norm(), 1e-9);
  EXPECT_EQ(a.position, b.position);
  for_each_optional_column(a, b, [](const char* name, const auto& column_a, const auto& column_b) {
    // NaN is not equal to itself; bytes are.
    ASSERT_EQ(column_a.size(), column_b.size()) << name;
    EXPECT_EQ(std::memcmp(column_a.data(), column_b.data(), column_a.size() * sizeof(column_a[0])),
              0)
        << name;
  });
}

/// Which image of a camera at 20 Hz belongs to a scan of a LiDAR at 10 Hz.
enum class Trigger {
  kSynchronized,  ///< the one at the scan's stamp
  kFreeRunning,   ///< that one, or of every third scan the one 50 ms before
  kMisdated,      ///< as kFreeRunning, but all stamped as the scans
};

/// Every second scan of a drive at 20 Hz, with the images that a trigger gives them.
void thin_to_10_hz(const std::filesystem::path& fast, const std::filesystem::path& drive, int scans,
                   Trigger trigger) {
  namespace fs = std::filesystem;
  fs::copy(fast, drive, fs::copy_options::recursive);
  std::vector<std::string> times;
  std::ifstream stamps(fast / "lidar/stamps.csv");
  for (std::string line; std::getline(stamps, line);) {
    times.push_back(line.substr(line.find(',') + 1));
  }
  times.erase(times.begin());  // the names of the columns
  fs::remove_all(drive / "lidar");
  fs::remove_all(drive / "images/camera_2");
  fs::create_directories(drive / "lidar");
  fs::create_directories(drive / "images/camera_2");
  std::ofstream scan_stamps(drive / "lidar/stamps.csv"),
      image_stamps(drive / "images/camera_2/stamps.csv");
  scan_stamps << "index,time_ns\n";
  image_stamps << "index,time_ns\n";
  for (int j = 0; j < scans; ++j) {
    const int scan = 2 * j,
              image = trigger != Trigger::kSynchronized && j % 3 == 1 ? scan - 1 : scan;
    const int stamped = trigger == Trigger::kMisdated ? scan : image;
    fs::copy(fast / fmt::format("lidar/{:06}.pcd", scan),
             drive / fmt::format("lidar/{:06}.pcd", j));
    fs::copy(fast / fmt::format("images/camera_2/{:06}.png", image),
             drive / fmt::format("images/camera_2/{:06}.png", j));
    scan_stamps << fmt::format("{},{}\n", j, times.at(std::size_t(scan)));
    image_stamps << fmt::format("{},{}\n", j, times.at(std::size_t(stamped)));
  }
}

TEST_F(GenericDriveProgram, AFreeRunningCameraColorsAsWellAsASynchronizedOne) {
  constexpr int kScans = 14;
  SimulationOptions options = small_street(2 * kScans);
  options.format = DriveFormat::kGeneric;
  options.lidar.period = 0.05;
  options.camera.cameras = {kitti_camera(2)};
  simulate(options, folder_ / "fast");
  const auto score = [&](const std::string& name, Trigger trigger) {
    thin_to_10_hz(folder_ / "fast", folder_ / name, kScans, trigger);
    map(name, name + ".fovea", "--hold-out 4:2");
    const ProgramRun run = run_fovea("evaluate " + quoted(name + ".fovea") + " " + quoted(name) +
                                     " --json " + quoted(name + ".json"));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return nlohmann::json::parse(read_text(folder_ / (name + ".json")));
  };
  const auto synchronized = score("synchronized", Trigger::kSynchronized);
  const auto free_running = score("free-running", Trigger::kFreeRunning);
  const auto misdated = score("misdated", Trigger::kMisdated);
  const double right = synchronized.at("te_mean"), within = synchronized.at("te_within_20");
  EXPECT_LT(free_running.at("te_mean"), 1.1 * right);
  EXPECT_GT(free_running.at("te_within_20"), within - 0.02);
  // Without the right stamps the same images do not.
  EXPECT_GT(misdated.at("te_mean"), 1.2 * right);
}

TEST_F(GenericDriveProgram, FiveCamerasAllRoundMakeOneMap) {
  SimulationOptions options = small_street(10);
  options.format = DriveFormat::kGeneric;
  options.camera.rig = CameraRig::kSurround;
  options.camera.cameras = rig_cameras(CameraRig::kSurround);
  simulate(options, folder_ / "around");
  map("around", "around.fovea", "--cameras 0,1,2,3,4 --hold-out 5:4");

  std::map<int, std::size_t> points;
  for (const auto camera : MapReader(folder_ / "around.fovea").all_points_local().camera) {
    ++points[camera];
  }
  for (int camera = 0; camera < 5; ++camera) EXPECT_GT(points[camera], 5'000u) << camera;

  const auto scores = [&](const std::string& more) {
    const ProgramRun run =
        run_fovea("evaluate " + quoted("around.fovea") + " " + quoted("around") +
                  " --cameras 0,1,2,3,4 " + more + " --json " + quoted("scores.json"));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const auto json = nlohmann::json::parse(read_text(folder_ / "scores.json"));
    std::filesystem::remove(folder_ / "scores.json");
    return json;
  };
  const auto truth = scores("--truth");
  // Points measured by a sweep while the vehicle drives lie on the surfaces: their times count.
  EXPECT_LT(truth.at("accuracy_measured_median").get<double>(), 0.012);
  EXPECT_LT(truth.at("accuracy_mean").get<double>(), 0.02);
  EXPECT_GT(truth.at("precision_5cm").get<double>(), 0.95);
  EXPECT_GT(truth.at("completeness_10cm").get<double>(), 0.9);
  // Colours are those that a pinhole camera would have seen, whatever the lens.
  EXPECT_LT(truth.at("color_view").at("gain_median").get<double>(), 10);
  scores("");
}

TEST_F(GenericDriveProgram, BadDrivesAreRefusedInOneLine) {
  SimulationOptions options = small_street(2);
  options.format = DriveFormat::kGeneric;
  options.lidar.columns = 90;
  simulate(options, folder_ / "d");
  const std::filesystem::path toml = folder_ / "d/drive.toml";
  const std::string right = read_text(toml);
  const auto rewrite = [&](const std::string& text) { std::ofstream(toml) << text; };

  expect_refused("d", "--cameras 5", "no camera 5");
  rewrite(right + "colour = 3\n");
  expect_refused("d", "", "unknown key");
  rewrite("[");
  expect_refused("d", "", "not valid TOML");
  rewrite(right);
  std::ofstream(folder_ / "d/gnss.csv") << "time,lat,lon\n";
  expect_refused("d", "", "gnss.csv:1");
  std::filesystem::remove_all(folder_ / "d/lidar");
  expect_refused("d", "", "the drive has no scan");
}

}  // namespace fovea::generic_drive_program_test
