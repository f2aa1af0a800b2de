// Bounds, waits and bad data of a live source.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <thread>
#include <utility>
#include <vector>

#include "fovea/drive/live/live_source.h"
#include "fovea/drive/live/test_live_run.h"

namespace fovea::live_bounds_test {

using namespace test;
using testing::Contains;
using testing::HasSubstr;

namespace {

const Frame& frame_of(const LoadedFrame& loaded) { return std::get<Frame>(loaded); }

}  // namespace

class LiveBounds : public testing::Test {
 protected:
  /// Waits are short, since each of them passes.
  static LiveOptions short_waits() {
    LiveOptions options = all_data();
    options.max_wait = 0.02;
    options.longest_beginning = 0.2;
    return options;
  }

  /// No wait depends on the clock.
  static LiveOptions one_sender() {
    LiveOptions options = all_data();
    options.has_one_sender = true;
    return options;
  }

  /// Sends the scans [begin, end) from this thread, with all that belongs to them.
  static void send(const LiveData& data, LiveSource& source, int begin, int end) {
    LiveData part = data;
    const auto keep = [&](auto& all, auto stamp, TimeNs more) {
      std::erase_if(all, [&](const auto& item) {
        const TimeNs since = stamp(item) - kLiveStart + kLiveStep / 2 - more;
        return since < begin * kLiveStep || since >= end * kLiveStep;
      });
    };
    keep(part.scans, [](const LiveScan& scan) { return scan.stamp; }, 0);
    keep(part.images, [](const LiveImage& image) { return image.stamp; }, 0);
    // Up to the end of the sweep.
    const auto time = [](const auto& record) { return record.time; };
    keep(part.poses, time, kLiveStep / 2);
    keep(part.inertia, time, kLiveStep / 2);
    keep(part.wheels, time, kLiveStep / 2);
    for (const auto& [stamp, call] : part.calls()) call(source);
  }

