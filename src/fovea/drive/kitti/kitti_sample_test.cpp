// The real drive: figures measured on it by other programs.
#include "../../../../tests/kitti_sample.h"

#include <gtest/gtest.h>

#include <numbers>

#include "fovea/core/parallel.h"
#include "fovea/deskew.h"
#include "fovea/drive/frame_source.h"
#include "fovea/drive/kitti/oxts.h"

namespace fovea::kitti_sample_test {

DriveOptions both_colour_cameras() {
  DriveOptions options;
  options.cameras = {2, 3};
  return options;
}

TEST(KittiSample, AllFramesLoadWithBothColourCameras) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(path);
  const auto drive = open_drive(path, both_colour_cameras());
  const DriveInfo& info = drive->info();
  EXPECT_EQ(info.kind, "kitti-raw");
  EXPECT_EQ(info.begin, 0);
  EXPECT_EQ(info.end, 51);
  EXPECT_TRUE(info.notes.empty()) << info.notes.front();
  EXPECT_FALSE(info.sweep_compensated);
  EXPECT_NEAR(info.sweep.period, 0.1034, 0.0002);
  for (int index = info.begin; index < info.end; ++index) {
    const LoadedFrame result = drive->load(index);
    ASSERT_TRUE(std::holds_alternative<Frame>(result)) << std::get<SkippedFrame>(result).detail;
    const Frame& frame = std::get<Frame>(result);
    EXPECT_EQ(frame.index, index);
    EXPECT_GT(frame.scan.size(), 110'000u);
    EXPECT_LT(frame.scan.size(), 123'000u);
    EXPECT_EQ(frame.scan.intensity.size(), frame.scan.size());
    EXPECT_EQ(frame.dropped_points.total(), 0u);
    ASSERT_EQ(frame.images.size(), 2u);
    for (const Image& image : frame.images) {
      EXPECT_EQ(image.width, 1242);
      EXPECT_EQ(image.height, 375);
      EXPECT_EQ(image.channels, 3);
    }
  }
  EXPECT_EQ(drive->stamp(0), 1'317'042'504'957'314'930);
}

TEST(KittiSample, ColourCamerasSitWhereTheRigHasThem) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(path);
  DriveOptions options;
  options.cameras = {3, 2};
  const auto drive = open_drive(path, options);
  const std::vector<Camera>& cameras = drive->info().calibration.cameras;
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].index, 3);
  // Camera 3 stands 0.533 m to the right of camera 2, both look the same way.
  const RigidMotion T_2_3 = cameras[1].T_cam_lidar * cameras[0].T_cam_lidar.inverse();
  EXPECT_NEAR(T_2_3.translation().x(), 0.473 + 0.060, 0.001);
  EXPECT_LT(T_2_3.translation().tail<2>().norm(), 0.005);
  EXPECT_LT(rotation_angle(T_2_3.rotation()), 1e-9);
  // A point 10 m ahead of the LiDAR lies about 10 m deep, near the middle of the image.
  const auto pixel = cameras[1].project(cameras[1].T_cam_lidar * Eigen::Vector3d(10, 0, 0));
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 609.6, 20);
  EXPECT_NEAR(pixel->y(), 172.9, 20);
}

TEST(KittiSample, NavigationStepsAsTheCarDrives) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(path);
  const auto drive = open_drive(path, {});
  const DriveInfo& info = drive->info();
  ASSERT_TRUE(info.navigation && info.origin);
  EXPECT_EQ(info.navigation->poses().size(), 447u);
  EXPECT_NEAR(info.origin->latitude, 49.0093, 1e-3);
  EXPECT_NEAR(info.origin->longitude, 8.4371, 1e-3);
  // The first scan lies 12 ms before the first record.
  EXPECT_LT(*drive->stamp(0), info.navigation->poses().front().time);

  std::vector<RigidMotion> poses;
  for (int index = info.begin; index < info.end; ++index) {
    const auto T = info.navigation->at(*drive->stamp(index));
    ASSERT_TRUE(T) << index;
    poses.push_back(*T);
  }
  EXPECT_LT(poses.front().translation().norm(), 1e-3);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double step = (poses[i].translation() - poses[i - 1].translation()).norm();
    EXPECT_GT(step, 1.055) << i;
    EXPECT_LT(step, 1.155) << i;
    // The car drives forwards: x of the LiDAR's own frame.
    EXPECT_GT((poses[i - 1].inverse() * poses[i]).translation().x(), 1.0) << i;
  }
}

TEST(KittiSample, MercatorShortcutIsTenCentimetresOff) {
  // The devkit's spherical Mercator projection is what others would put in the geodesy's place.
  FOVEA_KITTI_SAMPLE_OR_SKIP(path);
  const auto record = [&](const char* name) {
    return std::get<OxtsRecord>(read_oxts(path / "oxts" / "data" / name)).position;
  };
  const GeodeticPoint a = record("0000000000.txt"), b = record("0000000050.txt");
  const Eigen::Vector3d geodetic = LocalTangentPlane(a).T_local_enu(b).translation();
  constexpr double kEarthRadius = 6378137, kDegree = std::numbers::pi / 180;
  const double scale = std::cos(a.latitude * kDegree);
  const auto mercator = [&](const GeodeticPoint& p) {
    return Eigen::Vector3d(
        scale * kEarthRadius * p.longitude * kDegree,
        scale * kEarthRadius * std::log(std::tan(std::numbers::pi * (90 + p.latitude) / 360)),
        p.altitude);
  };
  EXPECT_NEAR(geodetic.norm(), 55, 2);
  EXPECT_NEAR((mercator(b) - mercator(a) - geodetic).norm(), 0.103, 0.003);
}

// 10.3 m/s over half a sweep: points behind the vehicle move by half a metre, those ahead not at
// all.
TEST(KittiSample, CompensationMovesPointsByTheWayDriven) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(path);
  const auto drive = open_drive(path, {});
  const Frame frame = std::get<Frame>(drive->load(0));
  const auto motion = drive->info().navigation->motion(frame.stamp, frame.stamp);
  ASSERT_TRUE(motion);
  PointCloud scan = frame.scan;
  compensate_sweep(scan, *motion, drive->info().sweep);
  const double half_way = motion->velocity.tail<3>().norm() * drive->info().sweep.period / 2;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3f& measured = frame.scan.position[i];
    const double share = std::abs(std::atan2(measured.y(), measured.x())) / std::numbers::pi;
    const double moved = (scan.position[i] - measured).norm();
    ASSERT_NEAR(moved, share * half_way, 0.005 + 0.004 * measured.norm());  // the rest is rotation
  }
}

}  // namespace fovea::kitti_sample_test
