// Drives with a drive.toml from the simulator through the program: mapped, scored, refused.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

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
