#include "fovea/drive.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/mapper.h"

namespace fovea::api_drive_test {

constexpr TimeNs kStart = 1'600'000'000 * kNsPerSecond;

DriveCamera front() {
  DriveCamera camera{.name = "front", .width = 32, .height = 24};
  camera.fx = camera.fy = 20;
  camera.cx = 15.5;
  camera.cy = 11.5;
  camera.T_lidar_cam.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return camera;
}

/// A wall and the ground, `x` m ahead.
PointCloud scan(double x) {
  PointCloud points;
  for (int i = -20; i <= 20; ++i) {
    for (int j = 0; j <= 20; ++j) {
      points.position.emplace_back(float(8 - x), 0.2f * float(i), 0.1f * float(j) - 1);
      points.position.emplace_back(0.4f * float(j) + 1, 0.2f * float(i), -1.5f);
    }
  }
  points.intensity.assign(points.size(), 0.5f);
  return points;
}

void write_drive(const std::filesystem::path& folder, int frames) {
  DriveWriter writer(folder, {front()}, {.sweep_compensated = true});
  for (int i = 0; i < frames; ++i) {
    const TimeNs stamp = kStart + i * kNsPerSecond / 10;
    RigidMotion T_world_lidar = RigidMotion::Identity();
    T_world_lidar.translation().x() = 0.1 * i;
    Image image(32, 24, 3);
    image.data.assign(image.data.size(), 90);
    writer.add({stamp, scan(0.1 * i)}, {{"front", stamp, image}}, T_world_lidar);
  }
  const WrittenDrive written = writer.close();
  EXPECT_EQ(written.scans, std::size_t(frames));
  EXPECT_EQ(written.images, std::size_t(frames));
}

TEST(ApiDrive, ReadsWhatItWrote) {
  const TemporaryFolder folder;
  write_drive(folder / "drive", 3);
  const Drive drive(folder / "drive");
  EXPECT_EQ(drive.frames(), (std::vector<int>{0, 1, 2}));
  ASSERT_EQ(drive.cameras().size(), 1u);
  EXPECT_EQ(drive.cameras()[0].width, 32);
  EXPECT_TRUE(drive.is_compensated());
  EXPECT_EQ(drive.kind(), "generic");
  ASSERT_TRUE(drive.navigation().has_value());
  const DriveFrame frame = drive.load(2);
  EXPECT_EQ(frame.index(), 2);
  EXPECT_EQ(frame.stamp(), kStart + kNsPerSecond / 5);
  EXPECT_EQ(frame.scan().position, scan(0.2).position);
  ASSERT_EQ(frame.images().size(), 1u);
  EXPECT_EQ(frame.images()[0].data[0], 90);
}

TEST(ApiDrive, RefusesFramesThatItDoesNotHave) {
  const TemporaryFolder folder;
  write_drive(folder / "drive", 3);
  const Drive drive(folder / "drive");
  EXPECT_THROW(drive.load(3), std::out_of_range);
  std::filesystem::remove_all(folder / "drive" / "scans");
  EXPECT_THROW(Drive(folder / "none"), InputError);
}

TEST(ApiDrive, AFrameThatIsDamagedIsSkipped) {
  const TemporaryFolder folder;
  write_drive(folder / "drive", 3);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "drive")) {
    if (entry.path().filename().string().find("1.pcd") != std::string::npos) {
      std::filesystem::resize_file(entry.path(), 5);
    }
  }
  const Drive drive(folder / "drive");
  EXPECT_THROW(drive.load(1), InputError);
  EXPECT_FALSE(drive.try_load(1).has_value());
  EXPECT_TRUE(drive.try_load(2).has_value());
}

TEST(ApiDrive, TheWriterRefusesACameraThatIsNone) {
  const TemporaryFolder folder;
  DriveCamera camera = front();
  camera.distortion_model = "fisheye";
  EXPECT_THROW(DriveWriter(folder / "drive", {camera}), std::invalid_argument);
  camera = front();
  camera.distortion_model = "plumb_bob";
  camera.distortion = {1};
  EXPECT_THROW(DriveWriter(folder / "drive", {camera}), std::invalid_argument);
  camera = front();
  camera.fx = 0;
  EXPECT_THROW(DriveWriter(folder / "drive", {camera}), std::invalid_argument);
}

TEST(ApiFrameMapper, HasThePointsOfAMapFile) {
  const TemporaryFolder folder;
  write_drive(folder / "drive", 4);
  const Drive drive(folder / "drive");
  const MapperSettings settings{.values = {{"surface.spacing_m", "0.1"}}};
  const MapFigures figures =
      map_drive(drive, folder / "a.fovea", {.settings = settings, .hold_out = "2-2"});
  EXPECT_EQ(figures.frames, 3u);
  EXPECT_EQ(figures.frames_held_out, 1u);
  FrameMapper mapper(drive, settings);
  for (const int index : drive.frames()) mapper.map(drive.load(index), index == 2);
  ASSERT_GT(mapper.size(), 100u);
  EXPECT_EQ(mapper.size(), figures.points);
  EXPECT_EQ(mapper.points().position, Map(folder / "a.fovea").points().position);
}

TEST(ApiFrameMapper, RefusesFramesOfOtherDrivesAndOfThePast) {
  const TemporaryFolder folder;
  write_drive(folder / "drive", 3);
  const Drive drive(folder / "drive"), other(folder / "drive");
  FrameMapper mapper(drive);
  EXPECT_THROW(mapper.map(other.load(0)), std::invalid_argument);
  mapper.map(drive.load(1));
  EXPECT_THROW(mapper.map(drive.load(1)), std::invalid_argument);
  EXPECT_THROW(FrameMapper(drive, {.preset = "none"}), ConfigError);
  EXPECT_THROW(FrameMapper(drive, {.values = {{"no.key", "1"}}}), ConfigError);
}

TEST(ApiMapDrive, StopsAndKeepsOtherFiles) {
  const TemporaryFolder folder;
  write_drive(folder / "drive", 4);
  const Drive drive(folder / "drive");
  std::stop_source stop;
  const MapFigures figures =
      map_drive(drive, folder / "a.fovea", {.stop = stop.get_token()}, [&](const MapProgress& now) {
        if (now.done == 1) stop.request_stop();
      });
  EXPECT_TRUE(figures.interrupted);
  EXPECT_THROW(map_drive(drive, folder / "a.fovea"), OutputError);
  const MapFigures rest = map_drive(drive, folder / "a.fovea", {.resume = true});
  EXPECT_FALSE(rest.interrupted);
  EXPECT_EQ(Map(folder / "a.fovea").frames().size(), 4u);
}

}  // namespace fovea::api_drive_test
