// Drives that say less than KITTI's, or say it wrongly: no camera, no point times, millimeters.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

#include "fovea/evaluation/truth_poses.h"
#include "fovea/geometry/kd_tree.h"
#include "fovea/geometry/pose_file.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/map/map_store.h"
#include "fovea/simulation/simulate.h"
#include "fovea/world/surface_index.h"
#include "fovea/world/world_file.h"
#include "tests/kitti_writer.h"
#include "tests/program.h"
#include "tests/synthetic_drive.h"

namespace fovea::scans_alone_program_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

namespace fs = std::filesystem;

/// A yard between walls, with boxes in it.
BoxScene yard() {
  return {{{{-14, -9, -1.7}, {14, 9, 8}},
           {{4, 2, -1.7}, {6, 5, 0.3}},
           {{-7, -6, -1.7}, {-5, -4, 1.3}},
           {{7, -7, -1.7}, {8, -3, 0.8}}}};
}

class ScansAloneProgram : public testing::Test {
 protected:
  std::string quoted(const std::string& name) const {
    return fmt::format("'{}'", (folder_ / name).string());
  }
  ProgramRun succeed(const std::string& command) const {
    ProgramRun run = run_fovea(command);
    EXPECT_EQ(run.exit_code, 0) << command << "\n" << run.err;
    return run;
  }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }

  /// Scans of the yard, 0.3 m apart along x, with intensities of 51 of 255.
  void write_yard(const std::string& drive, const std::string& toml) const {
    write(drive + "/drive.toml", toml);
    for (int i = 0; i < kYardFrames; ++i) {
      std::string scan;
      for (int ring = 0; ring < 32; ++ring) {
        for (int column = 0; column < 360; ++column) {
          const double elevation = (ring - 20) * 1.2 * std::numbers::pi / 180,
                       azimuth = column * std::numbers::pi / 180;
          const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                    std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
          const double range = yard().cast({0.3 * i, 0, 0}, ray).value();
          const Eigen::Vector3f p = (range * ray).cast<float>();
          const std::array<float, 4> row{p.x(), p.y(), p.z(), 51};
          scan.append(reinterpret_cast<const char*>(row.data()), sizeof row);
        }
      }
      write(fmt::format("{}/lidar/{:06}.bin", drive, i), scan);
    }
  }
  std::vector<FrameRecord> frames_of(const std::string& map) const {
    return MapReader(folder_ / map).frames();
  }

  static constexpr int kYardFrames = 3;
  TemporaryFolder folder_;
};

TEST_F(ScansAloneProgram, ADriveWithoutCamerasBecomesAMapWithoutColors) {
  write_yard("yard", "version = 1\n[lidar]\ncompensated = true\n");
  const ProgramRun mapped = succeed("map " + quoted("yard") + " -o " + quoted("yard.fovea"));
  EXPECT_THAT(mapped.out, AllOf(HasSubstr("note: the drive has no camera"),
                                HasSubstr("note: intensities exceed 1; assumed: 255")));
  const std::vector<FrameRecord> frames = frames_of("yard.fovea");
  ASSERT_EQ(frames.size(), std::size_t(kYardFrames));
  for (int i = 1; i < kYardFrames; ++i) {
    const Eigen::Vector3d step = frames[std::size_t(i)].T_local_lidar.translation() -
                                 frames[std::size_t(i - 1)].T_local_lidar.translation();
    EXPECT_LT((step - Eigen::Vector3d(0.3, 0, 0)).norm(), 2e-3);
  }
  const PointCloud points = MapReader(folder_ / "yard.fovea").all_points_local();
  ASSERT_GT(points.size(), 100'000u);
  std::size_t off = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(points.camera[i], kNoCamera);
    ASSERT_NEAR(points.intensity[i], 0.2, 1e-5);
    off += yard().distance(points.origin + points.position[i].cast<double>()) > 0.05;
  }
  EXPECT_LT(double(off), 0.02 * double(points.size()));
}

