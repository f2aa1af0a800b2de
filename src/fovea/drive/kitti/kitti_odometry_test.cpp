#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../../tests/kitti_test_drive.h"
#include "fovea/drive/frame_source.h"
#include "fovea/errors.h"

namespace fovea::kitti_odometry_test {

using test::error_of;
using test::fs::path;
using testing::ElementsAre;
using testing::HasSubstr;

class KittiOdometry : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  path sequence_ = test::write_odometry_sequence(folder_.path(), 6);
};

TEST_F(KittiOdometry, LoadsASequence) {
  const auto drive = open_drive(sequence_, {});
  const DriveInfo& info = drive->info();
  EXPECT_EQ(info.kind, "kitti-odometry");
  EXPECT_TRUE(info.sweep_compensated);
  EXPECT_FALSE(info.navigation || info.origin || info.calibration.T_imu_lidar);
  EXPECT_EQ(info.end, 6);
  EXPECT_THAT(info.notes, testing::IsEmpty());
  ASSERT_EQ(info.calibration.cameras.size(), 1u);
  EXPECT_EQ(info.calibration.cameras[0].index, 0);  // no colour camera is there
  EXPECT_EQ(info.calibration.cameras[0].width, test::kWidth);
  EXPECT_EQ(info.calibration.cameras[0].height, test::kHeight);
  EXPECT_EQ(drive->stamp(3), 300'000'000);
  for (int i = 0; i < 6; ++i) {
    const Frame frame = std::get<Frame>(drive->load(i));
    EXPECT_EQ(frame.images.at(0).channels, 1);
  }
}

TEST_F(KittiOdometry, ReferencePosesAreTheLidars) {
  // Camera 0 moves 1 m a frame along its z, which is the LiDAR's x.
  const auto check = [&] {
    const auto poses = open_drive(sequence_, {})->info().reference_poses;
    ASSERT_EQ(poses.size(), 6u);
    for (int i = 0; i < 6; ++i) {
      const RigidMotion& T = poses[static_cast<std::size_t>(i)];
      EXPECT_LT((T.translation() - Eigen::Vector3d(i, 0, 0)).norm(), 1e-12);
      EXPECT_LT(rotation_angle(T.rotation()), 1e-12);
    }
  };
  check();
  test::fs::rename(folder_.path() / "poses" / "07.txt", sequence_ / "poses.txt");
  check();
}

TEST_F(KittiOdometry, ReferencePosesTurnAboutTheLidar) {
  // Camera 0 turns left about its own centre by a quarter: the LiDAR, 0.25 m behind it, swings out.
  test::write_text(folder_.path() / "poses" / "07.txt",
                   "1 0 0 5 0 1 0 6 0 0 1 7\n0 0 -1 5 0 1 0 6 1 0 0 7\n");
  const auto poses = open_drive(sequence_, {})->info().reference_poses;
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_TRUE(poses[0].isApprox(RigidMotion::Identity(), 1e-12));
  EXPECT_LT((poses[1].rotation().col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((poses[1].translation() - Eigen::Vector3d(0.25, -0.25, 0)).norm(), 1e-12);
}

TEST_F(KittiOdometry, DamagedPosesAreNotedAndLeftOut) {
  test::write_text(folder_.path() / "poses" / "07.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0\n");
  const auto drive = open_drive(sequence_, {});
  EXPECT_TRUE(drive->info().reference_poses.empty());
  EXPECT_THAT(drive->info().notes, ElementsAre(HasSubstr("07.txt:2")));
}

TEST_F(KittiOdometry, WithoutTimesTenHertz) {
  test::fs::remove(sequence_ / "times.txt");
  const auto drive = open_drive(sequence_, {});
  EXPECT_FALSE(drive->info().has_time_stamps);
  EXPECT_EQ(drive->stamp(3), 300'000'000);
  EXPECT_THAT(drive->info().notes, ElementsAre(HasSubstr("times.txt is missing")));
}

TEST_F(KittiOdometry, StampsThatAreNoSweepsAreAnError) {
  std::string times;
  for (int i = 0; i < 6; ++i) times += std::to_string(1e-4 * i) + "\n";
  test::write_text(sequence_ / "times.txt", times);
  EXPECT_THAT(
      error_of<InputError>([&] { open_drive(sequence_, {}); }),
      testing::AllOf(HasSubstr("0.0001 s apart"), HasSubstr("times.txt"), HasSubstr("unit")));
}

TEST_F(KittiOdometry, SizeIsThatOfTheFirstReadableImage) {
  test::truncate(sequence_ / "image_0/000000.png", 0.5);
  const auto drive = open_drive(sequence_, {});
  EXPECT_EQ(drive->info().calibration.cameras[0].width, test::kWidth);
  EXPECT_EQ(std::get<SkippedFrame>(drive->load(0)).reason, SkipReason::kDamagedImage);
  EXPECT_TRUE(std::holds_alternative<Frame>(drive->load(1)));
  for (int i = 0; i < 6; ++i) {
    test::write_text(sequence_ / fmt::format("image_0/{:06}.png", i), "no image");
  }
  EXPECT_THAT(error_of<InputError>([&] { open_drive(sequence_, {}); }),
              HasSubstr("no image of camera 0 can be read"));
}

TEST_F(KittiOdometry, BadSequences) {
  DriveOptions colour;
  colour.cameras = {2};
  EXPECT_THAT(error_of<ConfigError>([&] { open_drive(sequence_, colour); }),
              HasSubstr("choose from 0, 1"));
  test::fs::remove(sequence_ / "calib.txt");
  EXPECT_THAT(error_of<InputError>([&] { open_drive(sequence_, {}); }), HasSubstr("calib.txt"));
  test::fs::remove_all(sequence_ / "velodyne");
  test::fs::create_directory(sequence_ / "velodyne");
  EXPECT_THAT(error_of<InputError>([&] { open_drive(sequence_, {}); }), HasSubstr("no scan"));
}

}  // namespace fovea::kitti_odometry_test
