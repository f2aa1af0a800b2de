#include "fovea/pipeline/drive_match.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/pipeline/drive_records.h"

namespace fovea::drive_match_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

/// A drive that tests change: scans of a few points, images of two cameras.
class TestDrive : public FrameSource {
 public:
  DriveInfo info_;
  std::map<int, TimeNs> stamps;
  std::set<int> missing;        ///< frames without a scan
  std::size_t more_points = 0;  ///< in each scan

  explicit TestDrive(TimeNs start = 1000, int frames = 20) {
    info_.path = "drives/one";
    info_.end = frames;
    info_.calibration.T_imu_lidar = RigidMotion(Eigen::Translation3d(0.8, -0.3, 0.8));
    for (const int index : {2, 3}) {
      Camera camera;
      camera.index = index;
      camera.width = 1242;
      camera.height = 375;
      camera.fx = camera.fy = 721.5;
      camera.T_cam_lidar.translation().x() = 0.1 * index;
      info_.calibration.cameras.push_back(camera);
    }
    for (int i = 0; i < frames; ++i) stamps[i] = start + i * (kNsPerSecond / 10) + (i * 7919) % 31;
  }
  const DriveInfo& info() const override { return info_; }
  std::optional<TimeNs> stamp(int index) const override {
    const auto found = stamps.find(index);
    return found == stamps.end() ? std::nullopt : std::optional(found->second);
  }
  LoadedFrame load(int index) const override {
    if (missing.contains(index)) return SkippedFrame{index, SkipReason::kMissingScan, "gone"};
    Frame frame;
    frame.index = index;
    frame.stamp = stamps.at(index);
    frame.scan.position.resize(std::size_t(stamps.at(index) % 1000) + 50 + more_points);
    return frame;
  }
};

/// Writes the records that `fovea map` keeps of a drive, with other frame numbers.
void put_drive(MapWriter& writer, std::size_t id, const TestDrive& drive, int shift) {
  DriveRecord record = drive_record(drive);
  record.first_frame += shift;
  record.end_frame += shift;
  record.frame_shift = shift;
  writer.put_drive(id, record);
  for (int index = drive.info_.begin; index < drive.info_.end; ++index) {
    const LoadedFrame loaded = drive.load(index);
    FrameRecord frame;
    frame.index = index + shift;
    frame.stamp = drive.stamp(index);
    if (drive.info_.navigation) {
      frame.T_local_lidar_navigation = drive.info_.navigation->at(*frame.stamp);
    }
    frame.figures["points_scan"] = as_figure(std::get<Frame>(loaded).scan.size());
    for (std::size_t slot = 0; slot < drive.info_.image_offsets.size(); ++slot) {
      const Camera camera = drive.info_.camera_at(slot, index);
      frame.views.push_back(
          {camera.index, *frame.stamp + from_seconds(camera.image_delay), std::nullopt});
    }
    writer.put_frame(frame);
  }
}