TEST_F(ScansAloneProgram, TheSmallestDriveIsScansAlone) {
  write_yard("yard", "version = 1\n");
  const ProgramRun mapped = succeed("map " + quoted("yard") + " -o " + quoted("yard.fovea"));
  EXPECT_THAT(mapped.err, AllOf(HasSubstr("stamps.csv is missing: scans are counted as 10 Hz"),
                                HasSubstr("the points have no times; assumed: a sweep takes 0.1 s "
                                          "(default)")));
  const std::vector<FrameRecord> frames = frames_of("yard.fovea");
  for (int i = 0; i < kYardFrames; ++i) {
    const Eigen::Vector3d place = frames.at(std::size_t(i)).T_local_lidar.translation();
    EXPECT_LT((place - Eigen::Vector3d(0.3 * i, 0, 0)).norm(), 0.02);
  }
  const ProgramRun localized =
      succeed("localize " + quoted("yard") + " " + quoted("yard.fovea") + " -o " + quoted("p.csv"));
  EXPECT_THAT(localized.out, HasSubstr("of 3 frames"));
}

TEST_F(ScansAloneProgram, CamerasThatSeeNoPointAreAnErrorAndLeaveNoMap) {
  // The camera looks up, where the yard has no roof within the LiDAR's elevations.
  write_yard("yard",
             "version = 1\n[camera.up]\nindex = 0\nwidth = 32\nheight = 24\n"
             "K = [32, 0, 15.5, 0, 32, 11.5, 0, 0, 1]\n"
             "T_cam_lidar = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\n");
  for (int i = 0; i < kYardFrames; ++i) {
    write_png(folder_ / fmt::format("yard/images/up/{}.png", i), Image(32, 24, 3));
  }
  const ProgramRun run = run_fovea("map " + quoted("yard") + " -o " + quoted("x.fovea"));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, AllOf(StartsWith("fovea: error: no camera sees a point of 3 scans"),
                             HasSubstr("T_cam_lidar")));
  EXPECT_FALSE(fs::exists(folder_ / "x.fovea"));
  succeed("map " + quoted("yard") + " --cameras none -o " + quoted("x.fovea"));
}

TEST_F(ScansAloneProgram, EveryCommandTakesAMapWithoutColors) {
  write_yard("yard", "version = 1\n[lidar]\ncompensated = true\n");
  const std::string map = quoted("yard.fovea"), drive = quoted("yard");
  succeed("map " + drive + " -o " + map + " --hold-out 3:1 --quiet");
  EXPECT_THAT(succeed("info " + map).out, HasSubstr("2 mapped, 1 held out"));
  const ProgramRun scores =
      succeed("evaluate " + map + " " + drive + " --json " + quoted("e.json"));
  EXPECT_THAT(scores.out, HasSubstr("the map has no colors"));
  const auto json = nlohmann::json::parse(read_text(folder_ / "e.json"));
  EXPECT_LT(json.at("me_mean").get<double>(), 0.03);
  EXPECT_GT(json.at("coverage_5cm").get<double>(), 0.9);
  EXPECT_TRUE(json.at("te_mean").is_null());
  for (const char* file : {"m.ply", "m.pcd", "m.las", "m.glb"}) {
    EXPECT_THAT(succeed("export " + map + " " + quoted(file)).out, HasSubstr("no colors")) << file;
    EXPECT_GT(fs::file_size(folder_ / file), 1000u) << file;
  }
  succeed("export " + map + " " + quoted("tiles") + " --format 3dtiles");
  succeed("render " + map + " -o " + quoted("m.png"));
  succeed("localize " + drive + " " + map + " -o " + quoted("p.csv"));
  EXPECT_THAT(read_text(folder_ / "p.csv"), HasSubstr("2,200000000,localized"));
  succeed("register " + quoted("yard/lidar/000001.bin") + " " + quoted("yard/lidar/000000.bin"));
}

