// A drive rendered from a map of a scene whose every surface and colour is known.
#include "fovea/rendering/render_drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "../../../tests/synthetic_drive.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/images/image_decode.h"
#include "fovea/errors.h"
#include "fovea/pipeline/map_drive.h"

namespace fovea::render_drive_test {

namespace fs = std::filesystem;

class RenderDrive : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    MapJob job;
    job.output = *folder_ / "map.fovea";
    job.pose_source = PoseSource::kNavigation;
    job.settings.mapper().surface.spacing = 0.03;
    map_drive(driven(), job, {});
  }
  static void TearDownTestSuite() { delete folder_; }
  static SyntheticDrive driven() { return SyntheticDrive(street_scene(), 8, 1.0); }

  RenderJob job() const {
    RenderJob job;
    job.output = own_ / "drive";
    for (int i = 0; i < 3; ++i) {
      job.T_local_lidar.emplace_back(Eigen::Translation3d(3.3 + i, 0.3, 0.1));
    }
    job.cameras = {{"left", driven().info().calibration.cameras.front()}};
    job.lidar = lidar_pattern(LidarModel::kHdl64);
    return job;
  }
  static RenderFigures render(const RenderJob& job) {
    return render_drive(MapReader(*folder_ / "map.fovea"), job, [](int, int) {});
  }

  static TemporaryFolder* folder_;
  TemporaryFolder own_;
};
TemporaryFolder* RenderDrive::folder_ = nullptr;

TEST_F(RenderDrive, IsADriveThatIsReadAgainAndShowsTheScene) {
  const RenderJob wanted = job();
  const RenderFigures figures = render(wanted);
  EXPECT_EQ(figures.frames, 3u);
  EXPECT_EQ(figures.blank, 0u);
  EXPECT_GT(figures.covered, 0.4);
  const auto drive = open_drive(wanted.output, {});
  ASSERT_EQ(drive->info().end - drive->info().begin, 3);
  ASSERT_EQ(drive->info().calibration.cameras.size(), 1u);
  const Camera& camera = drive->info().calibration.cameras.front();
  EXPECT_TRUE(drive->info().sweep_compensated);
  const BoxScene scene = street_scene();
  for (int i = 0; i < 3; ++i) {
    const RigidMotion& T_local_lidar = wanted.T_local_lidar[std::size_t(i)];
    const RigidMotion T_local_cam = T_local_lidar * camera.T_cam_lidar.inverse();
    const Frame frame = std::get<Frame>(drive->load(i));
    ASSERT_GT(frame.scan.size(), 5000u);
    std::vector<double> off;
    for (const Eigen::Vector3f& p : frame.scan.position) {
      off.push_back(scene.distance(T_local_lidar * p.cast<double>()));
    }
    std::sort(off.begin(), off.end());
    EXPECT_LT(off[off.size() / 2], 0.004) << i;
    EXPECT_LT(off[off.size() * 95 / 100], 0.03) << i;

    const DepthImage depth =
        read_depth_image(wanted.output / "depth/left" / ("00000" + std::to_string(i) + ".png"));
    std::vector<double> depth_error, color_error;
    for (int v = 0; v < camera.height; v += 3) {
      for (int u = 0; u < camera.width; u += 3) {
        const double z = depth.at(u, v);
        if (z == 0) continue;
        const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
        const Eigen::Vector3d along = T_local_cam.linear() * ray.normalized();
        const auto hit = scene.cast(T_local_cam.translation(), along);
        ASSERT_TRUE(hit);
        depth_error.push_back(std::abs(*hit / ray.norm() - z));
        const Eigen::Vector3f truth = synthetic_color(T_local_cam.translation() + *hit * along);
        const std::uint8_t* pixel = frame.images.front().pixel(u, v);
        color_error.push_back(std::abs(double(pixel[0]) - truth.x()));
      }
    }
    std::sort(depth_error.begin(), depth_error.end());
    std::sort(color_error.begin(), color_error.end());
    ASSERT_GT(depth_error.size(), 5000u);
    EXPECT_LT(depth_error[depth_error.size() / 2], 0.02) << i;
    EXPECT_LT(color_error[color_error.size() / 2], 3) << i;
    EXPECT_LT(color_error[color_error.size() * 9 / 10], 15) << i;
  }
}

