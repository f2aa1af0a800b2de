// Drives that are another drive with a corrected calibration.
#include "fovea/drive/calibrated_drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../tests/kitti_test_drive.h"
#include "../../../tests/truth_writer.h"
#include "fovea/drive/command_files.h"
#include "fovea/drive/drive_truth.h"
#include "fovea/drive/kitti/tracklets.h"
#include "fovea/errors.h"

namespace fovea::calibrated_drive_test {

using test::edit;
using test::error_of;
using test::write_text;
using test::fs::path;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr TimeNs kStart = 1'700'000'000'000'000'000, kStep = kNsPerSecond / 10;
constexpr const char* kMotion = "[[0, -1, 0, 0.25], [0, 0, -1, 0.5], [1, 0, 0, -0.75]]";

/// kMotion as a motion.
RigidMotion some_motion() {
  RigidMotion T = RigidMotion::Identity();
  T.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  T.translation() << 0.25, 0.5, -0.75;
  return T;
}

/// Three scans, cameras 1 ("left", with a delay of 10 ms) and 4 ("right"), an IMU and wheels.
void write_generic_drive(const path& folder) {
  std::string toml = "version = 1\n[imu]\nT_lidar_imu = {translation = [0, 0, 2]}\n";
  for (const auto& [name, index] : {std::pair("left", 1), std::pair("right", 4)}) {
    toml += fmt::format(
        "[camera.{}]\nindex = {}\nwidth = 24\nheight = 10\nK = [20, 0, 12, 0, 20, 5, 0, 0, 1]\n"
        "T_cam_lidar = [0, -1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 0]\ndelay = {}\n",
        name, index, index == 1 ? 0.01 : 0.0);
    for (int i = 0; i < 3; ++i) {
      test::write_png(folder / fmt::format("images/{}/{}.png", name, i), test::pattern(24, 10, 3));
    }
  }
  write_text(folder / "drive.toml", toml);
  std::string stamps = "index,time_ns\n", imu = "time_ns,wx,wy,wz,ax,ay,az\n",
              wheels = "time_ns,speed\n";
  for (int i = 0; i < 3; ++i) {
    test::write_scan(folder / fmt::format("lidar/{}.bin", i), {{float(i) + 1, 2, 3, 0.5f}});
    stamps += fmt::format("{},{}\n", i, kStart + i * kStep);
    imu += fmt::format("{},0,0,0.1,0,0,9.8\n", kStart + i * kStep);
    wheels += fmt::format("{},5\n", kStart + i * kStep);
  }
  write_text(folder / "lidar/stamps.csv", stamps);
  write_text(folder / "imu.csv", imu);
  write_text(folder / "wheels.csv", wheels);
}

class CalibratedDriveTest : public testing::Test {
 protected:
  CalibratedDriveTest() { write_generic_drive(street_); }

  /// A calibrated drive of the street.
  void write_toml(const std::string& tables) const {
    write_text(toml_, "version = 1\n[calibrated]\ndrive = \"../street\"\n" + tables);
  }
  std::unique_ptr<FrameSource> open(const path& drive) const { return open_drive(drive, options_); }
  std::unique_ptr<FrameSource> open() const { return open(drive_); }
  template <class E>
  std::string error() const {
    return error_of<E>([&] { open(); });
  }
  template <class E>
  std::string error_of_writing(const path& folder, const path& drive, bool force = false) const {
    return error_of<E>([&] { write_calibrated_drive(folder, drive, correction_, force); });
  }

