// LiDARs with rings 2 degrees apart, by the program: poses, moving objects, lost tracking.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "fovea/simulation/simulate.h"
#include "tests/kitti_sample.h"
#include "tests/program.h"

namespace fovea::sparse_lidar_program_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

class SparseLidar : public testing::Test {
 protected:
  /// A drive of a VLP-16, with small images.
  fs::path drive(Scene scene, int frames) const {
    SimulationOptions options = simulation_options(scene, "default");
    options.seed = 7;
    options.frames = frames;
    options.format = DriveFormat::kGeneric;
    set_model(options.lidar, LidarModel::kVlp16);
    options.camera.cameras = {kitti_camera(2)};
    options.camera.width = 320;
    options.camera.height = 96;
    options.camera.focal = 185;
    options.camera.cx = 159.5;
    options.camera.cy = 44;
    simulate(options, scratch_ / "drive");
    return scratch_ / "drive";
  }

  /// Maps a drive and scores it against the truth.
  nlohmann::json scores(const fs::path& drive, const std::string& more = "") const {
    const fs::path map = scratch_ / "map.fovea", report = scratch_ / "scores.json";
    const ProgramRun mapped =
        run_fovea(fmt::format("map '{}' -o '{}' --force {}", drive.string(), map.string(), more));
    EXPECT_EQ(mapped.exit_code, 0) << mapped.err;
    const ProgramRun scored = run_fovea(fmt::format("evaluate '{}' '{}' --truth --json '{}'",
                                                    map.string(), drive.string(), report.string()));
    EXPECT_EQ(scored.exit_code, 0) << scored.err;
    return nlohmann::json::parse(read_text(report));
  }
  static double pose_error(const nlohmann::json& scores) {
    return scores.at("pose_aligned_m").at("mean").get<double>();
  }

  TemporaryFolder scratch_;
};

TEST_F(SparseLidar, AnOpenPlaceIsNoWorseThanNavigation) {
  const fs::path square = drive(Scene::kPlaza, 14);
  const double registered = pose_error(scores(square));
  EXPECT_LT(registered, 0.02);
  EXPECT_LT(registered, pose_error(scores(square, "--poses navigation")));
}

TEST_F(SparseLidar, AnOpenPlaceIsMappedWithoutNavigation) {
  const fs::path square = drive(Scene::kPlaza, 14);
  fs::remove(square / "gnss.csv");
  EXPECT_LT(pose_error(scores(square)), 0.02);
}

TEST_F(SparseLidar, MovingObjectsLeaveTheMap) {
  const nlohmann::json traffic = scores(drive(Scene::kTraffic, 40));
  EXPECT_LT(traffic.at("ghost_share").get<double>(), 0.015);
  EXPECT_GT(traffic.at("completeness_5cm").get<double>(), 0.85);
}

// Every fifth frame of KITTI's drive, without navigation: 5.5 m from scan to scan.
TEST_F(SparseLidar, ADriveAt2HzWithoutNavigationIsTracked) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(sample);
  const fs::path date = scratch_ / "2011_09_26", copy = date / sample.filename();
  fs::create_directories(copy);
  for (const auto& entry : fs::directory_iterator(sample.parent_path())) {
    if (entry.path().extension() == ".txt") {
      fs::create_symlink(fs::canonical(entry.path()), date / entry.path().filename());
    }
  }
  for (const fs::path sensor : {"velodyne_points", "image_02"}) {
    fs::create_directories(copy / sensor / "data");
    for (const auto& entry : fs::directory_iterator(sample / sensor)) {
      if (entry.path().extension() != ".txt") continue;
      fs::create_symlink(fs::canonical(entry.path()), copy / sensor / entry.path().filename());
    }
    for (const auto& entry : fs::directory_iterator(sample / sensor / "data")) {
      if (std::stoi(entry.path().stem().string()) % 5 != 0) continue;
      fs::create_symlink(fs::canonical(entry.path()),
                         copy / sensor / "data" / entry.path().filename());
    }
  }
  const fs::path map = scratch_ / "map.fovea", poses = scratch_ / "poses.txt";
  const ProgramRun run = run_fovea(fmt::format("map '{}' -o '{}'", copy.string(), map.string()));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out + run.err, testing::Not(HasSubstr("tracking is lost")));
  ASSERT_EQ(
      run_fovea(fmt::format("export '{}' '{}' --format kitti-poses", map.string(), poses.string()))
          .exit_code,
      0);
  // The vehicle drives 54.9 m, nearly straight.
  std::ifstream lines(poses);
  std::vector<Eigen::Vector3d> places;
  for (std::array<double, 12> row; lines >> row[0];) {
    for (std::size_t i = 1; i < row.size(); ++i) lines >> row[i];
    places.emplace_back(row[3], row[7], row[11]);
  }
  ASSERT_GE(places.size(), 51u);
  EXPECT_NEAR((places[50] - places[0]).norm(), 54.9, 0.2);
}

}  // namespace fovea::sparse_lidar_program_test
