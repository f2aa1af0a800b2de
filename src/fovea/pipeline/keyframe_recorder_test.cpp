#include "fovea/pipeline/keyframe_recorder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fovea/core/angle.h"

namespace fovea::keyframe_recorder_test {

constexpr std::size_t kColumns = 1440;
constexpr double kColumnStep = 2 * std::numbers::pi / kColumns;  // 0.25 degrees

/// Rings from 10 to -20 degrees, every 2 degrees.
SensorProfile rings() {
  SensorProfile profile;
  for (int ring = 0; ring < 16; ++ring) {
    profile.ring_elevations.push_back((10 - 2 * ring) * kDegree);
  }
  profile.ring_spacing = 2 * kDegree;
  return profile;
}

DriveInfo drive_with(const std::vector<MountedLidar>& lidars) {
  DriveInfo drive;
  drive.lidars = lidars;
  return drive;
}

/// The point at a range, elevation and azimuth (m, degrees).
Eigen::Vector3f at(double range, double elevation, double azimuth) {
  const double up = elevation * kDegree, around = azimuth * kDegree;
  return (range * Eigen::Vector3d(std::cos(up) * std::cos(around), std::cos(up) * std::sin(around),
                                  std::sin(up)))
      .cast<float>();
}

/// The image of a scan of the LiDAR with rings.
KeyframeRecord image_of(const std::vector<Eigen::Vector3f>& points) {
  PointCloud scan;
  scan.position = points;
  auto images = range_images(scan, drive_with({{.profile = rings()}}), 7);
  EXPECT_EQ(images.size(), 1u);
  return images.front();
}

std::size_t returns_in(const KeyframeRecord& image) {
  return image.ranges.size() -
         std::size_t(std::count(image.ranges.begin(), image.ranges.end(), std::uint16_t{0}));
}

/// Range in the cell at an azimuth (degrees), cm.
int range_at(const KeyframeRecord& image, std::size_t row, double azimuth) {
  const double column = (azimuth * kDegree - image.first_azimuth) / image.azimuth_step;
  return image.ranges.at(row * image.columns + std::size_t(std::lround(column)) % image.columns);
}

TEST(RangeImages, DescribeTheLidar) {
  const KeyframeRecord image = image_of({});
  EXPECT_EQ(image.frame, 7);
  EXPECT_EQ(image.sensor, 0);
  EXPECT_EQ(image.elevations, rings().ring_elevations);
  EXPECT_EQ(image.columns, kColumns);
  EXPECT_NEAR(image.first_azimuth, -std::numbers::pi, 1e-12);
  EXPECT_NEAR(image.azimuth_step, kColumnStep, 1e-12);
  EXPECT_EQ(image.ranges.size(), 16 * kColumns);
  EXPECT_EQ(returns_in(image), 0u);
}

TEST(RangeImages, ReturnsAreInTheirRowAndColumn) {
  const KeyframeRecord image = image_of({at(12.344, 10, 0), at(5.006, -20, 90), at(80, -4, -90.1),
                                         at(0.5, 0.9, 179.9), at(2, 4, -180), at(3, -6.8, 45.1)});
  EXPECT_EQ(returns_in(image), 6u);
  EXPECT_EQ(image.ranges[720], 1234);                  // ahead, first row
  EXPECT_EQ(image.ranges[15 * kColumns + 1080], 501);  // left, last row
  EXPECT_EQ(image.ranges[7 * kColumns + 360], 8000);   // right
  EXPECT_EQ(image.ranges[5 * kColumns + 0], 50);       // behind: the columns form a ring
  EXPECT_EQ(image.ranges[3 * kColumns + 0], 200);
  EXPECT_EQ(image.ranges[8 * kColumns + 900], 300);
}

TEST(RangeImages, ADenseScanComesBackAtItsPlace) {
  std::vector<Eigen::Vector3f> points;
  const auto range = [](std::size_t row, std::size_t column) {
    return 2 + 0.37 * double(row) + 0.01 * double(column);
  };
  for (std::size_t row = 0; row < 16; ++row) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      points.push_back(at(range(row, column), 10 - 2 * double(row), -180 + 0.25 * double(column)));
    }
  }
  const KeyframeRecord image = image_of(points);
  for (std::size_t row = 0; row < 16; ++row) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      ASSERT_EQ(image.ranges[row * kColumns + column], std::lround(100 * range(row, column)))
          << row << " " << column;
    }
  }
}

TEST(RangeImages, TheReturnNearestToTheCenterCounts) {
  const Eigen::Vector3f near_center = at(20, 0.05, 30.02), off_azimuth = at(5, 0, 30.1),
                        off_elevation = at(40, 0.6, 30), at_corner = at(6, -0.9, 29.9);
  std::vector<Eigen::Vector3f> points{at_corner, off_azimuth, near_center, off_elevation};
  EXPECT_EQ(range_at(image_of(points), 5, 30), 2000);
  std::reverse(points.begin(), points.end());
  EXPECT_EQ(range_at(image_of(points), 5, 30), 2000);
  EXPECT_EQ(range_at(image_of({at_corner, off_elevation}), 5, 30), 4000);
  EXPECT_EQ(range_at(image_of({off_elevation, off_azimuth}), 5, 30), 500);
}

