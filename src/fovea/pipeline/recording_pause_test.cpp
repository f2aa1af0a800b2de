// Drives whose recording pauses, while the vehicle stands or drives on.
#include <gtest/gtest.h>

#include "fovea/pipeline/mapper_test_support.h"

namespace fovea::recording_pause_test {

constexpr int kFrames = 12, kPaused = 6;
constexpr TimeNs kPause = 60 * kNsPerSecond;

MapperOptions options() {
  MapperOptions options;
  options.fusion.loop_closure = false;
  return options;
}

/// A drive through the town at 1 m a frame. A minute passes before frame 6, where the vehicle is
/// `moved` meters farther than without the pause.
SyntheticDrive paused_drive(double moved, bool with_navigation) {
  SyntheticDrive drive(town_scene(), kFrames, 1.0);
  drive.beams = 24;
  drive.columns = 360;
  drive.paused_frame = kPaused;
  drive.pause = kPause;
  std::vector<StampedPose> navigation;
  for (int i = 0; i < kFrames; ++i) {
    RigidMotion& T = drive.T_local_lidar[std::size_t(i)];
    if (i >= kPaused) T.translation().x() += moved;
    navigation.push_back({*drive.stamp(i), T});
  }
  drive.editable_info().navigation.reset();
  if (with_navigation) drive.editable_info().navigation = Trajectory(navigation);
  return drive;
}

double position_error(const SyntheticDrive& drive, const FrameRecord& record) {
  const auto index = static_cast<std::size_t>(record.index);
  const RigidMotion truth = drive.T_local_lidar[0].inverse() * drive.T_local_lidar[index];
  return (record.T_odom_lidar.translation() - truth.translation()).norm();
}

std::vector<FrameRecord> map_whole(const SyntheticDrive& drive) {
  Mapper mapper(drive.info(), options(), PoseSource::kRefine);
  return map_frames(mapper, drive, 0, kFrames);
}

TEST(RecordingPause, NavigationBridgesIt) {
  for (const double moved : {-1.0, 0.0, 4.0}) {
    const SyntheticDrive drive = paused_drive(moved, true);
    for (const FrameRecord& record : map_whole(drive)) {
      EXPECT_LT(position_error(drive, record), 0.05) << moved << " m, frame " << record.index;
      EXPECT_FALSE(record.has("track_restarted")) << record.index;
      EXPECT_FALSE(record.has("navigation_jumped")) << record.index;
    }
  }
}

TEST(RecordingPause, WithoutNavigationTheScanIsFoundInTheLocalMap) {
  for (const double moved : {-1.0, 4.0, -6.0}) {
    const SyntheticDrive drive = paused_drive(moved, false);
    for (const FrameRecord& record : map_whole(drive)) {
      EXPECT_LT(position_error(drive, record), 0.05) << moved << " m, frame " << record.index;
      EXPECT_FALSE(record.has("track_restarted")) << record.index;
    }
  }
}

/// The same drive, continued at a place without common scans: another town, a copy of the first one
/// at an offset.
class ElsewhereDrive {
 public:
  explicit ElsewhereDrive(bool with_navigation) : drive(paused_drive(0, with_navigation)) {
    std::vector<StampedPose> navigation;
    for (int i = 0; i < kFrames; ++i) {
      RigidMotion T = drive.T_local_lidar[std::size_t(i)];
      if (i >= kPaused) T.translation().x() += kAway;
      navigation.push_back({*drive.stamp(i), T});
    }
    if (with_navigation) drive.editable_info().navigation = Trajectory(navigation);
  }

  Frame frame(int index) const {
    Frame frame = std::get<Frame>(drive.load(index));
    if (index < kPaused) return frame;
    // A hall of two walls at 11 and 17 m, past which the vehicle drives.
    const float x = float(index - kPaused);
    for (std::size_t i = 0; i < frame.scan.size(); ++i) {
      Eigen::Vector3f& p = frame.scan.position[i];
      if (p.z() < -1.2f) continue;
      p *= wall_range(p, x) / p.norm();
    }
    return frame;
  }

  static constexpr double kAway = 300;  // m
  SyntheticDrive drive;

 private:
  static float wall_range(const Eigen::Vector3f& p, float x) {
    const Eigen::Vector3f ray = p.normalized();
    const float to_side = (ray.y() > 0 ? 11.0f : -17.0f) / ray.y();
    const float to_end = ((ray.x() > 0 ? 23.0f : -13.0f) - x) / ray.x();
    return std::min(to_side, to_end);
  }
};

std::vector<FrameRecord> map_whole(const ElsewhereDrive& drive) {
  Mapper mapper(drive.drive.info(), options(), PoseSource::kRefine);
  std::vector<FrameRecord> records;
  for (int i = 0; i < kFrames; ++i) records.push_back(record_of(mapper.process(drive.frame(i))));
  return records;
}

/// Every frame after the pause is a meter ahead of the one before.
void expect_steady_motion(const std::vector<FrameRecord>& records) {
  for (std::size_t i = kPaused + 1; i < records.size(); ++i) {
    const RigidMotion moved = records[i - 1].T_local_lidar.inverse() * records[i].T_local_lidar;
    EXPECT_NEAR(moved.translation().x(), 1, 0.05) << i;
  }
}

// Poses that are given across the pause are kept as they are.
TEST(RecordingPause, GivenPosesNeedNoSearch) {
  const ElsewhereDrive drive(false);
  Mapper mapper(drive.drive.info(), options(), PoseSource::kGivenFirst);
  for (int i = 0; i < kFrames; ++i) {
    const RigidMotion given(Eigen::Translation3d(i < kPaused ? i : i + 40, 0, 0));
    const FrameResult result = mapper.process(drive.frame(i), {.given_pose = given});
    EXPECT_EQ(result.poses.T_odom_lidar.matrix(), given.matrix()) << i;
    EXPECT_FALSE(result.tracking.has_restarted) << i;
  }
}

TEST(RecordingPause, ElsewhereTheTrackRestartsAtThePoseOfNavigation) {
  const ElsewhereDrive drive(true);
  const std::vector<FrameRecord> records = map_whole(drive);
  EXPECT_TRUE(records[kPaused].has("track_restarted"));
  EXPECT_FALSE(records[kPaused].has("pose_unknown"));
  EXPECT_EQ(records[kPaused].submap, records[kPaused - 1].submap + 1);
  EXPECT_NEAR(records[kPaused].T_local_lidar.translation().x(), kPaused + ElsewhereDrive::kAway,
              0.2);
  expect_steady_motion(records);
}

TEST(RecordingPause, ElsewhereWithoutNavigationTheUnknownPoseIsReported) {
  const ElsewhereDrive drive(false);
  const std::vector<FrameRecord> records = map_whole(drive);
  EXPECT_TRUE(records[kPaused].has("track_restarted"));
  EXPECT_TRUE(records[kPaused].has("pose_unknown"));
  EXPECT_NE(records[kPaused].note.find("restarts after a pause of 60.1 s"), std::string::npos)
      << records[kPaused].note;
  EXPECT_EQ(records[kPaused].submap, records[kPaused - 1].submap + 1);
  expect_steady_motion(records);
}

}  // namespace fovea::recording_pause_test