class MatchDrive : public testing::Test {
 protected:
  void write_map(const TestDrive& drive) {
    const auto writer = MapWriter::create(folder_ / "a.fovea", true);
    put_drive(*writer, 0, drive, 0);
    writer->commit();
  }
  DriveMatch match(const FrameSource& drive) const {
    return match_drive(MapReader(folder_ / "a.fovea"), drive, "a.fovea");
  }
  std::string refusal(const FrameSource& drive) const {
    try {
      match(drive);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }
  TemporaryFolder folder_;
};

TEST_F(MatchDrive, AcceptsTheDriveUnderAnotherName) {
  TestDrive drive;
  write_map(drive);
  drive.info_.path = "elsewhere/renamed";
  const DriveMatch found = match(drive);
  EXPECT_TRUE(found.keeps_numbers);
  EXPECT_EQ(found.number_in_drive.size(), 20u);
  EXPECT_THAT(found.drives, ElementsAre(0));
  EXPECT_THAT(found.notes, IsEmpty());
}

TEST_F(MatchDrive, RefusesOtherStampsUnderTheSameName) {
  write_map(TestDrive());
  for (const TimeNs start : {TimeNs{1001}, TimeNs{1000} + kNsPerSecond / 10, TimeNs{1} << 60}) {
    EXPECT_THAT(refusal(TestDrive(start)),
                testing::AllOf(HasSubstr("was not made of the drive 'one'"), HasSubstr("stamps"),
                               HasSubstr("--foreign")))
        << start;
  }
  TestDrive without_stamps;
  without_stamps.stamps.clear();
  EXPECT_THAT(refusal(without_stamps), HasSubstr("it has no stamps"));
}

// Simulated drives have equal stamps, and so do drives without stamps.
TEST_F(MatchDrive, RefusesOtherScansAtTheSameStamps) {
  write_map(TestDrive());
  TestDrive other;
  other.more_points = 1;
  EXPECT_THAT(refusal(other), HasSubstr("its scan"));
}

/// Gives a drive navigation that moves by steps of `step` m.
void set_navigation(double step, const Eigen::Vector3d& origin, TestDrive& drive) {
  std::vector<StampedPose> poses;
  for (const auto& [index, stamp] : drive.stamps) {
    const Eigen::Vector3d place = origin + step * index * Eigen::Vector3d::UnitX();
    poses.push_back({stamp, RigidMotion(Eigen::Translation3d(place))});
  }
  drive.info_.navigation = Trajectory(poses);
}

TEST_F(MatchDrive, AcceptsScansWithoutSomeRingsIfNavigationAgrees) {
  TestDrive drive;
  set_navigation(0.8, {0, 0, 0}, drive);
  write_map(drive);
  TestDrive dense = drive, other = drive;
  dense.more_points = 20'000;
  set_navigation(0.8, {3, 1, 0}, dense);  // with another origin
  EXPECT_EQ(refusal(dense), "accepted");
  set_navigation(0.81, {0, 0, 0}, dense);
  EXPECT_THAT(refusal(dense), HasSubstr("its scan"));
  dense.info_.navigation.reset();
  EXPECT_THAT(refusal(dense), HasSubstr("its scan"));
  other.more_points = 1;  // another place on the same course
  EXPECT_THAT(refusal(other), HasSubstr("its scan"));
}

TEST_F(MatchDrive, RefusesAnotherCalibrationAndNamesIt) {
  write_map(TestDrive());
  TestDrive refocused, remounted;
  refocused.info_.calibration.cameras[1].fx += 0.1;
  EXPECT_THAT(refusal(refocused),
              testing::AllOf(HasSubstr("another calibration"), HasSubstr("camera 3,")));
  remounted.info_.calibration.T_imu_lidar->translation().x() += 0.01;
  EXPECT_THAT(refusal(remounted), HasSubstr("the place of the IMU"));
  // Only the cameras in use count.
  refocused.info_.calibration.cameras.pop_back();
  EXPECT_EQ(refusal(refocused), "accepted");
  TestDrive uncolored;
  uncolored.info_.calibration = {};
  EXPECT_EQ(refusal(uncolored), "accepted");
  write_map(uncolored);
  EXPECT_EQ(refusal(TestDrive()), "accepted");
}

TEST_F(MatchDrive, AcceptsAThinnedDriveAndAPartOfADrive) {
  TestDrive thinned, part, scans_lost;
  write_map(TestDrive());
  for (int i = 0; i < 20; ++i) {
    if (i % 7 != 3) thinned.stamps.erase(i);
    if (i != 11) scans_lost.missing.insert(i);
  }
  EXPECT_TRUE(match(thinned).keeps_numbers);
  EXPECT_EQ(match(thinned).number_in_drive.size(), 3u);
  EXPECT_EQ(refusal(scans_lost), "accepted");
  scans_lost.more_points = 3;
  EXPECT_THAT(refusal(scans_lost), HasSubstr("its scan 11 has"));
  part.info_.begin = 12;
  part.info_.end = 14;
  std::erase_if(part.stamps, [](const auto& stamp) { return stamp.first < 12; });
  EXPECT_EQ(match(part).number_in_drive.size(), 2u);
  // A map of a part of the drive.
  write_map(TestDrive(1000, 4));
  EXPECT_EQ(match(TestDrive()).number_in_drive.size(), 4u);
}

TEST_F(MatchDrive, FindsTheFramesOfAThinnedDriveThatIsNumberedAnew) {
  const TestDrive whole;
  write_map(whole);
  TestDrive thinned;
  thinned.stamps.clear();
  thinned.info_.end = 10;
  for (int i = 0; i < 10; ++i) thinned.stamps[i] = whole.stamps.at(2 * i + 1);
  const DriveMatch found = match(thinned);
  EXPECT_FALSE(found.keeps_numbers);
  EXPECT_EQ(found.number_in_drive.at(7), 3);
  EXPECT_FALSE(found.number_in_drive.contains(8));

  const auto drive = with_map_numbers(std::make_unique<TestDrive>(thinned), found);
  EXPECT_EQ(drive->info().begin, 1);
  EXPECT_EQ(drive->info().end, 20);
  EXPECT_EQ(drive->stamp(7), whole.stamp(7));
  EXPECT_EQ(drive->stamp(8), std::nullopt);
  EXPECT_EQ(std::get<Frame>(drive->load(7)).index, 7);
  EXPECT_EQ(std::get<Frame>(drive->load(7)).stamp, whole.stamp(7));
  EXPECT_TRUE(std::holds_alternative<SkippedFrame>(drive->load(8)));
}

// Half of the stamps in the common time, relative to the smaller number there.
TEST_F(MatchDrive, SomeOtherStampsDoNotMatter) {
  write_map(TestDrive());
  TestDrive drive;
  for (int i = 0; i < 20; ++i) drive.stamps[i] += i % 2;
  EXPECT_EQ(match(drive).number_in_drive.size(), 10u);
  EXPECT_FALSE(match(drive).keeps_numbers);
  drive.stamps[4] += 1;
  EXPECT_THAT(refusal(drive), HasSubstr("9 of 19 stamps"));
}

// The fingerprint contains the median delay of the present images.
TEST_F(MatchDrive, AcceptsAThinnedDriveWithDelaysOfSingleImages) {
  TestDrive drive;
  drive.info_.image_offsets.resize(2);
  drive.info_.calibration.cameras[0].image_delay = 0.020;
  for (int i = 0; i < 20; ++i) drive.info_.image_offsets[0][i] = 1e-4 * (i - 10);
  write_map(drive);
  EXPECT_EQ(refusal(drive), "accepted");
  TestDrive thinned = drive;  // keeps frames 0 to 4
  thinned.info_.calibration.cameras[0].image_delay = 0.0192;
  thinned.info_.image_offsets[0].clear();
  for (int i = 0; i < 5; ++i) thinned.info_.image_offsets[0][i] = 1e-4 * (i - 2);
  EXPECT_EQ(refusal(thinned), "accepted");
  thinned.info_.calibration.cameras[0].image_delay = 0.0555;
  EXPECT_EQ(refusal(thinned), "accepted");  // the map has the delay of each image
  thinned.info_.calibration.cameras[0].cx += 1;
  EXPECT_THAT(refusal(thinned), HasSubstr("camera 2"));
}

TEST_F(MatchDrive, FindsTheDriveInAMergedMap) {
  const TestDrive one, two(1000 + 77 * kNsPerSecond, 10);
  {
    const auto writer = MapWriter::create(folder_ / "a.fovea", true);
    put_drive(*writer, 0, one, 0);
    put_drive(*writer, 1, two, 20);
    writer->commit();
  }
  const DriveMatch first = match(one), second = match(two);
  EXPECT_THAT(first.drives, ElementsAre(0));
  EXPECT_FALSE(first.keeps_numbers);
  EXPECT_EQ(first.number_in_drive.size(), 20u);
  EXPECT_THAT(second.drives, ElementsAre(1));
  EXPECT_EQ(second.number_in_drive.size(), 10u);
  EXPECT_THAT(*second.number_in_drive.begin(), Pair(20, 0));
  EXPECT_THAT(refusal(TestDrive(5)), HasSubstr("was not made of"));
}

TEST_F(MatchDrive, AMapWithoutFingerprintsIsComparedByStamps) {
  const TestDrive drive;
  {
    const auto writer = MapWriter::create(folder_ / "a.fovea", true);
    put_drive(*writer, 0, drive, 0);
    DriveRecord record = drive_record(drive);
    record.calibration_fingerprint.reset();
    writer->put_drive(0, record);
    writer->commit();
  }
  TestDrive recalibrated;
  recalibrated.info_.calibration.cameras[0].fx += 1;
  EXPECT_THAT(match(recalibrated).notes, ElementsAre(HasSubstr("no fingerprint")));
  EXPECT_THAT(refusal(TestDrive(5)), HasSubstr("stamps"));
}

}  // namespace fovea::drive_match_test
