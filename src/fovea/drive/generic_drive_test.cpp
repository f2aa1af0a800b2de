// Drives with a drive.toml, written by hand.
#include "fovea/drive/generic_drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "../../../tests/kitti_test_drive.h"
#include "../../../tests/peak_memory.h"
#include "fovea/errors.h"

namespace fovea::generic_drive_test {

using test::error_of;
using test::pattern;
using test::write_png;
using test::write_scan;
using test::write_text;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr int kFrames = 6;
constexpr TimeNs kStart = 1'700'000'000'000'000'000, kStep = kNsPerSecond / 10;
constexpr double kDegree = std::numbers::pi / 180;
constexpr const char* kNoTimes = "the points have no times";

std::string stamps(int count, TimeNs shift = 0) {
  std::string text = "index,time_ns\n";
  for (int i = 0; i < count; ++i) text += fmt::format("{},{}\n", i, kStart + i * kStep + shift);
  return text;
}

/// Six scans, two cameras (1: "left", 4: "right"), poses of a drive along x at 10 m/s.
class GenericDrive : public testing::Test {
 protected:
  GenericDrive() {
    std::string toml = "version = 1\n[body]\nT_body_lidar = {translation = [0, 0, 2]}\n";
    for (const auto& [name, index] : {std::pair("left", 1), std::pair("right", 4)}) {
      toml += fmt::format(
          "[camera.{}]\nindex = {}\nwidth = 24\nheight = 10\nK = [20, 0, 12, 0, 20, 5, 0, 0, 1]\n"
          "T_cam_lidar = [0, -1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0]\n",
          name, index);
      for (int i = 0; i < kFrames; ++i) write_png(image(name, i), pattern(24, 10, 3));
    }
    write_text(toml_, toml);
    std::string poses = "time_ns,x,y,z,qx,qy,qz,qw\n";
    for (int i = 0; i < kFrames; ++i) {
      write_scan(scan(i), {{float(i) + 1, 2, 3, 0.5f}, {4, 5, 6, 1}});
      poses += fmt::format("{},{},200,30,0,0,0,1\n", kStart + i * kStep, 100 + i);
    }
    write_text(scan_stamps_, stamps(kFrames));
    write_text(folder_ / "poses.csv", poses);
  }

  std::filesystem::path scan(int i) const { return folder_ / fmt::format("lidar/{:06d}.bin", i); }
  std::filesystem::path image(const std::string& camera, int i) const {
    return folder_ / fmt::format("images/{}/{}.png", camera, i);
  }
  std::unique_ptr<FrameSource> open() const { return open_drive(folder_.path(), options_); }
  /// Without the note on the times that the points of these scans do not have.
  std::vector<std::string> notes() const { return notes_of(*open()); }
  static std::vector<std::string> notes_of(const FrameSource& drive) {
    std::vector<std::string> notes = drive.info().notes;
    std::erase_if(notes, [](const std::string& note) { return note.starts_with(kNoTimes); });
    return notes;
  }
  void expect_skipped(int index, SkipReason reason, const std::string& detail) const {
    const LoadedFrame result = open()->load(index);
    ASSERT_TRUE(std::holds_alternative<SkippedFrame>(result));
    EXPECT_EQ(std::get<SkippedFrame>(result).reason, reason);
    EXPECT_THAT(std::get<SkippedFrame>(result).detail, HasSubstr(detail));
  }
  template <class E>
  std::string error() const {
    return error_of<E>([&] { open(); });
  }

  TemporaryFolder folder_;
  std::filesystem::path toml_ = folder_ / "drive.toml", scan_stamps_ = folder_ / "lidar/stamps.csv";
  DriveOptions options_;
};

TEST_F(GenericDrive, OpensAndLoads) {
  options_.cameras = {4, 1};
  const auto drive = open();
  const DriveInfo& info = drive->info();
  EXPECT_EQ(info.kind, "generic");
  EXPECT_EQ(info.begin, 0);
  EXPECT_EQ(info.end, kFrames);
  EXPECT_NEAR(info.sweep.period, 0.1, 1e-9);
  EXPECT_THAT(notes_of(*drive), IsEmpty());
  ASSERT_EQ(info.calibration.cameras.size(), 2u);
  EXPECT_EQ(info.calibration.cameras[0].index, 4);
  EXPECT_EQ(info.calibration.cameras[0].image_delay, 0);
  EXPECT_FALSE(info.image_stamps_are_capture_times);
  EXPECT_FALSE(info.has_image_delays());
  const Frame frame = std::get<Frame>(drive->load(2));
  EXPECT_EQ(frame.stamp, kStart + 2 * kStep);
  EXPECT_EQ(frame.scan.position[0], Eigen::Vector3f(3, 2, 3));
  EXPECT_EQ(frame.images[1].data, pattern(24, 10, 3).data);
}

TEST_F(GenericDrive, PosesOfTheBodyBecomePosesOfTheLidarFromItsFirstPlaceOn) {
  const auto drive = open();
  const DriveInfo& info = drive->info();
  ASSERT_TRUE(info.navigation);
  EXPECT_FALSE(info.origin);
  for (int i = 0; i < kFrames; ++i) {
    EXPECT_LT(
        (info.navigation->at(*drive->stamp(i))->translation() - Eigen::Vector3d(i, 0, 0)).norm(),
        1e-9);
  }
  EXPECT_EQ(info.calibration.T_imu_lidar->translation().z(), 2);
  options_.use_navigation = false;
  EXPECT_FALSE(open()->info().navigation);
}

TEST_F(GenericDrive, PosesThatDoNotReachTheScansAreTold) {
  write_text(scan_stamps_, stamps(kFrames, -3 * kStep));
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("poses or positions reach 5 of 6 scans")));
  EXPECT_TRUE(open()->info().navigation);
  write_text(scan_stamps_, stamps(kFrames, 3600 * kNsPerSecond));
  EXPECT_THAT(notes(), ElementsAre(AllOf(HasSubstr("reach 0 of 6"), HasSubstr("one clock"))));
  EXPECT_FALSE(open()->info().navigation);
}