TEST_F(ScansAloneProgram, WhatNeedsCamerasIsRefusedInOneLine) {
  write_yard("yard", "version = 1\n");
  const std::string map = quoted("yard.fovea"), drive = quoted("yard");
  succeed("map " + drive + " -o " + map + " --quiet");
  for (const std::string& command :
       {"map " + drive + " --cameras 2 -o " + quoted("x.fovea"),
        "map " + drive + " --variant E1 -o " + quoted("x.fovea"),
        "map " + drive + " --calibrate -o " + quoted("x.fovea"),
        "recolor " + map + " " + drive + " -o " + quoted("x.fovea"),
        "render " + map + " " + drive + " -o " + quoted("x.png"),
        "evaluate " + map + " " + drive + " --protocol in-sample --html " + quoted("x.html"),
        "evaluate " + map + " " + drive + " --protocol cross-camera --hold-out 3:1"}) {
    const ProgramRun run = run_fovea(command);
    EXPECT_EQ(run.exit_code, 1) << command;
    EXPECT_THAT(run.err, StartsWith("fovea: error: ")) << command;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
  EXPECT_FALSE(fs::exists(folder_ / "x.fovea"));
}

TEST_F(ScansAloneProgram, ACameraHundredsOfMetersAwayIsAnError) {
  write_yard("yard",
             "version = 1\n[lidar]\nintensity_max = 255\n[camera.front]\nindex = 0\nwidth = 320\n"
             "height = 240\nK = [160, 0, 160, 0, 160, 120, 0, 0, 1]\n"
             "T_cam_lidar = [[0, -1, 0, 57.5], [0, 0, -1, -78.2], [1, 0, 0, 266.1]]\n");
  const ProgramRun run = run_fovea("map " + quoted("yard") + " -o " + quoted("x.fovea"));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, AllOf(HasSubstr("camera.front.T_cam_lidar"), HasSubstr("283.25 m"),
                             HasSubstr("millimeters")));
  EXPECT_FALSE(fs::exists(folder_ / "x.fovea"));
}

/// A simulated street whose points have no times.
class SweepsWithoutTimes : public ScansAloneProgram {
 protected:
  SweepsWithoutTimes() {
    SimulationOptions options = simulation_options(Scene::kStreet, "default");
    options.seed = 5;
    options.frames = kFrames;
    options.format = DriveFormat::kGeneric;
    options.lidar.point_times = false;
    options.camera.cameras = {kitti_camera(2)};
    options.camera.width = 480;
    options.camera.height = 160;
    options.camera.focal = 270;
    options.camera.cx = 238.5;
    options.camera.cy = 72.25;
    simulate(options, folder_ / "street");
    truth_ = read_poses(folder_ / "street/truth/poses.txt");
  }

  void state(const std::string& keys) const {
    const std::string text = read_text(folder_ / "street/drive.toml");
    std::string stated = text;
    stated.insert(stated.find("[lidar]\n") + 8, keys);
    write("street/drive.toml", stated);
  }
  /// Rewrites the table of stamps: new index and nanoseconds later, of the lines that stay.
  void rewrite_stamps(const std::string& table,
                      const std::function<std::optional<int>(int)>& renumbered,
                      TimeNs later) const {
    std::stringstream lines(read_text(folder_ / table));
    std::string text, line;
    std::getline(lines, line);
    text = line + "\n";
    while (std::getline(lines, line)) {
      const std::size_t comma = line.find(',');
      const auto index = renumbered(std::stoi(line.substr(0, comma)));
      if (index) text += fmt::format("{},{}\n", *index, std::stoll(line.substr(comma + 1)) + later);
    }
    write(table, text);
  }
  /// Leaves every second frame, as if the LiDAR's other sweeps had not been recorded.
  void thin() const {
    const auto half = [](int i) { return i % 2 == 0 ? std::optional(i / 2) : std::nullopt; };
    for (const auto& [pattern, table] :
         {std::pair("street/lidar/{:06}.pcd", "street/lidar/stamps.csv"),
          {"street/images/camera_2/{:06}.png", "street/images/camera_2/stamps.csv"}}) {
      rewrite_stamps(table, half, 0);
      for (int i = 0; i < kFrames; ++i) {
        const fs::path from = folder_ / fmt::format(fmt::runtime(pattern), i);
        if (half(i)) {
          fs::rename(from, folder_ / fmt::format(fmt::runtime(pattern), *half(i)));
        } else {
          fs::remove(from);
        }
      }
    }
  }
  std::string map_note() const {
    const ProgramRun run =
        succeed("map " + quoted("street") + " --force -o " + quoted("street.fovea"));
    std::stringstream lines(run.out + run.err);
    std::string line, notes;
    int count = 0;
    while (std::getline(lines, line)) {
      if (line.find("the points have no times") == std::string::npos) continue;
      notes += line;
      ++count;
    }
    EXPECT_EQ(count, 1) << run.out;
    return notes;
  }
  /// The map's points in the truth's frame.
  /// @param T_true_lidar  at the stamps of the map's frames
  PointCloud points_true(const std::vector<RigidMotion>& T_true_lidar) const {
    const MapReader map(folder_ / "street.fovea");
    std::vector<PosePair> pairs;
    for (const FrameRecord& frame : map.frames()) {
      pairs.push_back(
          {frame.index, T_true_lidar.at(std::size_t(frame.index)), frame.T_local_lidar});
    }
    return transform_cloud(map.all_points_local(), align_trajectories(pairs));
  }
  /// Share of the points within 2 cm of a true surface.
  double precision(const PointCloud& points) const {
    const World world = read_world(folder_ / "street/truth");
    const SurfaceIndex surfaces(world.mesh_local);
    std::size_t near = 0, all = 0;
    for (std::size_t i = 0; i < points.size(); i += kStride) {
      const Eigen::Vector3d p = points.position[i].cast<double>();
      near += (surfaces.nearest(p).position - p).norm() < 0.02;
      ++all;
    }
    return double(near) / double(all);
  }
  /// Mean difference of colors between points of two maps that are at most 1 cm apart.
  static double color_difference(const PointCloud& a, const PointCloud& b) {
    const KdTree tree(b.position);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); i += kStride) {
      const KdTree::Neighbor nearest = tree.nearest(a.position[i]);
      if (nearest.squared_distance > 1e-4f) continue;
      sum += double((to_float(a.color[i]) - to_float(b.color[nearest.index])).norm());
      ++count;
    }
    EXPECT_GT(count, 1000u);
    return sum / double(count);
  }

  static constexpr std::size_t kStride = 20;  // of the points that are looked at
  static constexpr int kFrames = 12;
  std::vector<RigidMotion> truth_;
};