TEST(RangeImages, ReturnsBeyondTheOutermostRowsAreLeftOut) {
  EXPECT_EQ(returns_in(image_of({at(10, 12.5, 0), at(10, 45, 10), at(10, 89.9, 20),
                                 at(10, -22.5, 30), at(10, -89.9, 40)})),
            0u);
  const KeyframeRecord image = image_of({at(10, 10.9, 0), at(11, -20.9, 0)});
  EXPECT_EQ(range_at(image, 0, 0), 1000);
  EXPECT_EQ(range_at(image, 15, 0), 1100);
}

// Half a step of 2 degrees is 1 degree: a row shows no return that is farther away.
TEST(RangeImages, ARowReachesHalfAStep) {
  EXPECT_EQ(returns_in(image_of({at(10, 11.2, 0), at(10, -21.2, 0), at(10, 11.9, 10)})), 0u);
}

TEST(RangeImages, PointsWithoutRangeAreLeftOut) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(),
                  kInfinity = std::numeric_limits<float>::infinity();
  const KeyframeRecord image = image_of({{0, 0, 0},
                                         {kNaN, 0, 0},
                                         {1, kNaN, 0},
                                         {1, 0, kNaN},
                                         {kNaN, kNaN, kNaN},
                                         {kInfinity, 0, 0},
                                         {1, -kInfinity, 0},
                                         at(700, 0, 0)});
  EXPECT_EQ(returns_in(image), 0u);
}

TEST(RangeImages, TheRangesFitInto16Bits) {
  const KeyframeRecord image = image_of({at(655.3, 0, 0), at(0.002, 0, 10)});
  EXPECT_NEAR(range_at(image, 5, 0), 65530, 1);
  EXPECT_EQ(range_at(image, 5, 10), 1);  // 0 is no return
}

TEST(RangeImages, ALidarWithoutRingsHasUniformRows) {
  PointCloud scan;
  scan.position = {at(10, 60, 0), at(11, -59.5, 0), at(12, 0.3, 0), at(13, 61.5, 0)};
  for (const auto& lidars : {std::vector<MountedLidar>{}, std::vector<MountedLidar>(1)}) {
    const KeyframeRecord image = range_images(scan, drive_with(lidars), 0).at(0);
    ASSERT_EQ(image.elevations.size(), 241u);
    for (std::size_t row = 0; row < 241; ++row) {
      ASSERT_NEAR(image.elevations[row], (60 - 0.5 * double(row)) * kDegree, 1e-9);
    }
    EXPECT_EQ(returns_in(image), 3u);
    EXPECT_EQ(range_at(image, 0, 0), 1000);
    EXPECT_EQ(range_at(image, 239, 0), 1100);
    EXPECT_EQ(range_at(image, 119, 0), 1200);
  }
}

TEST(RangeImages, EachLidarHasAnImageInItsOwnFrame) {
  std::vector<MountedLidar> lidars(2);
  lidars[0].profile = lidars[1].profile = rings();
  lidars[1].profile.ring_elevations.resize(12);
  RigidMotion& T_lidar_sensor = lidars[1].T_lidar_sensor;
  T_lidar_sensor = Eigen::Translation3d(1, -0.5, -1.2);
  T_lidar_sensor.rotate(Eigen::AngleAxisd(0.8, Eigen::Vector3d(0.1, 0.3, 1).normalized()));
  PointCloud scan;
  scan.position = {at(10, 4, 20), T_lidar_sensor.cast<float>() * at(7, -2, -60), at(15, -20, 100),
                   T_lidar_sensor.cast<float>() * at(9, 10, 170)};
  scan.sensor = {0, 1, 0, 1};
  const auto images = range_images(scan, drive_with(lidars), 3);
  ASSERT_EQ(images.size(), 2u);
  for (const int k : {0, 1}) {
    EXPECT_EQ(images[std::size_t(k)].sensor, k);
    EXPECT_EQ(images[std::size_t(k)].frame, 3);
    EXPECT_EQ(returns_in(images[std::size_t(k)]), 2u);
  }
  EXPECT_EQ(range_at(images[0], 3, 20), 1000);
  EXPECT_EQ(range_at(images[0], 15, 100), 1500);
  EXPECT_EQ(images[1].elevations.size(), 12u);
  EXPECT_EQ(range_at(images[1], 6, -60), 700);
  EXPECT_EQ(range_at(images[1], 0, 170), 900);
}