TEST_F(GenericDrive, PosesThatMoveAsNoVehicleAreAnErrorWithItsCause) {
  const auto write_poses = [&](const std::function<RigidMotion(double way)>& T) {
    std::string text = "time_ns,x,y,z,qx,qy,qz,qw\n";
    for (int i = 0; i < kFrames; ++i) {
      const RigidMotion pose = T(i);
      const Eigen::Vector3d p = pose.translation();
      const Eigen::Quaterniond q(pose.linear());
      text += fmt::format("{},{},{},{},{},{},{},{}\n", kStart + i * kStep, p.x(), p.y(), p.z(),
                          q.x(), q.y(), q.z(), q.w());
    }
    write_text(folder_ / "poses.csv", text);
  };
  // A bend, in coordinates of UTM.
  const auto T_world_body = [](double way) {
    RigidMotion T(Eigen::AngleAxisd(0.02 * way, Eigen::Vector3d::UnitZ()));
    T.pretranslate(Eigen::Vector3d(450'000 + way, 5'400'000, 110));
    return T;
  };
  write_poses(T_world_body);
  EXPECT_NO_THROW(open());
  write_poses([&](double way) { return T_world_body(way).inverse(); });
  EXPECT_THAT(error<InputError>(), AllOf(HasSubstr("likely T_body_world, not T_world_body"),
                                         HasSubstr("poses.csv"), HasSubstr("give T_world_body")));
  write_poses([&](double way) { return T_world_body(1000 * way); });
  EXPECT_THAT(error<InputError>(), HasSubstr("another unit than meters"));
}

TEST_F(GenericDrive, TheFirstCameraThatThereIsWithoutAnyAskedFor) {
  EXPECT_EQ(open()->info().calibration.cameras.at(0).index, 1);
  test::fs::remove_all(folder_ / "images/left");
  const auto drive = open();
  EXPECT_EQ(drive->info().calibration.cameras.at(0).index, 4);
  EXPECT_THAT(notes_of(*drive), ElementsAre(HasSubstr("camera 1 (left) has no image")));
  options_.cameras = {1};
  EXPECT_THAT(error<ConfigError>(), AllOf(HasSubstr("no camera 1"), HasSubstr("choose from 4")));
  test::fs::remove_all(folder_ / "images");
  EXPECT_THAT(error<InputError>(), HasSubstr("no camera"));
}

TEST_F(GenericDrive, ADriveWithoutCamerasHasScansAndPoses) {
  write_text(toml_, "version = 1\n");
  const auto drive = open();
  EXPECT_TRUE(drive->info().calibration.cameras.empty());
  EXPECT_TRUE(drive->info().navigation);
  EXPECT_THAT(notes_of(*drive), ElementsAre(HasSubstr("the drive has no camera")));
  const Frame frame = std::get<Frame>(drive->load(2));
  EXPECT_EQ(frame.scan.size(), 2u);
  EXPECT_TRUE(frame.images.empty());
  options_.cameras = {1};
  EXPECT_THAT(error<InputError>(), HasSubstr("no camera"));
  options_ = {};
  options_.use_images = false;
  EXPECT_THAT(notes(), IsEmpty());
}

TEST_F(GenericDrive, TheTimingOfSweepsWithoutPointTimesIsStatedWithItsSources) {
  const auto drive = open();
  EXPECT_EQ(drive->info().sweep, SweepTiming{.period = drive->info().sweep.period});
  EXPECT_THAT(
      drive->info().notes,
      ElementsAre(AllOf(HasSubstr(kNoTimes), HasSubstr("takes 0.1 s (step of the stamps)"),
                        HasSubstr("clockwise (default)"), HasSubstr("180 degrees (default)"),
                        HasSubstr("stamp at 0.5 of the sweep (default)"))));
  // Thinned to 5 Hz: the step of the stamps is not that of the sweep, which only a key can say.
  std::string thinned = "index,time_ns\n";
  for (int i = 0; i < kFrames; ++i) thinned += fmt::format("{},{}\n", i, kStart + 2 * i * kStep);
  write_text(scan_stamps_, thinned);
  EXPECT_THAT(open()->info().notes,
              testing::Contains(HasSubstr("takes 0.2 s (step of the stamps)")));
  write_text(toml_, test::read_text(toml_) +
                        "[lidar]\nsweep_period_s = 0.1\nrotation = \"counterclockwise\"\n"
                        "sweep_start_deg = 90\nstamp_phase = 1\n");
  const auto stated = open();
  EXPECT_EQ(stated->info().sweep,
            (SweepTiming{0.1, SweepDirection::kCounterclockwise, std::numbers::pi / 2, 1}));
  EXPECT_THAT(
      stated->info().notes,
      testing::Contains(AllOf(
          HasSubstr("takes 0.1 s (drive.toml)"), HasSubstr("counterclockwise (drive.toml)"),
          HasSubstr("at 90 degrees (drive.toml)"), HasSubstr("at 1 of the sweep (drive.toml)"))));
  test::edit(toml_, "[lidar]\n", "[lidar]\ncompensated = true\n");
  EXPECT_THAT(open()->info().notes, testing::Not(testing::Contains(HasSubstr(kNoTimes))));
}

TEST_F(GenericDrive, ImagesBelongToTheMiddleOfSweepsThatAreStampedAtTheirEnd) {
  write_text(folder_ / "images/left/stamps.csv", stamps(kFrames, -50'000'000));
  write_text(toml_, test::read_text(toml_) + "[lidar]\nstamp_phase = 1\n");
  const auto drive = open();
  EXPECT_THAT(notes_of(*drive), IsEmpty());
  EXPECT_NEAR(drive->info().calibration.cameras[0].image_delay, -0.05, 1e-9);
}

TEST_F(GenericDrive, TheScaleOfIntensitiesIsThatOfTheFirstScans) {
  const auto intensity = [&] { return std::get<Frame>(open()->load(0)).scan.intensity[0]; };
  EXPECT_EQ(intensity(), 0.5f);
  for (int i = 0; i < kFrames; ++i) {
    test::fs::remove(scan(i));
    write_scan(scan(i), {{1, 2, 3, 51}, {4, 5, 6, 0}});
  }
  EXPECT_FLOAT_EQ(intensity(), 0.2f);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("assumed: 255 stands for a reflectance of 1")));
  test::fs::remove(scan(3));
  write_scan(scan(3), {{1, 2, 3, 30'000}, {4, 5, 6, 0}});
  EXPECT_FLOAT_EQ(intensity(), 51.0f / 65535);
  write_text(toml_, test::read_text(toml_) + "[lidar]\nintensity_max = 102\n");
  EXPECT_FLOAT_EQ(intensity(), 0.5f);
  EXPECT_THAT(notes(), IsEmpty());
}

TEST_F(GenericDrive, UnitsAreThoseOfTheFirstScansForAll) {
  const auto write_millimeters = [&](int i, float factor) {
    test::fs::remove(scan(i));
    write_scan(scan(i), {{5000, 2000, 300, 0.5f}, {factor * 4000, 0, 0, 1}});
  };
  for (int i = 0; i < kFrames; ++i) write_millimeters(i, 1);
  EXPECT_THAT(notes(), ElementsAre(AllOf(HasSubstr("coordinates are in mm"),
                                         HasSubstr("[lidar] length_unit in drive.toml"))));
  write_millimeters(5, 1e-3f);  // alone, it might be of another unit
  const Frame frame = std::get<Frame>(open()->load(5));
  EXPECT_LT((frame.scan.position[0] - Eigen::Vector3f(5, 2, 0.3f)).norm(), 1e-5f);
  EXPECT_LT((frame.scan.position[1] - Eigen::Vector3f(0.004f, 0, 0)).norm(), 1e-6f);
  write_text(toml_, test::read_text(toml_) + "[lidar]\nlength_unit = \"m\"\n");
  EXPECT_THAT(error<ConfigError>(),
              AllOf(HasSubstr("drive.toml: lidar.length_unit"), HasSubstr("\"mm\"")));
}

TEST_F(GenericDrive, ImagesMayHaveStampsOfAnotherUnit) {
  std::string text = "index,time_ns\n";
  for (int i = 0; i < kFrames; ++i) text += fmt::format("{},{}\n", i, (kStart + i * kStep) / 1000);
  write_text(folder_ / "images/left/stamps.csv", text);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("left/stamps.csv are in us")));
  EXPECT_TRUE(std::holds_alternative<Frame>(open()->load(4)));
}

TEST_F(GenericDrive, AllTablesMayBeInMicroseconds) {
  std::string scans = "index,time_ns\n", poses = "time_ns,x,y,z,qx,qy,qz,qw\n";
  for (int i = 0; i < kFrames; ++i) {
    scans += fmt::format("{},{}\n", i, (kStart + i * kStep) / 1000);
    poses += fmt::format("{},{},200,30,0,0,0,1\n", (kStart + i * kStep) / 1000, 100 + i);
  }
  write_text(scan_stamps_, scans);
  write_text(folder_ / "poses.csv", poses);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("lidar/stamps.csv are in us"),
                                   HasSubstr("poses.csv are in us")));
  const auto drive = open();
  EXPECT_EQ(drive->stamp(2), kStart + 2 * kStep);
  EXPECT_NEAR(drive->info().navigation->at(kStart + 3 * kStep)->translation().x(), 3, 1e-9);
}

