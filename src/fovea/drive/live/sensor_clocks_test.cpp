#include "fovea/drive/live/sensor_clocks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace fovea::sensor_clocks_test {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr TimeNs kMs = 1'000'000, kStart = 1'700'000'000 * kNsPerSecond;
enum SensorNumber : std::size_t { kLidar, kCamera, kImu };

/// A LiDAR at 10 Hz, a camera at 20 Hz and an IMU at 100 Hz.
class SensorClocksTest : public testing::Test {
 protected:
  /// Sends the messages of a part of a drive. All data arrive 20 ms after they are measured.
  /// @param begin, end  ms
  void run(TimeNs begin, TimeNs end) {
    for (TimeNs ms = begin; ms < end; ++ms) {
      if (ms % 10 == 3) send(kImu, ms);
      if (ms % 50 == 7) send(kCamera, ms);
      if (ms % 100 == 11) send(kLidar, ms);
    }
  }
  void send(std::size_t sensor, TimeNs ms) {
    const TimeNs stamp = kStart + ms * kMs + ahead_[sensor] * kMs;
    const auto time = clocks_.time_of(sensor, stamp, ms * kMs + 20 * kMs);
    if (time) times_[sensor].push_back(*time - kStart);
    sent_[sensor] += 1;
  }
  /// All times increase, and the sensors have one clock: its times are those of the measurement.
  /// @param pause  ms, that has passed on this clock alone
  void expect_one_clock(TimeNs since_ms, TimeNs tolerance_ms, TimeNs pause_ms = 0) {
    const std::map<std::size_t, TimeNs> phases{{kLidar, 11}, {kCamera, 7}, {kImu, 3}},
        steps{{kLidar, 100}, {kCamera, 50}, {kImu, 10}};
    for (auto& [sensor, times] : times_) {
      EXPECT_TRUE(std::is_sorted(times.begin(), times.end())) << sensor;
      for (const TimeNs time : times) {
        if (time < (since_ms + pause_ms) * kMs) continue;
        const TimeNs off = time - (phases.at(sensor) + pause_ms) * kMs,
                     step = steps.at(sensor) * kMs, rest = (off % step + step) % step;
        EXPECT_LE(std::min(rest, step - rest), tolerance_ms * kMs) << sensor << " " << time;
      }
    }
  }

  SensorClocks clocks_{{"the LiDAR", "camera front", "the IMU"}, /*has_arrivals=*/true};
  std::map<std::size_t, TimeNs> ahead_;  // ms, that a clock is ahead
  std::map<std::size_t, std::vector<TimeNs>> times_;
  std::map<std::size_t, int> sent_;
};

TEST_F(SensorClocksTest, LeavesRightStampsAlone) {
  run(0, 3000);
  EXPECT_EQ(times_[kLidar].size(), 30u);
  EXPECT_EQ(times_[kImu].size(), 300u);
  expect_one_clock(0, 0);
  EXPECT_THAT(clocks_.messages().warnings, IsEmpty());
}

TEST_F(SensorClocksTest, ShiftsAllSensorsOfAComputerByTheSameAmount) {
  run(0, 2000);
  for (const std::size_t sensor : {kLidar, kCamera, kImu}) ahead_[sensor] = -3'600'000;
  run(2000, 4000);
  expect_one_clock(0, 0);
  EXPECT_EQ(times_[kLidar].size(), 39u);  // the first message after the jump is lost
  EXPECT_THAT(clocks_.messages().warnings,
              ElementsAre("the clock of the LiDAR jumps back by 3600.0 s"));
}

TEST_F(SensorClocksTest, ShiftsASensorThatJumpsBackAlone) {
  run(0, 2000);
  ahead_[kCamera] = -10'000;
  run(2000, 5000);
  expect_one_clock(0, 0);
  EXPECT_GE(times_[kCamera].size(), 99u);
  EXPECT_THAT(clocks_.messages().warnings,
              ElementsAre("the clock of camera front jumps back by 10.0 s"));
}

TEST_F(SensorClocksTest, ShiftsASensorThatJumpsAheadAlone) {
  run(0, 2000);
  ahead_[kCamera] = 10'000;
  run(2000, 5000);
  expect_one_clock(0, 0);
  EXPECT_GT(times_[kCamera].size(), 75u);  // of 100: a second shows that it is alone
  EXPECT_THAT(clocks_.messages().warnings,
              ElementsAre("the clock of camera front jumps ahead by 10.0 s"));
}

