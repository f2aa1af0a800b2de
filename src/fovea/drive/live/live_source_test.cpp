#include "fovea/drive/live/live_source.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "fovea/drive/live/test_live_run.h"
#include "fovea/errors.h"

namespace fovea::live_source_test {

using namespace test;
using testing::HasSubstr;

class LiveSourceTest : public testing::Test {
 protected:
  void expect_same_as_file(const LiveData& data) const {
    const std::string toml = data.write(folder_ / "drive");
    LiveOptions options = all_data();
    if (data.drive.cameras.empty()) options.drive.cameras.clear();
    const PlayedDrive live = play(data, toml, options);
    expect_same(live, *open_drive(folder_ / "drive", options.drive));
  }

  TemporaryFolder folder_;
};

TEST_F(LiveSourceTest, GivesTheDriveOfTheSameDataInAFolder) { expect_same_as_file(live_car(30)); }

TEST_F(LiveSourceTest, GivesPositionsWithAttitudes) {
  expect_same_as_file(live_car_by_positions(30, /*has_attitudes=*/true));
}

TEST_F(LiveSourceTest, GivesPositionsWithOrientationsOfTheImu) {
  expect_same_as_file(live_car_by_positions(30, /*has_attitudes=*/false));
}

TEST_F(LiveSourceTest, GivesADriveWithoutCamerasAndNavigation) {
  LiveData data = live_car(20);
  data.drive.cameras.clear();
  data.drive.T_lidar_imu.reset();
  data.images.clear();
  data.poses.clear();
  data.inertia.clear();
  data.wheels.clear();
  for (LiveScan& scan : data.scans) scan.points.time.clear();
  expect_same_as_file(data);
}

TEST_F(LiveSourceTest, GivesSeveralLidars) {
  LiveData data = live_car(25);
  data.drive.lidar.name = "top";
  RecordedLidar& side = data.drive.further_lidars.emplace_back();
  side.name = "side";
  side.T_lidar_sensor = QuaternionMotion({1.5, 0.8, -0.6}, {0.98, 0, 0, 0.199});
  for (LiveScan& scan : data.scans) scan.lidar = "top";
  for (int i = 3; i < 25; ++i) {
    LiveScan& scan = data.scans.emplace_back(live_scan(i, /*has_times=*/true, "side"));
    scan.stamp += 30'000'000;
  }
  expect_same_as_file(data);
}

TEST_F(LiveSourceTest, TakesDataFromAThreadForEachSensor) {
  const LiveData data = live_car(60);
  const std::string toml = data.write(folder_ / "drive");
  LiveOptions options = all_data();
  options.expects_navigation = true;
  LiveSource source(toml, options);
  std::vector<std::jthread> sensors;
  std::atomic<int> running = 5;
  const auto start = [&](auto&& send) {
    sensors.emplace_back([&, send] {
      send();
      if (--running == 0) source.close();
    });
  };
  start([&] {
    for (const LiveScan& scan : data.scans) source.add_scan(scan);
  });
  for (const std::string camera : {"front", "side"}) {
    start([&, camera] {
      for (const LiveImage& image : data.images) {
        if (image.camera == camera) source.add_image(image);
      }
    });
  }
  start([&] {
    // The beginning waits for poses, not for wheels.
    for (const WheelSpeed& wheel : data.wheels) source.add_wheel_speed(wheel);
    for (const RecordedPose& pose : data.poses) source.add_pose(pose);
  });
  start([&] {
    for (const RecordedInertia& inertia : data.inertia) source.add_inertia(inertia);
  });
  const PlayedDrive live = read_all(source);
  expect_same(live, *open_drive(folder_ / "drive", all_data().drive));
}

TEST_F(LiveSourceTest, GivesADriveWithAPause) {
  LiveData data = live_car(30);
  const auto pause = [](auto& stamp) {
    if (stamp > kLiveStart + 20 * kLiveStep - kLiveStep / 2) stamp += 60 * kNsPerSecond;
  };
  for (LiveScan& scan : data.scans) pause(scan.stamp);
  for (LiveImage& image : data.images) pause(image.stamp);
  for (RecordedPose& pose : data.poses) pause(pose.time);
  for (RecordedInertia& inertia : data.inertia) pause(inertia.time);
  for (WheelSpeed& wheel : data.wheels) pause(wheel.time);
  const std::string toml = data.write(folder_ / "drive");
  LiveOptions options = all_data();
  options.max_wait = 0.5;  // for an image that comes before the first scan after the pause
  const PlayedDrive live = play(data, toml, options);
  expect_same(live, *open_drive(folder_ / "drive", options.drive));
}

TEST_F(LiveSourceTest, RefusesWhatTheDriveLacks) {
  const std::string toml = live_car(1).write(folder_ / "drive");
  LiveSource source(toml, {});
  EXPECT_THROW(source.add_scan(live_scan(0, true, "other")), std::invalid_argument);
  EXPECT_THROW(source.add_image({"other", 0, live_png(0)}), std::invalid_argument);
  LiveOptions options;
  options.drive.cameras = {7};
  EXPECT_THAT(error_of<ConfigError>([&] { LiveSource(toml, options); }), HasSubstr("no camera 7"));
  EXPECT_THROW(LiveSource("version = 2", {}), ConfigError);
}

// A sender that waits for room sends nothing else: frames do not depend on a clock, even if a
// camera stops.
TEST_F(LiveSourceTest, OneSenderNeedsNoClock) {
  LiveData data = live_car(40);
  const std::string toml = data.write(folder_ / "drive");
  std::erase_if(data.images, [](const LiveImage& image) {
    return image.camera == "side" && image.stamp > kLiveStart + 15 * kLiveStep;
  });
  LiveOptions options = all_data();
  options.has_one_sender = true;
  for (const double wait : {0.0, 1e6}) {
    options.max_wait = options.longest_beginning = wait;
    const PlayedDrive run = play(data, toml, options);
    ASSERT_EQ(run.frames.size(), 40u);
    for (int i = 0; i < 40; ++i) {
      const Frame& frame = std::get<Frame>(run.frames[std::size_t(i)]);
      EXPECT_EQ(frame.missing_images.size(), i > 15 ? 1u : 0u) << i;
    }
  }
}

TEST_F(LiveSourceTest, ACameraMayBeginAfterTheLidar) {
  LiveData data = live_car(40);
  const std::string toml = data.write(folder_ / "drive");
  std::erase_if(data.images, [](const LiveImage& image) {
    return image.camera == "side" && image.stamp < kLiveStart + 8 * kLiveStep;
  });
  LiveOptions options = all_data();
  options.waits = false;  // the oldest scans are dropped while the beginning waits
  options.max_scans = 8;
  LiveSource source(toml, options);
  for (const auto& [time, call] : data.calls()) {
    if (time < kLiveStart + 30 * kLiveStep) call(source);
  }
  source.close();
  const PlayedDrive run = read_all(source);
  EXPECT_EQ(run.info.calibration.cameras.size(), 2u);
  ASSERT_FALSE(run.frames.empty());
  for (const LoadedFrame& frame : run.frames) {
    EXPECT_TRUE(std::get<Frame>(frame).missing_images.empty());
  }
}

TEST_F(LiveSourceTest, ACameraOfAnotherClockIsLeftOut) {
  LiveData data = live_car(30);
  const std::string toml = data.write(folder_ / "drive");
  for (LiveImage& image : data.images) {
    if (image.camera == "side") image.stamp -= 1000 * kNsPerSecond;
  }
  LiveOptions options = all_data();
  options.has_one_sender = true;
  const PlayedDrive run = play(data, toml, options);
  EXPECT_EQ(run.info.calibration.cameras.size(), 1u);
  EXPECT_THAT(run.info.warnings, testing::Contains(HasSubstr("no image of camera side belongs")));
  EXPECT_EQ(run.frames.size(), 30u);
}

}  // namespace fovea::live_source_test
