#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../../tests/miniature_data_sets.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/drive/data_sets/data_set.h"
#include "fovea/drive/frame_source.h"
#include "fovea/errors.h"

namespace fovea::nuscenes_test {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::int64_t kStart = 1'532'402'927'000'000, kSweep = 50'000;  // microseconds

/// Two scenes; the first has four scans, the vehicle drives 1 m from scan to scan, and two cameras
/// have two images each.
class NuScenes : public testing::Test {
 protected:
  NuScenes() {
    put("scene", R"({"token": "s1", "name": "scene-0001"}, {"token": "s2", "name": "scene-0002"})");
    put("sample", R"({"token": "a", "scene_token": "s1"}, {"token": "b", "scene_token": "s1"},)"
                  R"({"token": "c", "scene_token": "s2"})");
    put("sensor", R"({"token": "l", "channel": "LIDAR_TOP", "modality": "lidar"},)"
                  R"({"token": "f", "channel": "CAM_FRONT", "modality": "camera"},)"
                  R"({"token": "r", "channel": "RADAR_FRONT", "modality": "radar"})");
    // The LiDAR's x axis points right, the camera's z axis ahead.
    put("calibrated_sensor",
        R"({"token": "cl", "sensor_token": "l", "translation": [1, 0, 2],)"
        R"("rotation": [0.7071067811865476, 0, 0, -0.7071067811865476], "camera_intrinsic": []},)"
        R"({"token": "cf", "sensor_token": "f", "translation": [2, 0, 1.5],)"
        R"("rotation": [0.5, -0.5, 0.5, -0.5],)"
        R"("camera_intrinsic": [[20, 0, 11.5], [0, 21, 7.5], [0, 0, 1]]},)"
        R"({"token": "cr", "sensor_token": "r", "translation": [3, 0, 0.5],)"
        R"("rotation": [1, 0, 0, 0], "camera_intrinsic": []})");
    for (int i = 0; i < 4; ++i) {
      add_data("l", i, i < 2 ? "a" : "b", kStart + i * kSweep, "pcd.bin", "");
      write_points(folder_ / fmt::format("data/l{}.pcd.bin", i), float(3 + i), 5);
    }
    for (int i = 0; i < 2; ++i) {
      add_data("f", i, "a", kStart + i * 83'000 - 10'000, "png", R"("width": 24, "height": 16,)");
      write_png(folder_ / fmt::format("data/f{}.png", i), 24, 16, std::uint8_t(50 + i));
    }
    add_data("r", 0, "a", kStart, "pcd", "");
    put("sample_data", data_);
    put("ego_pose", poses_);
    options_.root = folder_ / "";
    options_.scene = "scene-0001";
    options_.output = folder_ / "drive";
  }

  void put(const std::string& table, const std::string& records) {
    write_text(folder_ / "v1.0-mini" / (table + ".json"), "[" + records + "]");
  }
  void add_data(const std::string& sensor, int number, const std::string& sample, std::int64_t time,
                const std::string& ending, const std::string& more) {
    const std::string token = sensor + std::to_string(number);
    data_ += fmt::format(
        R"({}{{"token": "{}", "sample_token": "{}", "ego_pose_token": "{}",)"
        R"("calibrated_sensor_token": "c{}", "timestamp": {}, {} "filename": "data/{}.{}"}})",
        data_.empty() ? "" : ",", token, sample, token, sensor, time, more, token, ending);
    poses_ +=
        fmt::format(R"({}{{"token": "{}", "translation": [{}, 5, 0], "rotation": [1, 0, 0, 0]}})",
                    poses_.empty() ? "" : ",", token, 100 + number);
  }
  std::string error() {
    try {
      convert_nuscenes(options_);
    } catch (const Error& error) {
      EXPECT_FALSE(std::filesystem::exists(options_.output));
      return error.what();
    }
    return "no error";
  }

  TemporaryFolder folder_;
  std::string data_, poses_;
  DataSetOptions options_;
};

TEST_F(NuScenes, ASceneBecomesADrive) {
  const DataSetFigures figures = convert_nuscenes(options_);
  EXPECT_EQ(figures.scans, 4u);
  EXPECT_EQ(figures.images, 2u);
  EXPECT_EQ(figures.poses, 4u);
  DriveOptions options;
  EXPECT_EQ(nuscenes_scenes(options_.root).size(), 2u);
  options.cameras = {2};
  const auto drive = open_drive(options_.output, options);
  const Frame frame = std::get<Frame>(drive->load(0));
  EXPECT_EQ(frame.stamp, kStart * 1000);
  EXPECT_EQ(frame.scan.position[0], Eigen::Vector3f(3, 1, -1));
  EXPECT_EQ(frame.images[0].data[0], 50);
  const Camera& camera = drive->info().calibration.cameras[0];
  EXPECT_EQ(camera.fy, 21);
  // 3 m ahead of the LiDAR (its y axis) is 2 m ahead of the camera, and 0.5 m above it.
  const Eigen::Vector3d p_cam = camera.T_cam_lidar * Eigen::Vector3d(0, 3, 0);
  EXPECT_LT((p_cam - Eigen::Vector3d(0, -0.5, 2)).norm(), 1e-9);
  EXPECT_EQ(drive->info().sweep.stamp_phase, 1);
}

TEST_F(NuScenes, APartOfTheScene) {
  options_.start = 0.04;
  options_.duration = 0.1;
  const DataSetFigures figures = convert_nuscenes(options_);
  EXPECT_EQ(figures.scans, 2u);
  options_.force = true;
  options_.start = 10;
  EXPECT_THROW(convert_nuscenes(options_), ConfigError);
}

TEST_F(NuScenes, NamesTheFaults) {
  options_.scene = "scene-0009";
  EXPECT_THAT(error(), AllOf(HasSubstr("scene-0009"), HasSubstr("scene-0001, scene-0002")));
  options_.scene.clear();
  EXPECT_THAT(error(), HasSubstr("2 scenes"));
  options_.scene = "scene-0002";
  EXPECT_THAT(error(), HasSubstr("LIDAR_TOP"));
  options_.scene = "scene-0001";
  put("ego_pose", R"({"token": "l0"})");
  EXPECT_THAT(error(), AllOf(HasSubstr("damaged"), HasSubstr("translation")));
  put("ego_pose", R"({"token": )");
  EXPECT_THAT(error(), HasSubstr("ego_pose.json"));
  std::filesystem::remove(folder_ / "v1.0-mini" / "scene.json");
  EXPECT_THAT(error(), HasSubstr("v1.0-*"));
}

}  // namespace fovea::nuscenes_test