TEST_F(SweepsWithoutTimes, AThinnedDriveNamesTheAssumedPeriodAndAKeyCorrectsIt) {
  thin();
  std::vector<RigidMotion> T_true_lidar;
  for (std::size_t i = 0; i < truth_.size(); i += 2) T_true_lidar.push_back(truth_[i]);
  EXPECT_THAT(map_note(),
              AllOf(HasSubstr("takes 0.2068 s (step of the stamps)"), HasSubstr("sweep_period_s")));
  const double assumed = precision(points_true(T_true_lidar));
  state("sweep_period_s = 0.1034\n");
  EXPECT_THAT(map_note(), HasSubstr("takes 0.1034 s (drive.toml)"));
  const double stated = precision(points_true(T_true_lidar));
  EXPECT_GT(stated, 0.95);
  EXPECT_LT(assumed, stated - 0.04);
}

TEST_F(SweepsWithoutTimes, AStampAtTheSweepsEndIsStatedByAKey) {
  map_note();
  const PointCloud middle = points_true(truth_);
  rewrite_stamps("street/lidar/stamps.csv", [](int i) { return std::optional(i); }, 51'700'000);
  EXPECT_THAT(map_note(),
              AllOf(HasSubstr("stamp at 0.5 of the sweep (default)"), HasSubstr("stamp_phase")));
  const PointCloud assumed = points_true(truth_);
  state("stamp_phase = 1\n");
  EXPECT_THAT(map_note(), HasSubstr("stamp at 1 of the sweep (drive.toml)"));
  // Half a sweep later the LiDAR was half-way to the next frame.
  std::vector<RigidMotion> T_true_lidar;
  for (std::size_t i = 0; i < truth_.size(); ++i) {
    const std::size_t from = std::min(i, truth_.size() - 2);
    const Twist step = log_se3(truth_[from].inverse() * truth_[from + 1]);
    T_true_lidar.push_back(truth_[i] * exp_se3(0.5 * step));
  }
  const PointCloud stated = points_true(T_true_lidar);
  EXPECT_GT(precision(stated), precision(middle) - 0.02);
  const double difference = color_difference(stated, middle);
  EXPECT_LT(difference, 5);
  EXPECT_GT(color_difference(assumed, middle), 2 * difference);
}

}  // namespace fovea::scans_alone_program_test