TEST_F(GenericDrive, WithoutStampsScansCountAsTenHertz) {
  test::fs::remove(scan_stamps_);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("is missing: scans are counted as 10 Hz"),
                                   HasSubstr("reach 0 of 6 scans")));
  EXPECT_EQ(open()->stamp(3), 3 * kStep);
}

TEST_F(GenericDrive, ScansWithoutAStampAreSkipped) {
  test::edit(scan_stamps_, "\n3,", "\nx,");
  EXPECT_THAT(notes(), ElementsAre(AllOf(HasSubstr("1 lines of"), HasSubstr("the first: 5"))));
  expect_skipped(3, SkipReason::kMissingStamp, "no time stamp of scan 3");
  EXPECT_TRUE(std::holds_alternative<Frame>(open()->load(4)));
}

TEST_F(GenericDrive, StampsOutOfOrderAndMadNumbersCostTheirScansOnly) {
  write_text(scan_stamps_, stamps(2) + fmt::format("2,{}\n", kStart - kStep) + "1e30,5\n-1,5\n" +
                               fmt::format("1,7\n3,{0}\n999999,{0}\n", kStart + 3 * kStep));
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("3 lines of"), HasSubstr("out of order")));
  expect_skipped(2, SkipReason::kMissingStamp, "the time stamp of scan 2 is out of order");
  EXPECT_EQ(open()->stamp(1), kStart + kStep);
  EXPECT_EQ(open()->stamp(3), kStart + 3 * kStep);
}

