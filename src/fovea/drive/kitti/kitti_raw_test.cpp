#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "../../../../tests/kitti_test_drive.h"
#include "fovea/drive/frame_source.h"
#include "fovea/errors.h"

namespace fovea::kitti_raw_test {

using test::edit;
using test::error_of;
using test::pattern;
using test::write_png;
using test::write_scan;
using test::write_text;
using test::fs::path;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kFrames = 8;

class KittiRaw : public testing::Test {
 protected:
  std::unique_ptr<FrameSource> open() const { return open_drive(drive_, options_); }

  path scan(int frame) const {
    return drive_ / fmt::format("velodyne_points/data/{:010}.bin", frame);
  }
  path image(int camera, int frame) const {
    return drive_ / fmt::format("image_0{}/data/{:010}.png", camera, frame);
  }
  path oxts(int frame) const { return drive_ / fmt::format("oxts/data/{:010}.txt", frame); }
  path stamps() const { return drive_ / "velodyne_points/timestamps.txt"; }

  /// The one frame that cannot be loaded.
  static SkippedFrame only_skipped(const FrameSource& drive) {
    std::vector<SkippedFrame> skipped;
    for (int i = drive.info().begin; i < drive.info().end; ++i) {
      const LoadedFrame result = drive.load(i);
      if (const auto* bad = std::get_if<SkippedFrame>(&result)) skipped.push_back(*bad);
    }
    EXPECT_EQ(skipped.size(), 1u);
    return skipped.empty() ? SkippedFrame{} : skipped.front();
  }
  void expect_skipped(int frame, SkipReason reason, const std::string& detail) const {
    const SkippedFrame skipped = only_skipped(*open());
    EXPECT_EQ(skipped.index, frame);
    EXPECT_EQ(skipped.reason, reason) << to_string(skipped.reason);
    EXPECT_THAT(skipped.detail, HasSubstr(detail));
  }

  test::TemporaryFolder folder_;
  path drive_ = test::write_raw_drive(folder_.path(), kFrames);
  DriveOptions options_;
};

TEST_F(KittiRaw, LoadsWhatTheFilesHold) {
  const auto drive = open();
  const DriveInfo& info = drive->info();
  EXPECT_EQ(info.kind, "kitti-raw");
  // Images count as taken at their scan's stamp, although KITTI stamps them later.
  EXPECT_FALSE(info.image_stamps_are_capture_times);
  EXPECT_FALSE(info.has_image_delays());
  EXPECT_EQ(info.path, drive_);
  EXPECT_EQ(info.begin, 0);
  EXPECT_EQ(info.end, kFrames);
  EXPECT_TRUE(info.has_time_stamps);
  EXPECT_NEAR(info.sweep.period, 0.1, 1e-9);
  EXPECT_FALSE(info.sweep_compensated);
  EXPECT_TRUE(info.reference_poses.empty());
  // Stamps and records reach beyond the last scan: that is normal.
  EXPECT_THAT(info.notes, testing::IsEmpty());
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = std::get<Frame>(drive->load(i));
    EXPECT_EQ(frame.index, i);
    EXPECT_EQ(frame.stamp, *drive->stamp(0) + i * kNsPerSecond / 10);
    ASSERT_EQ(frame.scan.size(), 2u);
    EXPECT_EQ(frame.scan.position[1], Eigen::Vector3f(float(i), 1, 0));
    ASSERT_EQ(frame.images.size(), 1u);
    EXPECT_EQ(frame.images[0].data, pattern(test::kWidth, test::kHeight, 3).data);
  }
}

