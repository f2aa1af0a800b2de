// Drives of a vehicle with several LiDARs: their scans become one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "../../../tests/kitti_test_drive.h"
#include "fovea/core/angle.h"
#include "fovea/deskew.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/scans/sensor_scans.h"
#include "fovea/drive/writers/generic_drive_writer.h"
#include "fovea/errors.h"

namespace fovea::several_lidars_test {

using test::error_of;
using test::write_text;
using testing::Contains;
using testing::HasSubstr;

constexpr TimeNs kStart = 1'700'000'000'000'000'000, kStep = kNsPerSecond / 10;
constexpr int kFrames = 4;
constexpr double kDelay = -0.02;  // s, of the second LiDAR's stamps

/// A vehicle that turns while it drives.
const SweepMotion kMotion{(Twist() << 0, 0.02, 0.3, 10, 0.5, 0).finished()};

RigidMotion T_world_lidar(double time) { return exp_se3(kMotion.velocity * time); }

RigidMotion side_lidar() {
  RigidMotion T_lidar_sensor = RigidMotion::Identity();
  T_lidar_sensor.linear() =
      Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 0.5, 2).normalized()).toRotationMatrix();
  T_lidar_sensor.translation() = Eigen::Vector3d(1.5, 0.8, -0.6);
  return T_lidar_sensor;
}

/// Places of the world all around the vehicle.
std::vector<Eigen::Vector3d> world() {
  std::vector<Eigen::Vector3d> places;
  for (double azimuth = -175; azimuth < 180; azimuth += 10) {
    for (const double height : {-1.5, 0.5, 3.0}) {
      places.emplace_back(14 * std::cos(azimuth * kDegree), 14 * std::sin(azimuth * kDegree),
                          height);
    }
  }
  return places;
}

/// What a LiDAR measures of the world in a sweep. The intensity of a point is the number of its
/// place in thousandths. Places where the sweep begins and ends are left out.
/// @param stamp  s
PointCloud sweep(const RigidMotion& T_lidar_sensor, const SweepTiming& timing, double stamp,
                 bool has_times) {
  PointCloud scan;
  const std::vector<Eigen::Vector3d> places = world();
  for (std::size_t i = 0; i < places.size(); ++i) {
    double time = 0, change = 0;  // s, from the stamp
    Eigen::Vector3d p_sensor;
    for (int k = 0; k < 20; ++k) {
      p_sensor = (T_world_lidar(stamp + time) * T_lidar_sensor).inverse() * places[i];
      PointCloud one;
      one.position = {p_sensor.cast<float>()};
      add_point_times(one, timing);
      change = double(one.time.front()) - time;
      time += change;
    }
    if (std::abs(change) > 1e-6) continue;
    scan.position.push_back(p_sensor.cast<float>());
    scan.intensity.push_back(0.001f * float(i));
    if (has_times) scan.time.push_back(float(time));
  }
  return scan;
}

class SeveralLidars : public testing::Test {
 protected:
  /// @param delay  s, of the second LiDAR's stamps
  void write(bool has_times, double delay = kDelay, int first_scan = 0) {
    std::filesystem::remove_all(root_);
    GenericDriveWriter writer(root_);
    RecordedDrive drive;
    drive.lidar.name = "top";
    RecordedLidar& side = drive.further_lidars.emplace_back();
    side.name = "side";
    side.T_lidar_sensor = side_lidar();
    if (!has_times) {
      drive.lidar.sweep = kTop;
      side.sweep = kSide;
    }
    for (int frame = 0; frame < kFrames; ++frame) {
      const TimeNs stamp = kStart + frame * kStep;
      const double time = 0.1 * frame;
      writer.write_scan(frame, stamp, sweep(RigidMotion::Identity(), kTop, time, has_times),
                        ScanFile::kPcd, "top");
      if (frame < first_scan) continue;
      writer.write_scan(frame - first_scan, stamp + from_seconds(delay),
                        sweep(side_lidar(), kSide, time + delay, has_times), ScanFile::kPcd,
                        "side");
    }
    writer.finish(drive);
  }

  std::unique_ptr<FrameSource> open() const { return open_drive(root_, {}); }
  Frame load(int index) const { return std::get<Frame>(open()->load(index)); }

  /// Farthest from its place in the world that a point of a frame is, in m.
  double largest_error(int index) const {
    Frame frame = load(index);
    compensate_sweep(frame.scan, kMotion, open()->info().sweep);
    double largest = 0;
    const std::vector<Eigen::Vector3d> places = world();
    for (std::size_t i = 0; i < frame.scan.size(); ++i) {
      const Eigen::Vector3d p_world =
          T_world_lidar(0.1 * index) * frame.scan.position[i].cast<double>();
      const auto place = std::size_t(std::lround(1000 * frame.scan.intensity[i]));
      largest = std::max(largest, (p_world - places[place]).norm());
    }
    return largest;
  }

  const SweepTiming kTop{0.1, SweepDirection::kClockwise, std::numbers::pi, 0.5};
  const SweepTiming kSide{0.1, SweepDirection::kCounterclockwise, 0.7, 0};
  TemporaryFolder folder_;
  std::filesystem::path root_ = folder_ / "drive";
};