TEST_F(GenericDrive, ImagesWithStampsBelongToTheScanNearestInTime) {
  // The camera began two images earlier, and is 4 ms late.
  write_text(folder_ / "images/left/stamps.csv", stamps(kFrames, -2 * kStep + 4'000'000));
  for (int i = 0; i < kFrames; ++i) write_png(image("left", i), pattern(24, 10, i == 3 ? 1 : 3));
  const auto drive = open();
  EXPECT_NEAR(drive->info().calibration.cameras[0].image_delay, 0.004, 1e-9);
  EXPECT_THAT(notes_of(*drive),
              ElementsAre(HasSubstr("camera 1 (left) has no image within 0.06 s of 2 of 6 scans")));
  EXPECT_EQ(std::get<Frame>(drive->load(1)).images[0].channels, 1);  // image 3
  EXPECT_EQ(std::get<SkippedFrame>(drive->load(4)).reason, SkipReason::kMissingImage);
}

TEST_F(GenericDrive, TablesOfImagesMayStateExposures) {
  std::string text = "index,time_ns,exposure_s,gain_db\n";
  for (int i = 0; i < kFrames; ++i) {
    const std::string exposure = i == 2 ? "" : fmt::format("{}", 0.001 * (1 << i));
    text += fmt::format("{},{},{},{}\n", i, kStart + i * kStep, exposure, 6.0206 * i);
  }
  write_text(folder_ / "images/left/stamps.csv", text);
  const auto drive = open();
  const DriveInfo& info = drive->info();
  EXPECT_NEAR(*info.image_exposure(1, 0), std::log2(0.001), 1e-9);
  EXPECT_NEAR(*info.image_exposure(1, 3), std::log2(0.001) + 6, 1e-9);
  EXPECT_FALSE(info.image_exposure(1, 2));
  EXPECT_FALSE(info.image_exposure(4, 0));
  EXPECT_THAT(info.warnings, testing::Contains(HasSubstr("1 lines of")));
}

TEST_F(GenericDrive, ImagesAndScansOfDifferentClocksAreAnError) {
  const auto file = folder_ / "images/left/stamps.csv";
  // Seconds since the camera began, an hour of summer time, GPS time.
  for (const TimeNs shift : {-kStart + kStep, 3600 * kNsPerSecond, 18 * kNsPerSecond}) {
    write_text(file, stamps(kFrames, shift));
    EXPECT_THAT(
        error<InputError>(),
        AllOf(HasSubstr("no image of camera left belongs to a scan: they have different clocks"),
              HasSubstr("scans from 1700000000.000 to 1700000000.500 s"),
              HasSubstr("images/left/stamps.csv"), HasSubstr("give stamps of one clock")))
        << shift;
  }
  options_.cameras = {4};
  EXPECT_NO_THROW(open());
}

TEST_F(GenericDrive, ImagesBetweenScansBeyondTheToleranceAreAnError) {
  test::edit(toml_, "[body]\n", "[images]\ntolerance = 0.01\n[body]\n");
  write_text(folder_ / "images/left/stamps.csv", stamps(kFrames, kStep / 2));
  EXPECT_THAT(error<InputError>(), AllOf(HasSubstr("none lies within 0.01 s of one"),
                                         testing::Not(HasSubstr("different clocks"))));
  write_text(folder_ / "images/left/stamps.csv", "index,time_ns\n");
  EXPECT_THAT(error<InputError>(), HasSubstr("no image has a stamp"));
}

TEST_F(GenericDrive, ImagesBelongToTheSweepThatTheyLieIn) {
  // Scans that are stamped at their beginning; images half-way through.
  for (int i = 0; i < kFrames; ++i) {
    test::fs::remove(scan(i));
    write_text(folder_ / fmt::format("lidar/{}.pcd", i),
               "FIELDS x y z t\nSIZE 4 4 4 4\nTYPE F F F U\nWIDTH 2\nHEIGHT 1\nDATA ascii\n"
               "1 2 3 0\n4 5 6 99000000\n");
  }
  write_text(folder_ / "images/left/stamps.csv", stamps(kFrames, 50'000'000));
  const auto drive = open();
  EXPECT_THAT(notes_of(*drive), IsEmpty());
  EXPECT_NEAR(drive->info().calibration.cameras[0].image_delay, 0.05, 1e-9);
}