  LiveData data_ = live_car(40);
  std::string toml_ = drive_toml(data_.drive);
};

TEST_F(LiveBounds, AFrameComesWithoutDataThatAreLate) {
  LiveSource source(toml_, short_waits());
  send(data_, source, -3, 11);
  ASSERT_TRUE(source.begin({}));
  for (int i = 0; i < 11; ++i) ASSERT_TRUE(source.next({}));
  source.add_scan(data_.scans[11]);
  const auto late = source.next({});
  ASSERT_TRUE(late);
  EXPECT_TRUE(std::holds_alternative<SkippedFrame>(late->frame));  // no camera has an image
  send(data_, source, 11, 13);
  EXPECT_EQ(source.figures().images_late, 2u);
  EXPECT_EQ(source.figures().scans_out_of_order, 1u);  // the scan that came already
  const Frame next = frame_of(source.next({})->frame);
  EXPECT_EQ(next.index, 12);
  EXPECT_TRUE(next.missing_images.empty());
  // The motion of the skipped frame is not lost.
  ASSERT_FALSE(next.motion.imu.empty());
  EXPECT_LE(next.motion.imu.front().time, data_.scans[11].stamp);
}

TEST_F(LiveBounds, DropsDataOutOfOrder) {
  LiveSource source(toml_, short_waits());
  send(data_, source, -3, 12);
  source.add_scan(data_.scans[3]);
  source.add_pose(data_.poses[3]);
  source.add_inertia(data_.inertia[3]);
  source.add_wheel_speed(data_.wheels[1]);
  source.close();
  const PlayedDrive run = read_all(source);
  EXPECT_EQ(run.frames.size(), 12u);
  EXPECT_EQ(run.figures.scans_out_of_order, 1u);
  EXPECT_EQ(run.figures.poses_late, 3u);
}

TEST_F(LiveBounds, SensorsThatSendNothingAreLeftOut) {
  LiveData data = data_;
  std::erase_if(data.images, [](const LiveImage& image) { return image.camera == "side"; });
  data.inertia.clear();
  LiveSource source(toml_, short_waits());
  EXPECT_THAT(source.missing(), HasSubstr("images of camera front"));
  send(data, source, -3, 12);
  EXPECT_EQ(source.missing(), "images of camera side, records of the IMU");
  const auto first = source.begin({});
  ASSERT_TRUE(first);
  EXPECT_EQ(first->info().calibration.cameras.size(), 1u);
  EXPECT_FALSE(first->info().imu);
  EXPECT_THAT(first->info().warnings,
              Contains("camera 3 (side) has sent no image: it is left out"));
  EXPECT_EQ(source.missing(), "");
  source.add_image({"side", kLiveStart + 12 * kLiveStep, live_png(0)});
  source.add_inertia(data_.inertia.back());
  EXPECT_THAT(source.figures().warnings,
              testing::ElementsAre("camera side sends data after the beginning: they are not used",
                                   "the IMU sends data after the beginning: they are not used"));
}

TEST_F(LiveBounds, ALidarAloneIsADrive) {
  LiveSource source(toml_, short_waits());
  for (int i = 0; i < 12; ++i) source.add_scan(data_.scans[i]);
  source.close();
  const PlayedDrive run = read_all(source);
  EXPECT_TRUE(run.info.calibration.cameras.empty());
  EXPECT_EQ(run.frames.size(), 12u);
  EXPECT_EQ(frame_of(run.frames.back()).scan.size(), 90u);
}

TEST_F(LiveBounds, ReportsACameraThatStopsAndComesBack) {
  std::erase_if(data_.images, [](const LiveImage& image) {
    return image.camera == "front" && image.stamp > kLiveStart + 12 * kLiveStep &&
           image.stamp < kLiveStart + 36 * kLiveStep;
  });
  LiveOptions options = short_waits();
  options.max_wait = 0.2;
  const auto start = WallClock::now();
  const PlayedDrive run = play(data_, toml_, options);
  EXPECT_EQ(run.frames.size(), 40u);
  EXPECT_EQ(frame_of(run.frames[20]).missing_images.size(), 1u);
  EXPECT_TRUE(frame_of(run.frames[37]).missing_images.empty());
  EXPECT_THAT(run.figures.warnings,
              testing::ElementsAre("camera front has sent no data since 1.1 s of the drive",
                                   "camera front sends data again, after 2.5 s"));
  EXPECT_LT(milliseconds_since(start), 60e3);
}

TEST_F(LiveBounds, CountsGaps) {
  std::erase_if(data_.scans, [](const LiveScan& scan) {
    return scan.stamp == kLiveStart + 20 * kLiveStep || scan.stamp == kLiveStart + 30 * kLiveStep;
  });
  std::erase_if(data_.images, [](const LiveImage& image) {
    return image.camera == "front" && image.stamp / kLiveStep == kLiveStart / kLiveStep + 25;
  });
  const PlayedDrive run = play(data_, toml_, one_sender());
  EXPECT_EQ(run.figures.scans_missing, 2u);
  EXPECT_EQ(run.figures.images_missing, 1u);
  EXPECT_EQ(run.figures.images_unused, 4u);  // of the missing scans
}

TEST_F(LiveBounds, AFullQueueDropsTheOldestScan) {
  LiveOptions options = short_waits();
  options.waits = false;
  options.max_scans = 3;
  LiveSource source(toml_, options);
  send(data_, source, -3, 11);
  ASSERT_TRUE(source.begin({}));
  send(data_, source, 11, 40);
  EXPECT_EQ(source.figures().scans_dropped, 27u);
  source.close();
  std::vector<TimeNs> stamps;
  while (const auto frame = source.next({})) stamps.push_back(frame_of(frame->frame).stamp);
  ASSERT_EQ(stamps.size(), 13u);
  EXPECT_EQ(stamps[10], data_.scans[37].stamp);
  EXPECT_EQ(stamps.back(), data_.scans[39].stamp);
}

TEST_F(LiveBounds, DamagedDataCostOneFrameAtMost) {
  LiveData data = data_;
  for (LiveImage& image : data.images) {
    if (image.stamp / kLiveStep == kLiveStart / kLiveStep + 15) image.content = "no image";
  }
  data.scans[17].points.position.clear();
  data.scans[17].points.intensity.clear();
  data.scans[18].points.intensity.resize(3);
  data.scans[20].points.position.assign(90, Eigen::Vector3f::Constant(NAN));
  const PlayedDrive run = play(data, toml_, one_sender());
  ASSERT_EQ(run.frames.size(), 40u);
  EXPECT_EQ(frame_of(run.frames[15]).missing_images.size(), 1u);
  for (const std::size_t i : {17u, 18u, 20u}) {
    EXPECT_EQ(std::get<SkippedFrame>(run.frames[i]).reason, SkipReason::kDamagedScan);
  }
  EXPECT_TRUE(std::holds_alternative<Frame>(run.frames[21]));
}

TEST_F(LiveBounds, CloseEndsEachWait) {
  LiveSource no_data(toml_, all_data());
  {
    const std::jthread closing([&] { no_data.close(); });
    EXPECT_FALSE(no_data.begin({}));
  }
  EXPECT_THROW(no_data.next({}), std::logic_error);
  LiveSource source(toml_, all_data());
  send(data_, source, -3, 11);
  ASSERT_TRUE(source.begin({}));
  for (int i = 0; i < 11; ++i) ASSERT_TRUE(source.next({}));
  const std::jthread closing([&] { source.close(); });
  EXPECT_FALSE(source.next({}));
  source.add_scan(data_.scans[20]);  // dropped
  EXPECT_FALSE(source.next({}));
}

TEST_F(LiveBounds, CloseGivesTheFramesAtHand) {
  LiveSource source(toml_, all_data());
  for (int i = 0; i < 3; ++i) source.add_scan(data_.scans[i]);
  for (const LiveImage& image : data_.images) {
    if (image.stamp < data_.scans[3].stamp) source.add_image(image);
  }
  source.close();
  const PlayedDrive run = read_all(source);
  EXPECT_EQ(run.frames.size(), 3u);
}

TEST_F(LiveBounds, AStopEndsEachWait) {
  LiveSource source(toml_, all_data());
  std::stop_source stop;
  {
    const std::jthread stopping([&] { stop.request_stop(); });
    EXPECT_FALSE(source.begin(stop.get_token()));
  }
  send(data_, source, -3, 11);
  ASSERT_TRUE(source.begin({}));
  EXPECT_FALSE(source.next(stop.get_token()));
  for (int i = 0; i < 11; ++i) ASSERT_TRUE(source.next({}));
  std::stop_source later;
  const std::jthread stopping([&] { later.request_stop(); });
  EXPECT_FALSE(source.next(later.get_token()));
}

TEST_F(LiveBounds, AClockThatJumpsBackIsShifted) {
  constexpr TimeNs kJump = -3600 * kNsPerSecond;
  const auto shift = [](auto& stamp) {
    if (stamp > kLiveStart + 20 * kLiveStep + kLiveStep / 2) stamp += kJump;
  };
  LiveData data = data_;
  for (LiveScan& scan : data.scans) shift(scan.stamp);
  for (LiveImage& image : data.images) shift(image.stamp);
  for (RecordedPose& pose : data.poses) shift(pose.time);
  for (RecordedInertia& inertia : data.inertia) shift(inertia.time);
  for (WheelSpeed& wheel : data.wheels) shift(wheel.time);
  LiveSource source(toml_, one_sender());
  const std::jthread sensors([&] {
    // In the order in which they were measured.
    std::vector<std::pair<TimeNs, std::function<void(LiveSource&)>>> calls = data.calls();
    std::stable_sort(calls.begin(), calls.end(), [](const auto& a, const auto& b) {
      const auto measured = [](TimeNs time) {
        return time < kLiveStart - kNsPerSecond ? time - kJump : time;
      };
      return measured(a.first) < measured(b.first);
    });
    for (const auto& [time, call] : calls) call(source);
    source.close();
  });
  const PlayedDrive run = read_all(source);
  EXPECT_THAT(run.figures.warnings,
              testing::ElementsAre("the clock of the LiDAR jumps back by 3600.0 s"));
  // Each sensor loses one message.
  ASSERT_EQ(run.frames.size(), 39u);
  TimeNs last = 0;
  for (const LoadedFrame& loaded : run.frames) {
    if (const auto* skipped = std::get_if<SkippedFrame>(&loaded)) {
      EXPECT_EQ(skipped->reason, SkipReason::kMissingImage);
      continue;
    }
    const Frame& frame = frame_of(loaded);
    EXPECT_GT(frame.stamp, last);
    last = frame.stamp;
    if (frame.index > 22) {
      EXPECT_EQ(frame.stamp, data_.scans[std::size_t(frame.index) + 1].stamp);
      EXPECT_TRUE(frame.missing_images.empty());
      EXPECT_FALSE(frame.motion.poses.empty());
      EXPECT_FALSE(frame.motion.imu.empty());
    }
  }
}

}  // namespace fovea::live_bounds_test
