#include "fovea/pipeline/live_clocks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fovea::live_clocks_test {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr TimeNs kStep = kNsPerSecond / 10;

/// Turns to and fro about all axes.
Eigen::Matrix3d rotation_at(double time) {
  return (Eigen::AngleAxisd(0.3 * std::sin(0.9 * time), Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(0.1 * std::sin(1.7 * time), Eigen::Vector3d::UnitX()) *
          Eigen::AngleAxisd(0.1 * std::sin(1.3 * time), Eigen::Vector3d::UnitY()))
      .toRotationMatrix();
}

/// Of a gyroscope in the axes of the LiDAR.
Eigen::Vector3d rate_at(double time) {
  constexpr double kHalf = 1e-3;
  const Eigen::AngleAxisd turn(rotation_at(time - kHalf).transpose() * rotation_at(time + kHalf));
  return turn.axis() * turn.angle() / (2 * kHalf);
}

/// A drive whose IMU samples are later than their stamps say.
class TurningDrive {
 public:
  TurningDrive(double delay, double drift) : delay_(delay), drift_(drift) {
    info_.imu.emplace().samples = samples(-1);
  }

  /// Passes the frames to the clocks as map_live() does.
  void run(LiveClocks& clocks, int frames) {
    for (int i = 0; i < frames; ++i) {
      Frame frame;
      frame.index = i;
      frame.stamp = i * kStep;
      if (i > 0) frame.motion.imu = samples(i - 1);
      clocks.correct(frame);
      for (const ImuSample& sample : frame.motion.imu) {
        EXPECT_GT(sample.time, last_) << i;
        last_ = sample.time;
      }
      FrameRecord record;
      record.index = i;
      record.stamp = frame.stamp;
      record.T_odom_lidar.linear() = rotation_at(seconds(frame.stamp));
      clocks.add(frame, record, std::nullopt);
      latest_ = std::move(frame);
    }
  }

  const DriveInfo& info() const { return info_; }
  /// s, error of the last stamps of the IMU.
  double error() const {
    const TimeNs stated = latest_.motion.imu.back().time;
    const double right = seconds(latest_.stamp) - 0.01;  // the last sample of a frame
    return seconds(stated) - right;
  }

 private:
  /// Measured from a frame on, up to the next one.
  std::vector<ImuSample> samples(int frame) const {
    std::vector<ImuSample> samples;
    for (int i = 0; i < 10; ++i) {
      const double time = 0.1 * frame + 0.01 * i;
      const double late = delay_ + drift_ * time;
      samples.push_back({from_seconds(time - late), rate_at(time), {0, 0, 9.81}});
    }
    return samples;
  }

  double delay_, drift_;
  DriveInfo info_;
  Frame latest_;
  TimeNs last_ = -kNsPerSecond * 100;
};

TEST(LiveClocks, TheClockOfAnImuIsCorrected) {
  TurningDrive drive(/*delay=*/0.02, /*drift=*/0);
  LiveClocks clocks(drive.info(), /*compensate=*/true);
  drive.run(clocks, LiveClocks::kWindow + LiveClocks::kLag + 2);
  EXPECT_NEAR(drive.error(), 0, 1e-3);
  EXPECT_THAT(clocks.messages().warnings,
              ElementsAre(HasSubstr("the clock of the IMU is 20.0 ms off")));
}

TEST(LiveClocks, ADriftIsFollowedAndReported) {
  TurningDrive drive(/*delay=*/0, /*drift=*/1e-4);
  LiveClocks clocks(drive.info(), /*compensate=*/true);
  drive.run(clocks, 4 * (LiveClocks::kWindow + LiveClocks::kLag) + 2);
  // 25 ms after 252 s; the estimate is that of the middle of the last minute.
  EXPECT_NEAR(drive.error(), 0, 8e-3);
  EXPECT_THAT(clocks.messages().notes, Contains(HasSubstr("the clock of the IMU drifts by 10")));
}

TEST(LiveClocks, AGoodClockStays) {
  TurningDrive drive(/*delay=*/0, /*drift=*/0);
  LiveClocks clocks(drive.info(), /*compensate=*/true);
  drive.run(clocks, 2 * LiveClocks::kWindow);
  EXPECT_THAT(clocks.messages().warnings, IsEmpty());
  EXPECT_NEAR(drive.error(), 0, 1e-9);
}

}  // namespace fovea::live_clocks_test