TEST_F(GenericDrive, EachImageHasItsOwnDelay) {
  std::string text = "index,time_ns\n";
  for (int i = 0; i < kFrames; ++i) {
    text += fmt::format("{},{}\n", i, kStart + i * kStep + i * 2'000'000);
  }
  write_text(folder_ / "images/left/stamps.csv", text);
  test::edit(toml_, "[camera.left]\n", "[camera.left]\ndelay = 0.001\n");
  const auto drive = open();
  EXPECT_THAT(
      notes_of(*drive),
      ElementsAre(HasSubstr("takes images 0.0 to 10.0 ms after the scans; each is projected at")));
  const DriveInfo& info = drive->info();
  EXPECT_TRUE(info.image_stamps_are_capture_times);
  EXPECT_TRUE(info.has_image_delays());
  EXPECT_NEAR(info.calibration.cameras[0].image_delay, 0.007, 1e-9);  // the median and the key
  for (int i = 0; i < kFrames; ++i) {
    EXPECT_NEAR(info.camera_at(0, i).image_delay, 0.001 + i * 0.002, 1e-9) << i;
  }
  // A stated delay takes the place of the median; each image keeps its own.
  test::edit(toml_, "delay = 0.001\n", "delay = 0.001\nstamp_delay = 0.005\n");
  const auto stated = open();
  EXPECT_NEAR(stated->info().calibration.cameras[0].image_delay, 0.006, 1e-9);
  EXPECT_NEAR(stated->info().camera_at(0, 3).image_delay, 0.007, 1e-9);
}

TEST_F(GenericDrive, DistortedImagesComeOutAsAPinholeCameras) {
  test::edit(toml_, "[camera.left]\n",
             "[camera.left]\ndistortion_model = \"plumb_bob\"\nD = [-0.2, 0, 0, 0, 0]\n");
  const auto drive = open();
  const Camera& camera = drive->info().calibration.cameras[0];
  EXPECT_GE(camera.width, 24);
  const Frame frame = std::get<Frame>(drive->load(0));
  EXPECT_EQ(frame.images[0].width, camera.width);
  EXPECT_EQ(frame.images[0].height, camera.height);
  write_png(image("left", 0), pattern(camera.width, camera.height + 1, 3));
  expect_skipped(0, SkipReason::kDamagedImage, "its camera 24 x 10");
  test::edit(toml_, "D = [-0.2, 0, 0, 0, 0]", "D = [-90, 0, 80, 50, 0]");
  EXPECT_THAT(error<ConfigError>(), HasSubstr("the distortion has no inverse"));
}

TEST_F(GenericDrive, TimesOfPointsAreKeptUnlessTheSweepIsCompensated) {
  test::fs::remove(scan(1));
  write_text(folder_ / "lidar/1.pcd",
             "FIELDS x y z t\nSIZE 4 4 4 4\nTYPE F F F U\nWIDTH 1\nHEIGHT 1\nDATA ascii\n"
             "1 2 3 50000000\n");
  EXPECT_THAT(std::get<Frame>(open()->load(1)).scan.time, ElementsAre(0.05f));
  EXPECT_THAT(std::get<Frame>(open()->load(2)).scan.time, IsEmpty());
  write_text(toml_, test::read_text(toml_) + "[lidar]\ncompensated = true\n");
  EXPECT_TRUE(open()->info().sweep_compensated);
  EXPECT_THAT(std::get<Frame>(open()->load(1)).scan.time, IsEmpty());
}

TEST_F(GenericDrive, WhatCannotBeReadIsSkippedOrAnError) {
  write_text(scan(1), "");
  expect_skipped(1, SkipReason::kDamagedScan, "000001.bin");
  write_text(image("left", 2), "no image");
  expect_skipped(2, SkipReason::kDamagedImage, "2.png");
  test::fs::remove(scan(3));
  expect_skipped(3, SkipReason::kMissingScan, "no scan 3");
  write_scan(folder_ / "lidar/1000000.bin", {{1, 2, 3, 4}});
  EXPECT_THAT(error<InputError>(), HasSubstr("over 999999"));
  test::fs::remove_all(folder_ / "lidar");
  EXPECT_THAT(error<InputError>(), HasSubstr("the drive has no scan"));
  write_text(toml_, "version = 3");
  EXPECT_THAT(error<ConfigError>(), HasSubstr("drive.toml"));
}

TEST_F(GenericDrive, ImagesThatAreAllOfAnotherSizeThanTheCalibrationAreAnError) {
  test::edit(
      toml_, "[camera.left]\nindex = 1\nwidth = 24\nheight = 10\nK = [20, 0, 12, 0, 20,",
      "[camera.left]\nindex = 1\nwidth = 8192\nheight = 8192\ndistortion_model = \"plumb_bob\"\n"
      "D = [0.1, 0, 0, 0, 0]\nK = [4000, 0, 12, 0, 4000,");
  EXPECT_LT(rise_of_peak_memory([&] {
              EXPECT_THAT(error<ConfigError>(),
                          HasSubstr("camera left have 24 x 10 pixels, not 8192 x 8192"));
            }),
            kMemoryOfASmallFile);
  for (int i = 0; i < kFrames; ++i) write_text(image("left", i), "no image");
  EXPECT_THAT(error<ConfigError>(), HasSubstr("camera left cannot be read"));
}

class GenericNavigation : public GenericDrive {
 protected:
  GenericNavigation() { test::fs::remove(folder_ / "poses.csv"); }