  TemporaryFolder folder_;
  path street_ = folder_ / "street", drive_ = folder_ / "corrected", toml_ = drive_ / "drive.toml";
  DriveOptions options_;
  DriveCorrection correction_;
};

TEST_F(CalibratedDriveTest, HasTheFramesOfTheOtherDriveWithItsOwnCalibration) {
  options_.cameras = {1, 4};
  write_toml(fmt::format(
      "[calibrated.camera.1]\nT_cam_lidar = {}\nadded_delay = 0.02\n[calibrated.camera.4]\n"
      "T_cam_lidar = {{translation = [1, 2, 3]}}\n[calibrated.imu]\nT_imu_lidar = "
      "{{translation = [-1, -2, -3]}}\nadded_delay = -0.004\n",
      kMotion));
  const auto base = open(street_), drive = open();
  const DriveInfo& info = drive->info();
  EXPECT_EQ(info.path, drive_);
  EXPECT_EQ(info.kind, "generic");
  const std::vector<Camera>& cameras = info.calibration.cameras;
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_TRUE(cameras[0].T_cam_lidar.isApprox(some_motion(), 1e-15));
  EXPECT_NEAR(cameras[0].image_delay, 0.03, 1e-15);
  EXPECT_EQ(cameras[1].T_cam_lidar.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(cameras[1].image_delay, 0);
  EXPECT_EQ(info.imu->T_lidar_imu.translation(), Eigen::Vector3d(1, 2, 3));
  ASSERT_EQ(info.imu->samples.size(), 3u);
  EXPECT_EQ(info.imu->samples[2].time, base->info().imu->samples[2].time - 4'000'000);
  EXPECT_EQ(info.wheels->samples[2].time, base->info().wheels->samples[2].time);
  EXPECT_EQ(drive->stamp(1), base->stamp(1));
  const Frame frame = std::get<Frame>(drive->load(1));
  EXPECT_EQ(frame.scan.position[0], Eigen::Vector3f(2, 2, 3));
  EXPECT_EQ(frame.images[0].data, test::pattern(24, 10, 3).data);
}

TEST_F(CalibratedDriveTest, LeavesWhatItDoesNotName) {
  options_.cameras = {4};
  write_toml(fmt::format("[calibrated.camera.1]\nT_cam_lidar = {}\n", kMotion));
  const DriveInfo info = open()->info(), base = open(street_)->info();
  EXPECT_THAT(info.unused_cameras, ElementsAre(1));
  EXPECT_EQ(info.calibration.cameras[0].T_cam_lidar.matrix(),
            base.calibration.cameras[0].T_cam_lidar.matrix());
  EXPECT_EQ(info.imu->T_lidar_imu.translation().z(), 2);
  EXPECT_EQ(info.imu->samples[0].time, base.imu->samples[0].time);
  write_toml("");
  EXPECT_EQ(open()->info().end, 3);
}

TEST_F(CalibratedDriveTest, OptionsAreThoseOfTheOtherDrive) {
  write_toml(
      fmt::format("[calibrated.camera.1]\nT_cam_lidar = {0}\n[calibrated.imu]\n"
                  "T_lidar_imu = {0}\n",
                  kMotion));
  options_.use_imu = false;
  options_.use_images = false;
  options_.begin = 1;
  const DriveInfo info = open()->info();
  EXPECT_EQ(info.begin, 1);
  EXPECT_FALSE(info.imu);
  EXPECT_TRUE(info.calibration.cameras.empty());
}

TEST_F(CalibratedDriveTest, CorrectsKittiDrives) {
  const path raw = test::write_raw_drive(folder_ / "2026_01_01", 2);
  correction_.cameras = {{3, some_motion(), 0.05}};
  correction_.imu = {some_motion(), 0.25};
  write_calibrated_drive(drive_, raw, correction_);
  options_.cameras = {3};
  options_.use_navigation = false;
  const DriveInfo info = open()->info();
  EXPECT_EQ(info.kind, "kitti-raw");
  EXPECT_EQ(info.calibration.cameras[0].image_delay, 0.05);
  EXPECT_EQ(info.imu->samples[0].time, open(raw)->info().imu->samples[0].time + kNsPerSecond / 4);
  // With its navigation, the rates of KITTI's unit are not read.
  options_.use_navigation = true;
  EXPECT_FALSE(open()->info().imu);

  const path sequence = test::write_odometry_sequence(folder_.path(), 2);
  correction_.cameras = {{0, some_motion(), 0}};
  write_calibrated_drive(folder_ / "sequence", sequence, correction_);
  options_.cameras = {0};
  EXPECT_THAT(error_of<ConfigError>([&] { open(folder_ / "sequence"); }),
              HasSubstr("key 'calibrated.imu'"));
  options_.use_imu = false;
  EXPECT_TRUE(open(folder_ / "sequence")
                  ->info()
                  .calibration.cameras[0]
                  .T_cam_lidar.isApprox(some_motion(), 1e-15));
}

TEST_F(CalibratedDriveTest, MayCorrectACorrectedDrive) {
  options_.cameras = {1, 4};
  write_toml(
      fmt::format("[calibrated.camera.1]\nT_cam_lidar = {0}\nadded_delay = 0.02\n"
                  "[calibrated.camera.4]\nT_cam_lidar = {0}\n",
                  kMotion));
  correction_.cameras = {{1, RigidMotion::Identity(), 0.1}};
  write_calibrated_drive(folder_ / "again", drive_, correction_);
  const DriveInfo info = open(folder_ / "again")->info();
  EXPECT_EQ(info.path, folder_ / "again");
  EXPECT_NEAR(info.calibration.cameras[0].image_delay, 0.13, 1e-15);
  EXPECT_EQ(info.calibration.cameras[0].T_cam_lidar.translation().norm(), 0);
  EXPECT_TRUE(info.calibration.cameras[1].T_cam_lidar.isApprox(some_motion(), 1e-15));
}

TEST_F(CalibratedDriveTest, IsFoundThroughALink) {
  write_toml("");
  const path deep = folder_ / "links/of/drives";
  test::fs::create_directories(deep);
  test::fs::create_directory_symlink(drive_, deep / "link");
  EXPECT_EQ(open(deep / "link")->info().path, deep / "link");
  EXPECT_EQ(recorded_folder(deep / "link"), test::fs::canonical(street_));
}

TEST_F(CalibratedDriveTest, CirclesAndLongChainsAreErrors) {
  const auto write_link = [&](const std::string& name, const std::string& drive) {
    write_text(folder_ / (name + "/drive.toml"),
               fmt::format("version = 1\ncalibrated.drive = \"../{}\"\n", drive));
  };
  write_link("corrected", "corrected");
  EXPECT_THAT(error<InputError>(), AllOf(HasSubstr("circle"), HasSubstr(toml_.string())));
  write_link("corrected", "other");
  write_link("other", "corrected");
  EXPECT_THAT(error<InputError>(), HasSubstr((folder_ / "other/drive.toml").string()));
  write_text(toml_, "version = 1\ncalibrated.drive = \".\"\n");
  EXPECT_THAT(error<InputError>(), HasSubstr("circle"));

  write_link("1", "street");
  for (int level = 2; level <= 9; ++level) {
    write_link(std::to_string(level), std::to_string(level - 1));
  }
  EXPECT_EQ(open(folder_ / "8")->info().end, 3);
  EXPECT_THAT(error_of<InputError>([&] { open(folder_ / "9"); }), HasSubstr("over 8"));
}

TEST_F(CalibratedDriveTest, AMissingDriveIsAnErrorOfTheFileThatNamesIt) {
  write_toml("");
  test::fs::rename(street_, folder_ / "moved");
  EXPECT_THAT(error<InputError>(),
              AllOf(HasSubstr((folder_ / "corrected/../street").string()), HasSubstr("no folder"),
                    HasSubstr(toml_.string()), HasSubstr("key 'calibrated.drive'")));
  write_text(toml_,
             fmt::format("version = 1\ncalibrated.drive = \"{}\"\n", (folder_ / "moved").string()));
  EXPECT_EQ(open()->info().end, 3);
  write_text(toml_, "version = 1\ncalibrated.drive = \"" + std::string(5000, 'a') + "\"\n");
  EXPECT_THAT(error<InputError>(), HasSubstr("key 'calibrated.drive'"));
}

TEST_F(CalibratedDriveTest, FaultsNameFileLineAndKey) {
  const auto error_with = [&](const std::string& tables) {
    write_toml(tables);
    return error<ConfigError>();
  };
  const auto names = [&](int line, const std::string& key) {
    return HasSubstr(fmt::format("{}:{}, key '{}'", toml_.string(), line, key));
  };
  const std::string motion = fmt::format("T_cam_lidar = {}\n", kMotion);
  EXPECT_THAT(error_with("gain = 2\n"), AllOf(names(4, "calibrated.gain"), HasSubstr("unknown")));
  EXPECT_THAT(error_with("[lidar]\nfolder = \"a\"\n"),
              AllOf(names(5, "lidar.folder"), HasSubstr("unknown")));
  EXPECT_THAT(error_with("[calibrated.camera.1]\n" + motion + "delay = 1\n"),
              names(6, "calibrated.camera.1.delay"));
  EXPECT_THAT(error_with("[calibrated.camera.left]\n" + motion),
              AllOf(names(4, "calibrated.camera.left"), HasSubstr("0 to 9")));
  EXPECT_THAT(error_with("[calibrated.camera.10]\n" + motion), HasSubstr("0 to 9"));
  EXPECT_THAT(error_with("[calibrated.camera.1]\nadded_delay = 0.1\n"),
              AllOf(HasSubstr("missing"), HasSubstr("calibrated.camera.1.T_cam_lidar")));
  EXPECT_THAT(error_with("[calibrated.camera.1]\n" + motion + "added_delay = 1.5\n"),
              names(6, "calibrated.camera.1.added_delay"));
  EXPECT_THAT(error_with("[calibrated.camera.1]\nT_cam_lidar = {translation = [21, 0, 0]}\n"),
              AllOf(names(5, "calibrated.camera.1.T_cam_lidar"), HasSubstr("20 m")));
  EXPECT_THAT(
      error_with("[calibrated.camera.1]\nT_cam_lidar = [2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\n"),
      HasSubstr("not a rotation"));
  EXPECT_THAT(error_with("[calibrated.imu]\n"), HasSubstr("calibrated.imu.T_lidar_imu"));
  EXPECT_THAT(error_with("[calibrated.imu]\nT_lidar_imu = {rotation = [1, 1, 0, 0]}\n"),
              HasSubstr("quaternion"));
  EXPECT_THAT(error_with("[calibrated.imu]\nT_lidar_imu = {translation = [0, 0, 0]}\n"
                         "added_delay = -2\n"),
              names(6, "calibrated.imu.added_delay"));
}

TEST_F(CalibratedDriveTest, NeedsAVersionAndADrive) {
  const auto error_with = [&](const std::string& text) {
    write_text(toml_, text);
    return error<ConfigError>();
  };
  EXPECT_THAT(error_with("[calibrated]\ndrive = \"../street\"\n"), HasSubstr("key 'version'"));
  EXPECT_THAT(error_with("version = 2\n[calibrated]\ndrive = \"../street\"\n"),
              AllOf(HasSubstr("version 2"), HasSubstr("newer Fovea")));
  EXPECT_THAT(error_with("version = 1\n[calibrated]\n"), HasSubstr("key 'calibrated.drive'"));
  EXPECT_THAT(error_with("version = 1\ncalibrated = 3\n"), HasSubstr("key 'calibrated'"));
  EXPECT_THAT(error_with("version = 1\ncalibrated.drive = \"\"\n"),
              HasSubstr("key 'calibrated.drive'"));
}

TEST_F(CalibratedDriveTest, WhatTheDriveDoesNotHaveCannotBeCorrected) {
  write_toml(fmt::format("[calibrated.camera.7]\nT_cam_lidar = {}\n", kMotion));
  EXPECT_THAT(error<ConfigError>(),
              AllOf(HasSubstr("no camera 7"), HasSubstr(toml_.string()),
                    HasSubstr("key 'calibrated.camera.7'"), HasSubstr("1, 4")));
  write_toml(fmt::format("[calibrated.imu]\nT_lidar_imu = {}\n", kMotion));
  test::fs::remove(street_ / "imu.csv");
  EXPECT_THAT(error<ConfigError>(), AllOf(HasSubstr("no IMU"), HasSubstr(toml_.string()),
                                          HasSubstr("key 'calibrated.imu'")));
  options_.use_imu = false;
  EXPECT_EQ(open()->info().end, 3);
}

TEST_F(CalibratedDriveTest, IsRecognizedByItsTable) {
  const auto is_calibrated = [&](const std::string& text) {
    write_text(toml_, text);
    return is_calibrated_drive_file(toml_);
  };
  EXPECT_TRUE(is_calibrated("[calibrated]\n"));
  EXPECT_TRUE(is_calibrated("\xEF\xBB\xBFversion = 1\ncalibrated.drive = \"a\"\n"));
  EXPECT_FALSE(is_calibrated("version = 1\n# [calibrated]\n[camera.calibrated]\nindex = 1\n"));
  EXPECT_FALSE(is_calibrated("[calibrated\n"));
  EXPECT_FALSE(is_calibrated(""));
  EXPECT_FALSE(is_calibrated_drive_file(street_ / "drive.toml"));
  EXPECT_FALSE(is_calibrated_drive_file(folder_ / "nothing"));
  EXPECT_FALSE(is_calibrated_drive_file(folder_.path()));
}

TEST_F(CalibratedDriveTest, WrittenNumbersComeBack) {
  options_.cameras = {4};
  RigidMotion T = some_motion();
  T.rotate(Eigen::AngleAxisd(0.123456789, Eigen::Vector3d(1, 2, 3).normalized()));
  T.translation() << 1.0 / 3, -1e-7, 2.0 / 7;
  correction_.cameras = {{4, T, 0.1 + 0.2}};
  correction_.imu = {T, -1.0 / 3};
  write_calibrated_drive(drive_, street_, correction_);
  EXPECT_THAT(test::read_text(toml_), AllOf(HasSubstr("drive = \"../street\"\n"),
                                            HasSubstr("[calibrated.camera.4]\nT_cam_lidar = [[")));
  EXPECT_THAT(folder_.names(), ElementsAre("corrected", "street"));
  const DriveInfo info = open()->info();
  EXPECT_TRUE(info.calibration.cameras[0].T_cam_lidar.isApprox(T, 1e-15));
  EXPECT_EQ(info.calibration.cameras[0].T_cam_lidar.translation(), T.translation());
  EXPECT_EQ(info.calibration.cameras[0].image_delay, 0.1 + 0.2);
  EXPECT_EQ(info.imu->T_lidar_imu.translation(), T.translation());
}

TEST_F(CalibratedDriveTest, AnyNameOfAFolderCanBeWritten) {
  const path odd = folder_ / "a \"drive\" of \\ '''2026'''\n\tstreet";
  test::fs::create_directories(odd);
  test::fs::rename(street_, odd / "street #1");
  write_calibrated_drive(odd / "corrected", odd / "street #1", correction_);
  EXPECT_EQ(open(odd / "corrected")->info().end, 3);
  write_calibrated_drive(folder_ / "elsewhere", odd / "street #1", correction_);
  EXPECT_EQ(open(folder_ / "elsewhere")->info().end, 3);
  // Both can move together.
  test::fs::rename(odd, folder_ / "moved");
  EXPECT_EQ(open(folder_ / "moved/corrected")->info().end, 3);

  const path no_text = folder_ / "bytes \xFF";
  test::fs::rename(folder_ / "moved/street #1", no_text);
  EXPECT_THAT(error_of_writing<InputError>(drive_, no_text), HasSubstr("UTF-8"));
  EXPECT_FALSE(test::fs::exists(drive_));
}

TEST_F(CalibratedDriveTest, OnlyAnEarlierOneIsReplacedAndOnlyByForce) {
  write_calibrated_drive(drive_, street_, correction_);
  EXPECT_THAT(error_of_writing<InputError>(drive_, street_),
              AllOf(HasSubstr("exists already"), HasSubstr(toml_.string()), HasSubstr("--force")));
  correction_.cameras = {{1, some_motion(), 0.5}};
  write_calibrated_drive(drive_, street_, correction_, /*force=*/true);
  EXPECT_THAT(test::read_text(toml_), HasSubstr("added_delay = 0.5"));

  write_generic_drive(folder_ / "other");
  const std::string before = test::read_text(folder_ / "other/drive.toml");
  EXPECT_THAT(error_of_writing<InputError>(folder_ / "other", street_, /*force=*/true),
              AllOf(HasSubstr("no calibrated"), HasSubstr((folder_ / "other").string())));
  EXPECT_EQ(test::read_text(folder_ / "other/drive.toml"), before);
  write_text(toml_, "damaged [");
  EXPECT_THAT(error_of_writing<InputError>(drive_, street_, /*force=*/true), HasSubstr("no calib"));
}

TEST_F(CalibratedDriveTest, IsNotWrittenWhereItCouldNotBeRead) {
  const path raw = test::write_raw_drive(folder_ / "2026_01_01", 2);
  for (const path& folder : {raw, raw / "."}) {
    EXPECT_THAT(error_of_writing<InputError>(folder, raw, true), HasSubstr("another folder"));
  }
  EXPECT_THAT(error_of_writing<InputError>(raw, street_, true), HasSubstr("another folder"));
  EXPECT_FALSE(test::fs::exists(raw / "drive.toml"));
  // Neither in a circle.
  write_calibrated_drive(drive_, street_, correction_);
  write_calibrated_drive(folder_ / "again", drive_, correction_);
  EXPECT_THAT(error_of_writing<InputError>(drive_, folder_ / "again", true), HasSubstr("circle"));
  EXPECT_EQ(open()->info().end, 3);
  EXPECT_THAT(error_of_writing<InputError>(folder_ / "new", folder_ / "nothing"),
              HasSubstr((folder_ / "nothing").string()));
  correction_.cameras = {{1, RigidMotion(Eigen::Translation3d(1000, 0, 0)), 0}};
  EXPECT_THAT(error_of_writing<ConfigError>(folder_ / "new", street_), HasSubstr("1000 m"));
  EXPECT_FALSE(test::fs::exists(folder_ / "new"));
}

TEST_F(CalibratedDriveTest, TruthAndTrackletsAreThoseOfTheOtherDrive) {
  const path raw = folder_ / "2026_01_01/2026_01_01_drive_0001_sync";
  test::fs::rename(test::write_raw_drive(folder_ / "2026_01_01", 2), raw);
  Camera camera{2, 5, 4, 5, 5, 2, 1.5, RigidMotion::Identity()};
  test::write_truth_poses(raw / "truth", {49, 8.4, 100}, {2, RigidMotion::Identity()}, {camera});
  write_text(raw / "tracklet_labels.xml", "");
  // The drive may also be the only one below the folder that is named.
  for (const path& named : {raw, folder_.path()}) {
    write_calibrated_drive(drive_, named, correction_, /*force=*/true);
    const DriveInfo info = open()->info();
    EXPECT_EQ(DriveTruth(info.path).folder(), test::fs::canonical(raw / "truth"));
    EXPECT_EQ(find_tracklets(info.path), test::fs::canonical(raw) / "tracklet_labels.xml");
  }
}

TEST_F(CalibratedDriveTest, TheOtherDriveIsAnInputOfACommand) {
  write_calibrated_drive(drive_, street_, correction_);
  const auto error_of_output = [&](const CommandFiles& files) {
    return error_of<OutputError>([&] { check_files(files); });
  };
  write_text(street_ / "points.ply", "ply\nformat ascii 1.0\n");
  EXPECT_THAT(error_of_output({.inputs = {drive_.string()},
                               .outputs = {{(street_ / "points.ply").string(), ContentKind::kPly,
                                            /*force=*/true}}}),
              HasSubstr("the command reads"));
  EXPECT_THAT(error_of_output({.inputs = {drive_.string()},
                               .outputs = {},
                               .folder = {street_.string(), FolderUse::kReplace}}),
              HasSubstr("the command reads"));
}

}  // namespace fovea::calibrated_drive_test