TEST_F(RenderDrive, HasTheNavigationThatItWasRenderedAt) {
  const RenderJob wanted = job();
  render(wanted);
  const auto drive = open_drive(wanted.output, {});
  ASSERT_TRUE(drive->info().navigation);
  for (int i = 0; i < 3; ++i) {
    const auto T_local_lidar = drive->info().navigation->at(*drive->stamp(i));
    ASSERT_TRUE(T_local_lidar);
    const RigidMotion& first = wanted.T_local_lidar.front();
    const RigidMotion moved =
        drive->info().navigation->at(*drive->stamp(0))->inverse() * *T_local_lidar;
    EXPECT_TRUE(moved.isApprox(first.inverse() * wanted.T_local_lidar[std::size_t(i)], 1e-9));
  }
}

TEST_F(RenderDrive, WhereTheMapHasNothingNothingIsShownAndThatIsTold) {
  RenderJob away = job();
  away.T_local_lidar = {RigidMotion(Eigen::Translation3d(0, 5000, 0))};
  const RenderFigures figures = render(away);
  EXPECT_EQ(figures.blank, 1u);
  EXPECT_EQ(figures.empty, 1u);
  EXPECT_EQ(figures.covered, 0);
  EXPECT_FALSE(fs::exists(away.output / "lidar/000000.bin"));
}

TEST_F(RenderDrive, ReplacesAnotherDriveIfAskedAndNothingElse) {
  RenderJob wanted = job();
  wanted.T_local_lidar.resize(1);
  render(wanted);
  EXPECT_THROW(render(wanted), OutputError);
  wanted.force = true;
  EXPECT_EQ(render(wanted).frames, 1u);
  std::ofstream(wanted.output / "my_thesis.tex") << "years of work";
  EXPECT_THROW(render(wanted), OutputError);
}

TEST_F(RenderDrive, WhatAKilledProgramLeftIsNotInTheWay) {
  const RenderJob wanted = job();
  const fs::path left = wanted.output.string() + ".partial";
  fs::create_directories(left / "depth/left");
  fs::create_directories(left / "images/left");
  EXPECT_EQ(render(wanted).frames, 3u);
}

TEST_F(RenderDrive, IsTheSameAtAnyNumberOfThreads) {
  const auto bytes = [&](int threads) {
    const ThreadLimit limit(threads);
    RenderJob wanted = job();
    wanted.output = own_ / std::to_string(threads);
    wanted.T_local_lidar.resize(2);
    render(wanted);
    std::string all;
    for (const char* file :
         {"images/left/000001.png", "depth/left/000001.png", "lidar/000001.bin"}) {
      std::ifstream stream(wanted.output / file, std::ios::binary);
      all.append(std::istreambuf_iterator<char>(stream), {});
    }
    return all;
  };
  const std::string once = bytes(1);
  EXPECT_GT(once.size(), 50'000u);
  EXPECT_TRUE(bytes(2) == once);
  EXPECT_TRUE(bytes(4) == once);
}

TEST_F(RenderDrive, NothingIsSeenBeyondItsReach) {
  RenderJob near = job();
  near.reach = 9;
  near.T_local_lidar.resize(1);
  render(near);
  const Frame frame = std::get<Frame>(open_drive(near.output, {})->load(0));
  for (const Eigen::Vector3f& p : frame.scan.position) EXPECT_LT(p.norm(), 9.1f);
}

TEST_F(RenderDrive, TheWindowFollows) {
  const MapReader map(*folder_ / "map.fovea");
  MapWindow window(map, 6);
  const std::size_t here = window.around({4, 0, 0}).size();
  EXPECT_GT(here, 1000u);
  EXPECT_LT(here, map.size());
  EXPECT_EQ(window.version(), 1);
  window.around({4.01, 0, 0});
  EXPECT_EQ(window.version(), 1);
  const MapSurfels& there = window.around({14, 0, 0});
  EXPECT_EQ(window.version(), 2);
  for (const Eigen::Vector3f& p : there.position) EXPECT_LT(p.norm(), 6 + 8);
  EXPECT_EQ(window.around({0, 900, 0}).size(), 0u);
}

}  // namespace fovea::render_drive_test