  /// A way from the origin at 49 degrees north that heads 30 degrees north of east, 1.2 m a step.
  static GeodeticPoint place(int i) {
    const LocalTangentPlane local({49, 8.4, 100});
    const double way = 1.2 * i;
    return local.to_geodetic({way * std::cos(30 * kDegree), way * std::sin(30 * kDegree), 0});
  }
  static std::string gnss(const std::string& further = "",
                          const std::function<std::string(int)>& cells = {}) {
    std::string text = "time_ns,latitude,longitude,altitude" + further + "\n";
    for (int i = 0; i < kFrames; ++i) {
      const GeodeticPoint p = place(i);
      text += fmt::format("{},{},{},{}{}\n", kStart + i * kStep, p.latitude, p.longitude,
                          p.altitude, cells ? cells(i) : "");
    }
    return text;
  }
  /// Heading of the LiDAR at a frame.
  static double heading(const FrameSource& drive, int i) {
    const RigidMotion T = *drive.info().navigation->at(*drive.stamp(i));
    return std::atan2(T.linear()(1, 0), T.linear()(0, 0)) / kDegree;
  }
};

TEST_F(GenericNavigation, WithoutAnyThereIsANote) {
  EXPECT_FALSE(open()->info().navigation);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("neither poses.csv nor gnss.csv")));
}

TEST_F(GenericNavigation, PositionsWithoutAttitudeHeadAlongTheirWay) {
  write_text(folder_ / "gnss.csv", gnss());
  const auto drive = open();
  EXPECT_THAT(notes_of(*drive), ElementsAre(HasSubstr("headings are those of the way")));
  ASSERT_TRUE(drive->info().navigation);
  for (int i = 0; i < kFrames; ++i) EXPECT_NEAR(heading(*drive, i), 30, 1e-3);
  EXPECT_NEAR(drive->info().origin->latitude, 49, 1e-9);
  EXPECT_NEAR(drive->info().origin->altitude, 102, 1e-6);  // the LiDAR sits 2 m above the body
  EXPECT_THAT(drive->info().navigation_accuracy, testing::Each(0.0));
}

TEST_F(GenericNavigation, AttitudesAreAnglesOrQuaternions) {
  write_text(folder_ / "gnss.csv", gnss(",roll,pitch,yaw,accuracy", [](int i) {
               return fmt::format(",0,0,{},{}", 50 * kDegree, i == 2 ? "inf" : "0.25");
             }));
  const auto angles = open();
  EXPECT_THAT(notes_of(*angles), IsEmpty());
  EXPECT_NEAR(heading(*angles, 3), 50, 1e-3);
  EXPECT_EQ(angles->info().navigation_accuracy[1], 0.25);
  EXPECT_TRUE(std::isinf(angles->info().navigation_accuracy[2]));
  write_text(folder_ / "gnss.csv", gnss(",qx,qy,qz,qw", [](int) {
               return fmt::format(",0,0,{},{}", std::sin(35 * kDegree), std::cos(35 * kDegree));
             }));
  EXPECT_NEAR(heading(*open(), 3), 70, 1e-3);
}

TEST_F(GenericNavigation, OrientationsOfAnImuServePositionsThatHaveNone) {
  write_text(folder_ / "gnss.csv", gnss());
  // From 10 to 20 degrees, at other times than the positions; the IMU looks to the left.
  std::string imu = "time_ns,qx,qy,qz,qw,wx\n";
  for (const auto& [ms, degrees] :
       {std::pair(-10, 10.0), std::pair(90, 12.0), std::pair(190, 14.0), std::pair(290, 16.0),
        std::pair(390, 18.0), std::pair(490, 20.0)}) {
    const double half = (degrees + 90) * kDegree / 2;
    imu += fmt::format("{},0,0,{},{},0\n", kStart + ms * 1'000'000, std::sin(half), std::cos(half));
  }
  write_text(folder_ / "imu.csv", imu);
  test::edit(toml_, "[body]\n",
             fmt::format("[body]\nT_body_imu = {{rotation = [0, 0, {0}, {0}]}}\n", std::sqrt(0.5)));
  const auto drive = open();
  EXPECT_THAT(notes_of(*drive), IsEmpty());
  EXPECT_NEAR(heading(*drive, 0), 10.2, 2e-3);
  EXPECT_NEAR(heading(*drive, 3), 16.2, 2e-3);
}

