#include "fovea/drive/writers/generic_drive_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/parallel.h"
#include "fovea/drive/frame_source.h"
#include "fovea/errors.h"
#include "tests/temporary_folder.h"

namespace fovea::generic_drive_writer_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr TimeNs kStart = 1'700'000'000'123'456'789, kStep = 100'000'001;
constexpr int kFrames = 4;

RigidMotion some_motion() {
  return exp_se3((Twist() << 0.1, -0.2, 1.3, 0.4, 0.5, -0.6).finished());
}

RecordedDrive some_drive() {
  RecordedDrive drive;
  RecordedCamera plain, fish;
  plain.name = "plain";
  plain.index = 7;
  plain.optics = {30, 20, 25.125, 25.25, 14.5, 9.75, Lens()};
  plain.T_lidar_cam = some_motion();
  fish.name = "fish-eye_1";
  fish.index = 0;
  fish.optics = {30,
                 20,
                 25.125,
                 25.25,
                 14.5,
                 9.75,
                 Lens(LensModel::kEquidistant, {-0.012, 0.004, -0.002, 0.0003})};
  drive.cameras = {plain, fish};
  drive.T_body_lidar.translation = Eigen::Vector3d(0.1, 1.0 / 3, 1.5);
  for (int i = 0; i < kFrames; ++i) {
    RecordedPosition position;
    position.time = kStart + i * kStep;
    position.antenna = {49.0 + 1e-5 * i, 8.43, 1.0 / 3};
    position.accuracy = 0.25;
    position.roll_pitch_yaw = Eigen::Vector3d(0.01, -0.02, 1.5);
    drive.positions.push_back(position);
  }
  return drive;
}

PointCloud some_scan(int i, bool timed) {
  PointCloud scan;
  scan.position = {{1, 2, 3}, {float(i) + 0.1f, 5, 6}};
  scan.intensity = {0.25f, 1.0f / 3};
  if (timed) scan.time = {-0.05f, 1.0f / 30};
  return scan;
}

void write_drive(GenericDriveWriter& writer, const RecordedDrive& drive) {
  parallel_for(std::size_t(kFrames), 1, [&](std::size_t k) {
    const int i = int(k);
    writer.write_scan(i, kStart + i * kStep, some_scan(i, i % 2 == 1));
    Image image(30, 20, 3);
    image.data[5] = static_cast<std::uint8_t>(i);
    writer.write_image("plain", i, kStart + i * kStep + 2'000'000, image);
    writer.write_image("fish-eye_1", i, kStart + i * kStep, image);
  });
  writer.finish(drive);
}

TEST(GenericDriveWriter, TheReaderFindsWhatWasWritten) {
  const TemporaryFolder folder;
  const RecordedDrive drive = some_drive();
  {
    GenericDriveWriter writer(folder / "d");
    write_drive(writer, drive);
  }
  EXPECT_THAT(folder.names(), ElementsAre("d"));
  DriveOptions options;
  options.cameras = {7, 0};
  const auto source = open_drive(folder / "d", options);
  const DriveInfo& info = source->info();
  EXPECT_THAT(info.notes, ElementsAre(HasSubstr("the points have no times")));
  const Camera& plain = info.calibration.cameras[0];
  EXPECT_EQ(plain.fx, 25.125);
  EXPECT_EQ(plain.cy, 9.75);
  EXPECT_TRUE(plain.T_cam_lidar.isApprox(some_motion().inverse(), 1e-15));
  EXPECT_NEAR(plain.image_delay, 0.002, 1e-12);
  EXPECT_EQ(info.calibration.T_imu_lidar->translation(), drive.T_body_lidar.translation);
  EXPECT_EQ(info.navigation->poses().size(), std::size_t(kFrames));
  EXPECT_EQ(info.navigation->poses()[1].time, kStart + kStep);
  EXPECT_THAT(info.navigation_accuracy, testing::Each(0.25));
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = std::get<Frame>(source->load(i));
    EXPECT_EQ(frame.stamp, kStart + i * kStep);
    EXPECT_EQ(frame.scan.position, some_scan(i, false).position);
    EXPECT_EQ(frame.scan.intensity, some_scan(i, false).intensity);
    EXPECT_EQ(frame.scan.time, some_scan(i, i % 2 == 1).time);
    EXPECT_EQ(frame.images[0].data[5], i);
  }
}

TEST(GenericDriveWriter, PosesAndOrientationsComeBack) {
  const TemporaryFolder folder;
  RecordedDrive drive = some_drive();
  for (RecordedPosition& position : drive.positions) {
    position.roll_pitch_yaw.reset();
    RecordedInertia inertia;
    inertia.time = position.time;
    inertia.R_enu_imu = Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
    drive.inertia.push_back(inertia);
  }
  {
    GenericDriveWriter writer(folder / "imu");
    write_drive(writer, drive);
  }
  const auto by_imu = open_drive(folder / "imu", {});
  EXPECT_THAT(by_imu->info().notes, ElementsAre(HasSubstr("the points have no times")));
  const Eigen::Matrix3d R = by_imu->info().navigation->poses()[1].T_local_body.linear();
  EXPECT_NEAR(std::atan2(R(1, 0), R(0, 0)), 0.7, 1e-6);

  for (int i = 0; i < kFrames; ++i) {
    RigidMotion T = some_motion();
    T.translation().x() += i;
    drive.poses.push_back({kStart + i * kStep, T});
  }
  {
    GenericDriveWriter writer(folder / "poses");
    write_drive(writer, drive);
  }
  const auto by_poses = open_drive(folder / "poses", {});
  EXPECT_FALSE(by_poses->info().origin);
  const auto& poses = by_poses->info().navigation->poses();
  const RigidMotion step = poses[0].T_local_body.inverse() * poses[1].T_local_body;
  const RigidMotion expected = ((drive.poses[0].T_world_body * drive.T_body_lidar).inverse() *
                                drive.poses[1].T_world_body * drive.T_body_lidar)
                                   .matrix();
  EXPECT_TRUE(step.isApprox(expected, 1e-12));
}

TEST(GenericDriveWriter, LeavesNothingUnfinishedAndReplacesNothing) {
  const TemporaryFolder folder;
  {
    GenericDriveWriter writer(folder / "d");
    writer.write_scan(0, 1, some_scan(0, true));
    EXPECT_THROW(GenericDriveWriter(folder / "d"), OutputError);
    EXPECT_THROW(writer.write_image("../out", 0, 1, Image(8, 8, 1)), std::invalid_argument);
  }
  EXPECT_THAT(folder.names(), IsEmpty());
  std::filesystem::create_directory(folder / "d");
  EXPECT_THROW(GenericDriveWriter(folder / "d"), OutputError);
  EXPECT_THROW(GenericDriveWriter(folder / "none/d"), OutputError);
}

}  // namespace fovea::generic_drive_writer_test