/// A frame at x (m) of the road.
TrackedFrame frame_at(int index, double x, int submap, FrameStatus status = FrameStatus::kMapped) {
  TrackedFrame frame;
  TrackedScan& tracked = frame.tracked.emplace();
  tracked.result.index = index;
  tracked.result.status = status;
  tracked.result.poses.submap = submap;
  tracked.result.poses.T_odom_lidar = RigidMotion(Eigen::Translation3d(x, 0, 0));
  tracked.scan_lidar.position = {at(10, 0, 0)};
  return frame;
}

/// Numbers of the frames of the range images.
std::vector<int> frames_of(const std::vector<KeyframeRecord>& images) {
  std::vector<int> frames;
  for (const KeyframeRecord& image : images) frames.push_back(image.frame);
  return frames;
}

class Keyframes : public testing::Test {
 protected:
  std::vector<int> chosen(double spacing, const std::vector<TrackedFrame>& frames) const {
    KeyframeRecorder recorder(spacing, drive_);
    for (const TrackedFrame& frame : frames) recorder.add(frame);
    return frames_of(recorder.take());
  }

  const DriveInfo drive_ = drive_with({{.profile = rings()}});
};

TEST_F(Keyframes, TheFirstFrameOfASubmapAndOneAtEachSpacing) {
  std::vector<TrackedFrame> frames;
  for (int i = 0; i < 12; ++i) frames.push_back(frame_at(i, i, i < 6 ? 0 : 1));
  EXPECT_EQ(chosen(2.5, frames), (std::vector<int>{0, 3, 6, 9}));
  EXPECT_EQ(chosen(2, frames), (std::vector<int>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(chosen(4, frames), (std::vector<int>{0, 4, 6, 10}));
  EXPECT_EQ(chosen(100, frames), (std::vector<int>{0, 6}));
}

TEST_F(Keyframes, AVehicleThatStandsOrTurnsBackGivesNoneWithinTheSpacing) {
  std::vector<TrackedFrame> frames;
  for (const double x : {0.0, 0.0, 1.0, 0.0, -1.0, -2.0, -1.0, 0.0}) {
    frames.push_back(frame_at(int(frames.size()), x, 0));
  }
  EXPECT_EQ(chosen(1.5, frames), (std::vector<int>{0, 5, 7}));
}

TEST_F(Keyframes, OnlyMappedFramesCount) {
  std::vector<TrackedFrame> frames;
  for (int i = 0; i < 10; ++i) {
    const bool held_out = i == 0 || i == 4 || i == 6;
    frames.push_back(
        frame_at(i, i, i < 6 ? 0 : 1, held_out ? FrameStatus::kHeldOut : FrameStatus::kMapped));
    if (i == 5) frames.back().tracked->result.status = FrameStatus::kSkipped;
    if (i == 9) frames.back().tracked.reset();
  }
  EXPECT_EQ(chosen(1, frames), (std::vector<int>{1, 2, 3, 7, 8}));
  EXPECT_EQ(chosen(2.5, frames), (std::vector<int>{1, 7}));
}

TEST_F(Keyframes, WithoutSpacingThereAreNone) {
  EXPECT_EQ(chosen(0, {frame_at(0, 0, 0), frame_at(1, 50, 0), frame_at(2, 60, 1)}),
            std::vector<int>());
}

TEST_F(Keyframes, EachRangeImageIsTakenOnce) {
  KeyframeRecorder recorder(1, drive_);
  recorder.add(frame_at(0, 0, 0));
  const auto images = recorder.take();
  ASSERT_EQ(images.size(), 1u);
  EXPECT_EQ(range_at(images.front(), 5, 0), 1000);
  EXPECT_TRUE(recorder.take().empty());
  recorder.add(frame_at(1, 1, 0));
  EXPECT_EQ(frames_of(recorder.take()), std::vector<int>{1});
}

TEST_F(Keyframes, ARunThatResumesChoosesTheSame) {
  std::vector<TrackedFrame> frames;
  for (int i = 0; i < 24; ++i) {
    const auto status = i % 7 == 3 || i == 0 ? FrameStatus::kHeldOut : FrameStatus::kMapped;
    frames.push_back(frame_at(i, 0.8 * i, i / 9, status));
  }
  const std::vector<int> whole = chosen(2, frames);
  EXPECT_EQ(whole.front(), 1);
  for (int stored = 0; stored <= 24; ++stored) {
    KeyframeRecorder recorder(2, drive_);
    for (int i = 0; i < stored; ++i) {
      recorder.add_stored(record_of(frames[std::size_t(i)].tracked->result));
    }
    EXPECT_TRUE(recorder.take().empty());
    for (int i = stored; i < 24; ++i) recorder.add(frames[std::size_t(i)]);
    const auto rest = std::find_if(whole.begin(), whole.end(), [&](int f) { return f >= stored; });
    EXPECT_EQ(frames_of(recorder.take()), std::vector<int>(rest, whole.end())) << stored;
  }
}

}  // namespace fovea::keyframe_recorder_test