TEST_F(SensorClocksTest, ShiftsTheOthersIfTheLidarJumpsAheadAlone) {
  run(0, 2000);
  ahead_[kLidar] = 10'000;
  run(2000, 5000);
  expect_one_clock(3200, 0, /*pause_ms=*/10'000);
  EXPECT_THAT(clocks_.messages().warnings,
              ElementsAre("the clock of the LiDAR jumps ahead by 10.0 s"));
}

TEST_F(SensorClocksTest, StampsOfAllSensorsThatGoAheadAreAPause) {
  run(0, 2000);
  for (const std::size_t sensor : {kLidar, kCamera, kImu}) ahead_[sensor] = 10'000;
  run(2000, 4000);
  expect_one_clock(2000, 0, /*pause_ms=*/10'000);
  EXPECT_GE(times_[kCamera].size(), 76u);
  EXPECT_GE(times_[kImu].size(), 380u);
  EXPECT_THAT(clocks_.messages().warnings, IsEmpty());
}

TEST_F(SensorClocksTest, APauseIsNoJump) {
  run(0, 2000);
  run(20'000, 22'000);
  expect_one_clock(0, 0);
  EXPECT_EQ(times_[kLidar].size(), 40u);
  EXPECT_EQ(times_[kImu].size(), 400u);
  EXPECT_THAT(clocks_.messages().warnings, IsEmpty());
}

TEST_F(SensorClocksTest, DataThatArriveLateAreNoJump) {
  run(0, 2000);
  // Three seconds of data arrive at once, another two are lost.
  for (TimeNs ms = 2000; ms < 5000; ++ms) {
    const auto late = [&](std::size_t sensor) {
      const auto time = clocks_.time_of(sensor, kStart + ms * kMs, 7000 * kMs + ms);
      if (time) times_[sensor].push_back(*time - kStart);
    };
    if (ms % 10 == 3) late(kImu);
    if (ms % 50 == 7) late(kCamera);
    if (ms % 100 == 11) late(kLidar);
  }
  run(7000, 9000);
  expect_one_clock(0, 0);
  EXPECT_GE(times_[kCamera].size(), 138u);
  EXPECT_THAT(clocks_.messages().warnings, IsEmpty());
}

TEST_F(SensorClocksTest, DropsSingleMessagesOfAnotherTime) {
  run(0, 1000);
  for (const TimeNs ahead : {-3'600'000, 3'600'000, -1'700'000'000}) {
    for (const std::size_t sensor : {kLidar, kCamera, kImu}) {
      ahead_[sensor] = ahead;
      send(sensor, 1001);
      ahead_[sensor] = 0;
    }
    run(1002, 1200);
  }
  EXPECT_FALSE(clocks_.time_of(kLidar, -5, 0));
  EXPECT_FALSE(clocks_.time_of(kLidar, std::numeric_limits<TimeNs>::max(), 0));
  EXPECT_THAT(clocks_.messages().warnings, IsEmpty());
  for (const auto& [sensor, times] : times_) {
    for (const TimeNs time : times) EXPECT_LT(std::abs(time), 2 * kNsPerSecond);
  }
}

TEST_F(SensorClocksTest, SmallStepsBackAreLeftToTheQueues) {
  run(0, 1000);
  send(kImu, 700);
  EXPECT_EQ(times_[kImu].back(), 700 * kMs);
  run(1000, 1100);
  EXPECT_THAT(clocks_.messages().warnings, IsEmpty());
}

TEST_F(SensorClocksTest, TheClockMayJumpBackAgain) {
  run(0, 1000);
  for (int jump = 1; jump < 4; ++jump) {
    for (const std::size_t sensor : {kLidar, kCamera, kImu}) ahead_[sensor] = -5000 * jump;
    run(1000 * jump, 1000 * jump + 1000);
  }
  expect_one_clock(0, 0);
  EXPECT_EQ(clocks_.messages().warnings.size(), 3u);
}

TEST_F(SensorClocksTest, WithoutArrivalsOnlyJumpsBackAreFound) {
  SensorClocks clocks({"the LiDAR", "camera front"}, /*has_arrivals=*/false);
  std::vector<TimeNs> times;
  for (int i = 0; i < 40; ++i) {
    const TimeNs jump = i < 20 ? 0 : -60 * kNsPerSecond;
    if (const auto time = clocks.time_of(0, kStart + i * 100 * kMs + jump, 0)) {
      times.push_back(*time);
    }
  }
  ASSERT_EQ(times.size(), 39u);
  EXPECT_EQ(times.back(), kStart + 39 * 100 * kMs);
  EXPECT_TRUE(clocks.time_of(0, kStart + 3600 * kNsPerSecond, 0));
}

}  // namespace fovea::sensor_clocks_test