TEST_F(GenericNavigation, TheAntennasPlaceIsTakenIntoAccount) {
  write_text(folder_ / "gnss.csv",
             gnss(",roll,pitch,yaw", [](int) { return fmt::format(",0,0,{}", 90 * kDegree); }));
  const GeodeticPoint without = *open()->info().origin;
  test::edit(toml_, "[body]\n", "[body]\nantenna = [1, 0, 0.5]\n");
  const GeodeticPoint with = *open()->info().origin;
  // The body looks north: its origin lies a metre south of the antenna.
  EXPECT_NEAR((with.latitude - without.latitude) * 111'205, -1, 2e-3);
  EXPECT_NEAR(with.altitude - without.altitude, -0.5, 1e-6);
  EXPECT_NEAR(with.longitude, without.longitude, 1e-9);
}

TEST_F(GenericNavigation, VelocitiesAreTheBodysAndBecomeTheLidars) {
  const auto expect_velocity = [&](const Eigen::Vector3d& expected) {
    const auto drive = open();
    const TimeNs stamp = *drive->stamp(1);
    const Twist velocity =
        drive->info().navigation->motion(stamp, stamp + kNsPerSecond / 20).value().velocity;
    EXPECT_LT((velocity.head<3>() - Eigen::Vector3d(0, 0, 0.5)).norm(), 1e-12);
    EXPECT_LT((velocity.tail<3>() - expected).norm(), 1e-12) << velocity.transpose();
  };
  const auto cells = [](int) { return ",0,0,0,10,0,0,0,0,0.5"; };
  write_text(folder_ / "gnss.csv", gnss(",roll,pitch,yaw,vx,vy,vz,wx,wy,wz", cells));
  // The body turns left: what lies ahead of its origin swings to the left, wherever the antenna is.
  test::edit(toml_, "[body]\n", "[body]\nantenna = [-1, 0.5, 0.5]\n");
  test::edit(toml_, "{translation = [0, 0, 2]}", "{translation = [3, 0, 2]}");
  expect_velocity({10, 1.5, 0});
  std::string text = "time_ns,x,y,z,qx,qy,qz,qw,vx,vy,vz,wx,wy,wz\n";
  for (int i = 0; i < kFrames; ++i) {
    text += fmt::format("{},{},0,0,0,0,0,1,10,0,0,0,0,0.5\n", kStart + i * kStep, 1.2 * i);
  }
  write_text(folder_ / "poses.csv", text);
  expect_velocity({10, 1.5, 0});
}

TEST_F(GenericNavigation, AnAccuracyThatIsNotPositiveIsNotStated) {
  const std::array<const char*, kFrames> cells = {"0", "-1", "nan", "", "-inf", "0.3"};
  write_text(folder_ / "gnss.csv",
             gnss(",accuracy", [&](int i) { return "," + std::string(cells.at(std::size_t(i))); }));
  const auto drive = open();
  EXPECT_THAT(drive->info().navigation_accuracy, ElementsAre(0, 0, 0, 0, 0, 0.3));
  EXPECT_TRUE(drive->info().origin);
}

TEST_F(GenericNavigation, PositionsWithoutAFixGeoreferenceNothing) {
  for (const auto& [column, cell] : {std::pair(",accuracy", ",inf"), std::pair(",satellites", ",0"),
                                     std::pair(",status", ",-1")}) {
    write_text(folder_ / "gnss.csv", gnss(column, [&](int) { return cell; }));
    const auto drive = open();
    EXPECT_FALSE(drive->info().origin) << column;
    EXPECT_TRUE(drive->info().navigation) << column;
    EXPECT_THAT(drive->info().navigation_accuracy,
                testing::Each(std::numeric_limits<double>::infinity()));
    EXPECT_THAT(notes_of(*drive), testing::Contains(HasSubstr("no position with a fix"))) << column;
    // One fix is enough.
    write_text(folder_ / "gnss.csv", gnss(column, [&](int i) { return i == 4 ? ",7" : cell; }));
    EXPECT_TRUE(open()->info().origin) << column;
  }
}

TEST_F(GenericNavigation, PositionsThatAReceiverStatesWithoutAFixAreLeftOut) {
  const std::string right = gnss();
  write_text(folder_ / "gnss.csv", right);
  const GeodeticPoint origin = *open()->info().origin;
  // The first two positions: null, null with noise, a factory's position, the wrong hemisphere.
  for (const char* position : {"0,0,0", "0.0002,-0.0003,17", "37.39,-122.03,30", "-49,-8.4,100"}) {
    std::string text = "time_ns,latitude,longitude,altitude\n";
    for (const TimeNs time : {-kStep / 2, -kStep / 4}) {
      text += fmt::format("{},{}\n", kStart + time, position);
    }
    text += right.substr(right.find('\n') + 1);
    write_text(folder_ / "gnss.csv", text);
    const auto drive = open();
    EXPECT_NEAR(drive->info().origin->latitude, origin.latitude, 1e-9) << position;
    EXPECT_NEAR(drive->info().origin->longitude, origin.longitude, 1e-9) << position;
    EXPECT_EQ(drive->info().navigation->poses().size(), std::size_t(kFrames)) << position;
    const bool null = position[0] == '0';
    EXPECT_THAT(
        notes_of(*drive),
        testing::Contains(AllOf(HasSubstr("2 lines of"), HasSubstr("(the first: 2)"),
                                HasSubstr(null ? "without a fix" : "too far from the others"))));
  }
}

TEST_F(GenericNavigation, NothingButNullPositionsIsNoNavigation) {
  std::string text = "time_ns,latitude,longitude,altitude\n";
  for (int i = 0; i < kFrames; ++i) text += fmt::format("{},0,0,0\n", kStart + i * kStep);
  write_text(folder_ / "gnss.csv", text);
  EXPECT_FALSE(open()->info().navigation);
  EXPECT_THAT(notes(),
              ElementsAre(HasSubstr("6 without a fix"), HasSubstr("no position that can be")));
}

TEST_F(GenericNavigation, LatitudesOverNinetyDegreesAreLikelySwapped) {
  std::string text = "time_ns,longitude,latitude,altitude\n";  // Tokyo
  for (int i = 0; i < kFrames; ++i) {
    text += fmt::format("{},35.68,{},40\n", kStart + i * kStep, 139.69 + 1e-5 * i);
  }
  write_text(folder_ / "gnss.csv", text);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("6 with a latitude over 90 degrees, likely swapped"),
                                   HasSubstr("no navigation")));
}

