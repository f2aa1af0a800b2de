// Several LiDARs on one vehicle, by the program: poses and surfaces against the truth.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "fovea/map/map_store.h"
#include "fovea/simulation/simulate.h"
#include "tests/program.h"

namespace fovea::several_lidars_program_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A VLP-16 on the roof, and others that are tilted and scan at other times.
LidarOptions roof() {
  LidarOptions lidar;
  set_model(lidar, LidarModel::kVlp16);
  return lidar;
}

FurtherLidarOptions left() {
  FurtherLidarOptions further{roof(), /*forward=*/0.9, /*left=*/0.7, /*stamp_offset=*/0.03};
  further.lidar.height = 1.4;
  further.lidar.roll = -25 * kDegree;
  return further;
}

FurtherLidarOptions right() {
  FurtherLidarOptions further{roof(), /*forward=*/-0.9, /*left=*/-0.7, /*stamp_offset=*/-0.04};
  further.lidar.height = 1.5;
  further.lidar.roll = 20 * kDegree;
  further.lidar.yaw = 170 * kDegree;
  return further;
}

class SeveralLidars : public testing::Test {
 protected:
  /// Scores of the map of a drive with these LiDARs against the truth. The map stays at map().
  nlohmann::json scores(const LidarOptions& first,
                        const std::vector<FurtherLidarOptions>& further) const {
    SimulationOptions options = simulation_options(Scene::kStreet, "default");
    options.seed = 3;
    options.frames = 30;
    options.format = DriveFormat::kGeneric;
    options.lidar = first;
    options.further_lidars = further;
    options.camera.cameras = {kitti_camera(2)};
    options.camera.width = 414;
    options.camera.height = 125;
    options.camera.focal = 240.5;
    options.camera.cx = 203.2;
    options.camera.cy = 57.6;
    fs::remove_all(drive());
    simulate(options, drive());
    const ProgramRun mapped = run_fovea(
        fmt::format("map '{}' -o '{}' --force --quiet", drive().string(), map().string()));
    EXPECT_EQ(mapped.exit_code, 0) << mapped.err;
    const fs::path report = scratch_ / "scores.json";
    const ProgramRun scored =
        run_fovea(fmt::format("evaluate '{}' '{}' --truth --json '{}'", map().string(),
                              drive().string(), report.string()));
    EXPECT_EQ(scored.exit_code, 0) << scored.err;
    return nlohmann::json::parse(read_text(report));
  }

  /// Differences between the heights at which LiDAR `sensor` and the first one have the road, in
  /// m, of cells of 0.5 m.
  std::vector<double> height_steps(std::uint16_t sensor) const {
    struct Cell {
      double sum[2] = {0, 0}, low = 1e9, high = -1e9;
      int count[2] = {0, 0};
    };
    constexpr double kSize = 0.5, kFlat = 0.15;
    constexpr int kEnough = 15;
    std::map<std::pair<int, int>, Cell> cells;
    const PointCloud points = MapReader(map()).all_points_local();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points.sensor[i] != 0 && points.sensor[i] != sensor) continue;
      const Eigen::Vector3f& p = points.position[i];
      Cell& cell = cells[{int(std::floor(p.x() / kSize)), int(std::floor(p.y() / kSize))}];
      const int which = points.sensor[i] == 0 ? 0 : 1;
      cell.sum[which] += p.z();
      ++cell.count[which];
      cell.low = std::min(cell.low, double(p.z()));
      cell.high = std::max(cell.high, double(p.z()));
    }
    std::vector<double> steps;
    for (const auto& [place, cell] : cells) {
      const bool is_flat = cell.high - cell.low < kFlat;
      if (!is_flat || cell.count[0] < kEnough || cell.count[1] < kEnough) continue;
      steps.push_back(cell.sum[1] / cell.count[1] - cell.sum[0] / cell.count[0]);
    }
    std::sort(steps.begin(), steps.end());
    return steps;
  }
  void expect_no_seam(std::uint16_t sensor) const {
    const std::vector<double> steps = height_steps(sensor);
    ASSERT_GT(steps.size(), 30u);
    EXPECT_LT(std::abs(steps[steps.size() / 2]), 0.003) << "LiDAR " << sensor;
    EXPECT_LT(steps[steps.size() * 95 / 100], 0.02) << "LiDAR " << sensor;
    EXPECT_GT(steps[steps.size() * 5 / 100], -0.02) << "LiDAR " << sensor;
  }

  fs::path drive() const { return scratch_ / "drive"; }
  fs::path map() const { return scratch_ / "map.fovea"; }
  static double pose_error(const nlohmann::json& scores) {
    return scores.at("pose_aligned_m").at("mean").get<double>();
  }
  static double precision(const nlohmann::json& scores) {
    return scores.at("precision_5cm").get<double>();
  }
  static double completeness(const nlohmann::json& scores) {
    return scores.at("completeness_5cm").get<double>();
  }

  TemporaryFolder scratch_;
};

TEST_F(SeveralLidars, TwoAndThreeAreAsGoodAsTheBestOfThem) {
  LidarOptions tilted = left().lidar;
  const nlohmann::json alone = scores(roof(), {}), tilted_alone = scores(tilted, {});
  const double best_pose = std::min(pose_error(alone), pose_error(tilted_alone));
  const double best_precision = std::max(precision(alone), precision(tilted_alone));
  const double best_completeness = std::max(completeness(alone), completeness(tilted_alone));
  for (const auto& further :
       {std::vector{left()}, std::vector<FurtherLidarOptions>{left(), right()}}) {
    const nlohmann::json together = scores(roof(), further);
    EXPECT_LE(pose_error(together), 1.1 * best_pose + 0.001);
    EXPECT_GE(precision(together), best_precision - 0.01);
    EXPECT_GE(completeness(together), best_completeness);
    for (std::size_t k = 1; k <= further.size(); ++k) expect_no_seam(std::uint16_t(k));
  }
  // The three of them.
  const std::vector<SensorRecord> sensors = MapReader(map()).sensors();
  ASSERT_EQ(sensors.size(), 3u);
  EXPECT_NEAR(sensors[1].profile.height.value_or(0), left().lidar.height, 0.1);
  EXPECT_THAT(run_fovea("check '" + drive().string() + "'").out,
              testing::AllOf(HasSubstr("lidar_1: 16 rings"), HasSubstr("lidar_3: ")));
  // Commands that read scans or the map's points again.
  for (const std::string& command :
       {fmt::format("recolor '{}' '{}' -o '{}'", map().string(), drive().string(),
                    (scratch_ / "recolored.fovea").string()),
        fmt::format("evaluate '{}' '{}' --truth --html '{}'", map().string(), drive().string(),
                    (scratch_ / "page.html").string()),
        fmt::format("export '{}' '{}'", map().string(), (scratch_ / "mesh.glb").string()),
        fmt::format("map '{}' -o '{}' --force --preset paper --frames 0:6", drive().string(),
                    map().string())}) {
    const ProgramRun run = run_fovea(command);
    EXPECT_EQ(run.exit_code, 0) << command << "\n" << run.err;
  }
}

}  // namespace fovea::several_lidars_program_test