TEST_F(KittiRaw, NavigationStartsAtTheFirstFrameAndFollowsTheRoad) {
  const auto drive = open();
  const DriveInfo& info = drive->info();
  ASSERT_TRUE(info.navigation && info.origin && info.calibration.T_imu_lidar);
  for (int i = 0; i < kFrames; ++i) {  // 1 m a frame, northwards; frame 0 is extrapolated
    const RigidMotion T = info.navigation->at(*drive->stamp(i)).value();
    EXPECT_LT((T.translation() - Eigen::Vector3d(0, i, 0)).norm(), 1e-3) << i;
    EXPECT_LT((T.rotation().col(0) - Eigen::Vector3d::UnitY()).norm(), 1e-6);
  }
  EXPECT_NEAR(info.origin->altitude, 100.9, 1e-4);
  EXPECT_NEAR(info.origin->latitude, 49 + 0.8 / 111'219.7, 1e-9);
}

TEST_F(KittiRaw, OriginIsTheFirstUsableFrameOfTheRange) {
  options_.begin = 3;
  test::fs::remove(image(2, 3));
  const auto drive = open();
  EXPECT_EQ(drive->info().begin, 3);
  EXPECT_LT(drive->info().navigation->at(*drive->stamp(4))->translation().norm(), 1e-5);
}

TEST_F(KittiRaw, RangeIsCutToTheDrive) {
  options_.begin = -5;
  options_.end = 100;
  EXPECT_EQ(open()->info().end, kFrames);
  EXPECT_EQ(open()->info().begin, 0);
  options_.begin = 2;
  options_.end = 4;
  EXPECT_EQ(open()->info().begin, 2);
  EXPECT_EQ(open()->info().end, 4);
  options_.begin = 8;
  options_.end = 12;
  EXPECT_THAT(error_of<ConfigError>([&] { open(); }), HasSubstr("choose from 0:8"));
  options_.begin = 4;
  options_.end = 4;
  EXPECT_THROW(open(), ConfigError);
}

TEST_F(KittiRaw, IndexIsTheNumberInTheName) {
  for (int i = 0; i < 3; ++i) test::fs::remove(scan(i));
  const auto drive = open();
  EXPECT_EQ(drive->info().begin, 3);
  EXPECT_EQ(std::get<Frame>(drive->load(3)).scan.position[1].x(), 3.f);
}

TEST_F(KittiRaw, CamerasInTheOrderAskedFor) {
  options_.cameras = {3, 2};
  write_png(image(3, 1), pattern(test::kWidth, test::kHeight, 1));
  const auto drive = open();
  ASSERT_EQ(drive->info().calibration.cameras.size(), 2u);
  EXPECT_EQ(drive->info().calibration.cameras[0].index, 3);
  const Frame frame = std::get<Frame>(drive->load(1));
  EXPECT_EQ(frame.images[0].channels, 1);  // camera 3's
  EXPECT_EQ(frame.images[1].channels, 3);
}

TEST_F(KittiRaw, CamerasThatAreNotThere) {
  options_.cameras = {0};
  const std::string message = error_of<ConfigError>([&] { open(); });
  EXPECT_THAT(message, HasSubstr("no camera 0"));
  EXPECT_THAT(message, HasSubstr("choose from 2, 3"));
  options_.cameras = {2, 2};
  EXPECT_THROW(open(), ConfigError);
  options_.cameras = {};
  test::fs::remove_all(drive_ / "image_02");
  EXPECT_EQ(open()->info().calibration.cameras.at(0).index, 3);
  for (int i = 0; i < kFrames; ++i) test::fs::remove(image(3, i));
  EXPECT_THAT(error_of<InputError>([&] { open(); }), HasSubstr("--cameras none"));
}

TEST_F(KittiRaw, ADriveWithoutFoldersOfImagesHasNoCamera) {
  test::fs::remove_all(drive_ / "image_02");
  test::fs::remove_all(drive_ / "image_03");
  const auto drive = open();
  EXPECT_TRUE(drive->info().calibration.cameras.empty());
  EXPECT_TRUE(drive->info().navigation);
  EXPECT_THAT(drive->info().notes, testing::ElementsAre(HasSubstr("the drive has no camera")));
  EXPECT_TRUE(std::get<Frame>(drive->load(3)).images.empty());
  options_.cameras = {2};
  EXPECT_THAT(error_of<InputError>([&] { open(); }), HasSubstr("no camera"));
}

TEST_F(KittiRaw, JpegImagesCountLikePng) {
  test::fs::rename(image(2, 4), image(2, 4).replace_extension(".jpg"));
  EXPECT_TRUE(std::holds_alternative<Frame>(open()->load(4)));
}

TEST_F(KittiRaw, SkipsMissingParts) {
  test::fs::remove(scan(2));
  expect_skipped(2, SkipReason::kMissingScan, "no scan 2");
}
TEST_F(KittiRaw, SkipsMissingImages) {
  test::fs::remove(image(2, 5));
  expect_skipped(5, SkipReason::kMissingImage, "no image 5 of camera 2");
}
// Two cameras: what one of them has is used, and the frame says what is missing.
TEST_F(KittiRaw, AFrameWithOneImageOfTwoIsLoaded) {
  options_.cameras = {2, 3};
  test::fs::remove(image(3, 5));
  test::truncate(image(2, 6), 0.7);
  const auto drive = open();
  const Frame five = std::get<Frame>(drive->load(5)), six = std::get<Frame>(drive->load(6));
  EXPECT_EQ(five.images.at(0).data, pattern(test::kWidth, test::kHeight, 3).data);
  EXPECT_TRUE(five.images.at(1).empty());
  ASSERT_EQ(five.missing_images.size(), 1u);
  EXPECT_EQ(five.missing_images[0].camera, 3);
  EXPECT_EQ(five.missing_images[0].reason, SkipReason::kMissingImage);
  EXPECT_EQ(five.missing_images[0].detail, "no image 5 of camera 3");
  EXPECT_TRUE(six.images.at(0).empty());
  EXPECT_FALSE(six.images.at(1).empty());
  ASSERT_EQ(six.missing_images.size(), 1u);
  EXPECT_EQ(six.missing_images[0].camera, 2);
  EXPECT_EQ(six.missing_images[0].reason, SkipReason::kDamagedImage);
  EXPECT_THAT(six.missing_images[0].detail, HasSubstr("0000000006.png"));
  EXPECT_TRUE(std::get<Frame>(drive->load(4)).missing_images.empty());
}
TEST_F(KittiRaw, SkipsFramesWithoutAnyImage) {
  options_.cameras = {2, 3};
  test::fs::remove(image(2, 5));
  test::truncate(image(3, 5), 0.7);
  expect_skipped(5, SkipReason::kMissingImage, "no image 5 of camera 2; ");
  expect_skipped(5, SkipReason::kMissingImage, "image_03/data/0000000005.png");
}
// The local frame's origin is the first frame that is used, be it without one of its images.
TEST_F(KittiRaw, TheOriginIsThatOfTheFirstFrameWithAnImage) {
  options_.cameras = {2, 3};
  const double latitude = open()->info().origin->latitude;
  test::fs::remove(image(2, 0));
  EXPECT_EQ(open()->info().origin->latitude, latitude);
  test::fs::remove(image(3, 0));
  EXPECT_GT(open()->info().origin->latitude, latitude);
}
TEST_F(KittiRaw, ACameraThatStopsLeavesTheOtherOne) {
  options_.cameras = {3, 2};
  for (int i = 4; i < kFrames; ++i) test::fs::remove(image(3, i));
  const auto drive = open();
  for (int i = 0; i < kFrames; ++i) {
    const Frame frame = std::get<Frame>(drive->load(i));
    EXPECT_EQ(frame.images.at(0).empty(), i >= 4);
    EXPECT_FALSE(frame.images.at(1).empty());
  }
}
TEST_F(KittiRaw, SkipsDamagedScans) {
  test::fs::resize_file(scan(6), 17);
  expect_skipped(6, SkipReason::kDamagedScan, "0000000006.bin");
}
TEST_F(KittiRaw, SkipsDamagedImages) {
  test::truncate(image(2, 1), 0.7);
  expect_skipped(1, SkipReason::kDamagedImage, "0000000001.png");
}
TEST_F(KittiRaw, SkipsImagesOfAnotherSizeThanTheCalibrations) {
  write_png(image(2, 1), pattern(test::kWidth, test::kHeight + 1, 3));
  expect_skipped(1, SkipReason::kDamagedImage, "24 x 11 pixels, its camera 24 x 10");
}
TEST_F(KittiRaw, SkipsBlankStamps) {
  edit(stamps(), test::stamp(3), "");
  expect_skipped(3, SkipReason::kMissingStamp, "no time stamp in line 4");
  EXPECT_FALSE(open()->stamp(3));
  EXPECT_TRUE(open()->stamp(4));
  EXPECT_THAT(open()->info().notes, testing::IsEmpty());
}
TEST_F(KittiRaw, SkipsMalformedStamps) {
  edit(stamps(), test::stamp(3), "yesterday");
  expect_skipped(3, SkipReason::kMissingStamp, "malformed");
  EXPECT_THAT(open()->info().notes, ElementsAre(HasSubstr("1 malformed lines (4)")));
}
TEST_F(KittiRaw, SkipsStampsOutOfOrder) {
  edit(stamps(), test::stamp(4), "2011-09-26 12:00:00.0");
  expect_skipped(4, SkipReason::kMissingStamp, "out of order");
  EXPECT_THAT(open()->info().notes, ElementsAre(HasSubstr("1 stamps out of order (lines 5)")));
}
TEST_F(KittiRaw, SkipsFramesBeyondTheStamps) {
  std::string text;
  for (int i = 0; i < kFrames - 1; ++i) text += test::stamp(i) + "\n";
  write_text(stamps(), text);
  expect_skipped(kFrames - 1, SkipReason::kMissingStamp, "no time stamp in line 8");
}
TEST_F(KittiRaw, FramesWithoutTheirRecordAreNotedAndPlacedByTheirNeighbours) {
  test::fs::remove(oxts(2));
  const auto drive = open();
  EXPECT_TRUE(std::holds_alternative<Frame>(drive->load(2)));
  EXPECT_TRUE(drive->info().navigation->at(*drive->stamp(2)));
  EXPECT_THAT(drive->info().notes,
              ElementsAre(HasSubstr("1 frames have no GPS/INS record (the first: 2)")));
}
TEST_F(KittiRaw, BadRecordsAreNotedAndNotUsed) {
  write_text(oxts(5), "nan" + test::read_text(oxts(5)).substr(15));
  const auto drive = open();
  EXPECT_TRUE(std::holds_alternative<Frame>(drive->load(5)));
  EXPECT_THAT(drive->info().notes, ElementsAre(HasSubstr("1 of 13 GPS/INS records")));
  EXPECT_EQ(drive->info().navigation->poses().size(), 12u);
  EXPECT_EQ(drive->info().navigation_accuracy.size(), 12u);
}
TEST_F(KittiRaw, ARecordWithoutAFixDoesNotGeoreference) {
  const GeodeticPoint origin = *open()->info().origin;
  for (const int frame : {0, 1}) write_text(oxts(frame), "0 0 0" + test::oxts_record(0).substr(23));
  const auto drive = open();
  EXPECT_THAT(drive->info().notes,
              testing::Contains(HasSubstr("latitude and longitude 0: no fix")));
  EXPECT_NEAR(drive->info().origin->latitude, origin.latitude, 1e-4);
}

TEST_F(KittiRaw, RecordsOfAnotherClockAreNoNavigation) {
  std::string stamps;
  for (int i = 0; i < 13; ++i) stamps += "2011-09-26 15:00:0" + std::to_string(i % 10) + ".5\n";
  write_text(drive_ / "oxts/timestamps.txt", stamps);
  const auto drive = open();
  EXPECT_FALSE(drive->info().navigation);
  EXPECT_FALSE(drive->info().origin);
  EXPECT_THAT(drive->info().notes, testing::Contains(HasSubstr("are their times of one clock?")));
}

TEST_F(KittiRaw, RecordsWithoutATimeAreNotUsed) {
  edit(drive_ / "oxts/timestamps.txt", test::stamp(5, 20), "");
  EXPECT_THAT(open()->info().notes, ElementsAre(HasSubstr("no usable time stamp")));
  EXPECT_EQ(open()->info().navigation->poses().size(), 12u);
}
TEST_F(KittiRaw, BadRecordsDoNotMatterWithoutNavigation) {
  write_text(oxts(5), "");
  options_.use_navigation = options_.use_imu = false;
  const auto drive = open();
  EXPECT_FALSE(drive->info().imu);
  EXPECT_FALSE(drive->info().navigation || drive->info().origin);
  EXPECT_THAT(drive->info().notes, testing::IsEmpty());
  EXPECT_TRUE(std::holds_alternative<Frame>(drive->load(5)));
}
TEST_F(KittiRaw, WithoutNavigationItsRatesAndAccelerationsAreAnImu) {
  EXPECT_FALSE(open()->info().imu);
  write_text(oxts(5),
             "49 8.4 100 0 0 1.5 10 0 10 0 0 1 2 9.5 0 0 0 0.1 0.2 0.3 0 0 0 0 0 0 0 0 0 0\n");
  options_.use_navigation = false;
  const auto drive = open();
  ASSERT_TRUE(drive->info().imu);
  const ImuData& imu = *drive->info().imu;
  EXPECT_EQ(imu.samples.size(), 13u);
  EXPECT_EQ(imu.samples[5].rate, Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(imu.samples[5].force, Eigen::Vector3d(1, 2, 9.5));
  EXPECT_THAT(drive->info().warnings, ElementsAre(HasSubstr("10 records a second")));
}
TEST_F(KittiRaw, ScansAloneNeedNoImages) {
  for (int k = 0; k < 4; ++k) test::fs::remove_all(image(k, 5).parent_path());
  EXPECT_THROW(open(), InputError);
  options_.use_images = false;
  const auto drive = open();
  EXPECT_TRUE(drive->info().calibration.cameras.empty());
  EXPECT_TRUE(drive->info().navigation && drive->info().origin);
  const LoadedFrame loaded = drive->load(5);
  ASSERT_TRUE(std::holds_alternative<Frame>(loaded));
  EXPECT_GT(std::get<Frame>(loaded).scan.size(), 0u);
  EXPECT_TRUE(std::get<Frame>(loaded).images.empty());
}
TEST_F(KittiRaw, FramesFarFromEveryRecordHaveNoNavigation) {
  edit(stamps(), test::stamp(12), "2011-09-26 13:05:00.0");
  write_scan(scan(12), {{1, 1, 1, 1}});
  write_png(image(2, 12), pattern(test::kWidth, test::kHeight, 3));
  const auto drive = open();
  EXPECT_TRUE(std::holds_alternative<Frame>(drive->load(12)));
  EXPECT_FALSE(drive->info().navigation->at(*drive->stamp(12)));
}

TEST_F(KittiRaw, ScansWithBadPointsLoadWithoutThem) {
  write_scan(scan(0), {{1, 2, 3, 0}, {std::nanf(""), 0, 0, 0}, {1, 1e9f, 0, 0}});
  const Frame frame = std::get<Frame>(open()->load(0));
  EXPECT_EQ(frame.scan.size(), 1u);
  EXPECT_EQ(frame.dropped_points.total(), 2u);
}

TEST_F(KittiRaw, WithoutStampsTenHertz) {
  for (const bool file_there : {true, false}) {
    write_text(stamps(), "\n\n");
    if (!file_there) test::fs::remove(stamps());
    const auto drive = open();
    EXPECT_FALSE(drive->info().has_time_stamps);
    EXPECT_EQ(drive->stamp(7), 7 * kNsPerSecond / 10);
    EXPECT_EQ(drive->info().sweep.period, 0.1);
    EXPECT_THAT(drive->info().notes, ElementsAre(HasSubstr("10 Hz")));
    // A record belongs to the scan of its number.
    EXPECT_NEAR(drive->info().navigation->at(*drive->stamp(7))->translation().y(), 7, 1e-3);
    EXPECT_TRUE(std::holds_alternative<Frame>(drive->load(7)));
  }
}

TEST_F(KittiRaw, SparseStampsAreNoSweepPeriod) {
  std::string text;
  for (int i = 0; i < kFrames; ++i) text += fmt::format("2011-09-26 13:00:{:02}.0\n", i);
  write_text(stamps(), text);
  EXPECT_EQ(open()->info().sweep.period, 0.1);
  EXPECT_THAT(open()->info().notes, testing::Contains(HasSubstr("no LiDAR's turn")));
}

TEST_F(KittiRaw, WithoutNavigationNotGeoreferenced) {
  const auto expect_none = [&](const std::string& why) {
    const auto drive = open();
    EXPECT_FALSE(drive->info().navigation || drive->info().origin);
    EXPECT_THAT(drive->info().notes, ElementsAre(HasSubstr(why)));
    EXPECT_TRUE(std::holds_alternative<Frame>(drive->load(0)));
  };
  const path calibration = folder_.path() / "calib_imu_to_velo.txt";
  test::fs::rename(calibration, folder_.path() / "aside");
  expect_none("calib_imu_to_velo.txt is missing");
  test::fs::rename(folder_.path() / "aside", calibration);
  test::fs::remove(drive_ / "oxts/timestamps.txt");
  expect_none("timestamps.txt is missing");
  write_text(drive_ / "oxts/timestamps.txt", "");
  expect_none("no GPS/INS record can be used");
  test::fs::remove_all(drive_ / "oxts");
  expect_none("has no record");
}

TEST_F(KittiRaw, LoadsFromManyThreadsAlike) {
  options_.cameras = {2, 3};
  const auto drive = open();
  const Frame reference = std::get<Frame>(drive->load(4));
  std::vector<int> equal(8);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < equal.size(); ++t) {
    threads.emplace_back([&, t] {
      const Frame frame = std::get<Frame>(drive->load(4));
      equal[t] = frame.scan.position == reference.scan.position &&
                 frame.images[0].data == reference.images[0].data &&
                 frame.images[1].data == reference.images[1].data;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_THAT(equal, testing::Each(1));
}

TEST_F(KittiRaw, PathsInAnyForm) {
  EXPECT_NO_THROW(open_drive(drive_ / "", {}));
  EXPECT_NO_THROW(open_drive(drive_ / "oxts" / "..", {}));
  const path before = test::fs::current_path();
  test::fs::current_path(drive_);
  EXPECT_NO_THROW(open_drive(".", {}));
  test::fs::current_path(before);
}

TEST_F(KittiRaw, FoldersThatAreNoDrive) {
  const auto message = [](const path& folder) {
    return error_of<InputError>([&] { open_drive(folder, {}); });
  };
  EXPECT_THAT(message(folder_.path() / "none"), HasSubstr("does not exist"));
  EXPECT_THAT(message(stamps()), HasSubstr("no folder"));
  test::fs::create_directory(folder_.path() / "empty");
  EXPECT_THAT(message(folder_.path() / "empty"), HasSubstr("is empty"));
  EXPECT_THAT(message(folder_.path()), HasSubstr("neither drive.toml"));
  EXPECT_THAT(message(folder_.path()), HasSubstr("DATE_drive_NNNN_sync"));
  test::fs::remove_all(drive_ / "velodyne_points/data");
  EXPECT_THAT(message(drive_), HasSubstr("the drive has no scan"));
}

TEST_F(KittiRaw, UnusableCalibrationIsAnError) {
  test::fs::remove(folder_.path() / "calib_velo_to_cam.txt");
  EXPECT_THAT(error_of<InputError>([&] { open(); }), HasSubstr("calib_velo_to_cam.txt"));
}

}  // namespace fovea::kitti_raw_test