TEST_F(SeveralLidars, PointsWithTimesMeetAtTheTimeOfTheFrame) {
  write(/*has_times=*/true);
  EXPECT_GT(load(1).scan.size(), 2 * world().size() - 10);
  EXPECT_LT(largest_error(1), 1e-4);
}

TEST_F(SeveralLidars, PointsWithoutTimesGetThoseOfTheirOwnSweep) {
  write(/*has_times=*/false);
  EXPECT_LT(largest_error(2), 1e-4);
}

TEST_F(SeveralLidars, EachPointKeepsItsLidar) {
  write(/*has_times=*/true);
  const auto drive = open();
  ASSERT_EQ(drive->info().lidars.size(), 2u);
  EXPECT_EQ(drive->info().lidars[1].profile.name, "side");
  const std::vector<PointCloud> scans = scans_by_sensor(load(0).scan, drive->info().lidars);
  const PointCloud side = sweep(side_lidar(), kSide, kDelay, /*has_times=*/true);
  ASSERT_EQ(scans.at(1).size(), side.size());
  for (std::size_t i = 0; i < side.size(); ++i) {
    EXPECT_LT((scans[1].position[i] - side.position[i]).norm(), 1e-4f);
    EXPECT_NEAR(scans[1].time[i], side.time[i] + float(kDelay),
                1e-6f);  // from the stamp of the frame
  }
}

TEST_F(SeveralLidars, AFrameHasTheSweepsNearestToItsMiddle) {
  // The sweep from 60 to 160 ms after the stamp of a frame belongs to the next one.
  write(/*has_times=*/true, /*delay=*/0.06);
  EXPECT_EQ(load(0).missing_scans.size(), 1u);
  EXPECT_TRUE(load(1).missing_scans.empty());
  EXPECT_LT(largest_error(1), 1e-4);
}

TEST_F(SeveralLidars, AFrameWithoutAScanOfAFurtherLidarHasTheOthers) {
  write(/*has_times=*/true, kDelay, /*first_scan=*/1);
  EXPECT_THAT(open()->info().warnings,
              Contains(HasSubstr("LiDAR side has no scan within half a sweep of 1 of 4 frames")));
  const Frame frame = load(0);
  EXPECT_LE(frame.scan.size(), world().size());
  ASSERT_EQ(frame.missing_scans.size(), 1u);
  EXPECT_EQ(frame.missing_scans[0].lidar, "side");
  EXPECT_EQ(frame.missing_scans[0].reason, SkipReason::kMissingScan);
  EXPECT_LT(largest_error(1), 1e-4);
}

TEST_F(SeveralLidars, ADamagedScanOfAFurtherLidarIsReported) {
  write(/*has_times=*/true);
  write_text(root_ / "lidar/side/000002.pcd", "# .PCD v0.7\nVERSION 0.7\nFIELDS");
  const Frame frame = load(2);
  EXPECT_LE(frame.scan.size(), world().size());
  ASSERT_EQ(frame.missing_scans.size(), 1u);
  EXPECT_EQ(frame.missing_scans[0].reason, SkipReason::kDamagedScan);
  EXPECT_THAT(frame.missing_scans[0].detail, HasSubstr("000002.pcd"));
}

TEST_F(SeveralLidars, ScansOfAnotherClockAreAnError) {
  write(/*has_times=*/true, /*delay=*/5000);
  EXPECT_THAT(error_of<InputError>([&] { open(); }), HasSubstr("LiDAR side"));
}

TEST_F(SeveralLidars, WithoutStampsScansOfOneNumberBelongTogether) {
  write(/*has_times=*/true, /*delay=*/0);
  std::filesystem::remove(root_ / "lidar/top/stamps.csv");
  EXPECT_LT(largest_error(3), 1e-4);
}

TEST_F(SeveralLidars, ALidarWithoutScansIsAnError) {
  write(/*has_times=*/true);
  std::filesystem::remove_all(root_ / "lidar/side");
  EXPECT_THAT(error_of<InputError>([&] { open(); }), HasSubstr("[lidar.side]"));
}

TEST(AppendScan, KeepsRingsOnlyIfAllLidarsHaveThem) {
  PointCloud scan, other;
  scan.position = {{1, 0, 0}};
  scan.time = {0};
  scan.ring = {7};
  other.position = {{2, 0, 0}};
  other.time = {0};
  PointCloud with_rings = other;
  with_rings.ring = {3};
  PointCloud both = scan;
  append_scan(both, with_rings, 1, RigidMotion::Identity(), 0);
  EXPECT_EQ(both.ring, (std::vector<std::uint16_t>{7, 3}));
  EXPECT_EQ(both.sensor, (std::vector<std::uint16_t>{0, 1}));
  append_scan(scan, other, 1, RigidMotion::Identity(), 0);
  EXPECT_TRUE(scan.ring.empty());
}

}  // namespace fovea::several_lidars_test