TEST_F(GenericNavigation, AnglesOfOverATurnAreLikelyDegrees) {
  const auto write = [&](const std::function<std::string(int)>& angles) {
    write_text(folder_ / "gnss.csv", gnss(",roll,pitch,yaw", angles));
  };
  write([](int) { return ",0.2,-0.1,30"; });
  EXPECT_THAT(error<InputError>(), AllOf(HasSubstr("6 lines"), HasSubstr("likely degrees"),
                                         HasSubstr("gnss.csv"), HasSubstr("give radians")));
  write([](int i) { return fmt::format(",12.5,0,{}", 0.1 * i); });
  EXPECT_THAT(error<InputError>(), HasSubstr("up to 12.5"));
  write([](int i) { return fmt::format(",0,0,{}", 6.1 + 0.1 * i); });
  EXPECT_NO_THROW(open());
}

TEST_F(GenericNavigation, PositionsThatHardlyMoveMayBeInRadians) {
  std::string text = "time_ns,latitude,longitude,altitude\n";
  for (int i = 0; i < kFrames; ++i) {
    const GeodeticPoint p = place(i);
    text += fmt::format("{},{},{},100\n", kStart + i * kStep, p.latitude * kDegree,
                        p.longitude * kDegree);
  }
  write_text(folder_ / "gnss.csv", text);
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("latitude and longitude in radians?")));
}

TEST_F(GenericNavigation, BadLinesAreNotedAndNotUsed) {
  std::string text = gnss();
  text += fmt::format("{},91,8.4,100\n{},nan,8.4,100\n{},49,8.4,1e300\nnonsense\n5,49,8.4,100\n",
                      kStart + 6 * kStep, kStart + 7 * kStep, kStart + 8 * kStep);
  write_text(folder_ / "gnss.csv", text);
  EXPECT_THAT(notes(),
              testing::UnorderedElementsAre(HasSubstr("headings are those"),
                                            HasSubstr("4 lines of"), HasSubstr("1 lines of")));
}

TEST_F(GenericNavigation, APoseFarFromAllOthersIsNotUsed) {
  std::string text = "time_ns,x,y,z,qx,qy,qz,qw\n";
  for (int i = 0; i < kFrames; ++i) {
    const double x = i == 0 ? -9e7 : 5.6e6 + 1.2 * i;  // the first one would be the origin
    text += fmt::format("{},{},4e5,0,0,0,0,1\n", kStart + i * kStep, x);
  }
  write_text(folder_ / "poses.csv", text);
  const auto drive = open();
  ASSERT_TRUE(drive->info().navigation);
  for (const StampedPose& pose : drive->info().navigation->poses()) {
    EXPECT_LT(pose.T_local_body.translation().norm(), 10);
  }
  EXPECT_THAT(notes(), testing::Contains(HasSubstr("1 lines of")));
}

TEST_F(GenericNavigation, TablesThatAreNoneAreErrors) {
  write_text(folder_ / "gnss.csv", "time_ns,lat\n");
  EXPECT_THAT(error<InputError>(), AllOf(HasSubstr("no column latitude"), HasSubstr("gnss.csv:1")));
  write_text(folder_ / "gnss.csv", "time_ns,latitude,longitude,altitude\n");
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("no position that can be used")));
  write_text(
      folder_ / "poses.csv",
      "time_ns,x,y,z,qx,qy,qz,qw\n5,0,0,0,0,0,0,0\n6,1e300,0,0,0,0,0,1\n7,1,nan,0,0,0,0,1\n");
  EXPECT_THAT(notes(), ElementsAre(HasSubstr("3 lines of"), HasSubstr("no pose that can be used")));
}

TEST_F(GenericDrive, CamerasMayHaveMasks) {
  Image picture(24, 10, 1);
  std::fill(picture.data.begin(), picture.data.end(), std::uint8_t{255});
  *picture.pixel(3, 8) = 0;
  write_png(folder_ / "masks/left.png", picture);
  std::string toml = test::read_text(toml_);
  toml.insert(toml.find("index = 1"), "mask = 'masks/left.png'\n");
  write_text(toml_, toml);
  options_.cameras = {1, 4};
  const auto drive = open();
  ASSERT_NE(drive->info().mask(1), nullptr);
  EXPECT_TRUE(drive->info().mask(1)->covers(3, 8, 0));
  EXPECT_FALSE(drive->info().mask(1)->covers(4, 8, 0));
  EXPECT_EQ(drive->info().mask(4), nullptr);

  // A mask of the command line replaces it.
  *picture.pixel(3, 8) = 255;
  *picture.pixel(20, 1) = 0;
  write_png(folder_ / "other.png", picture);
  options_.masks[1] = folder_ / "other.png";
  EXPECT_FALSE(open()->info().mask(1)->covers(3, 8, 0));
  EXPECT_TRUE(open()->info().mask(1)->covers(20, 1, 0));

  options_.masks = {{4, folder_ / "small.png"}};
  write_png(folder_ / "small.png", Image(23, 10, 1));
  EXPECT_THAT(error_of<ConfigError>([&] { open(); }),
              AllOf(HasSubstr("23 x 10"), HasSubstr("24 x 10"), HasSubstr("small.png")));
  options_.masks = {{7, folder_ / "other.png"}};  // not ignored without a word
  EXPECT_THAT(error_of<ConfigError>([&] { open(); }), HasSubstr("camera 7, which is not used"));
  options_.masks = {{4, folder_ / "missing.png"}};
  EXPECT_THAT(error_of<InputError>([&] { open(); }), HasSubstr("missing.png"));
}

}  // namespace fovea::generic_drive_test
