// Navigation that begins after the first scans.
#include "fovea/drive/live/live_navigation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fovea/drive/live/test_live_run.h"

namespace fovea::live_navigation_test {

using namespace test;
using testing::Contains;
using testing::HasSubstr;

namespace {

constexpr int kScans = 60, kLater = 25;  // scan with which navigation is there
constexpr TimeNs kBegin = kLiveStart + kLater * kLiveStep - kLiveStep / 4;

const Frame& frame_of(const LoadedFrame& loaded) { return std::get<Frame>(loaded); }

template <class Record>
void drop_before(std::vector<Record>& records, TimeNs time) {
  std::erase_if(records, [&](const Record& record) { return record.time < time; });
}

/// Number of the first frame that has poses.
int first_with_poses(const PlayedDrive& run) {
  for (const LoadedFrame& frame : run.frames) {
    if (!frame_of(frame).motion.poses.empty()) return frame_of(frame).index;
  }
  return -1;
}

/// All poses of the frames.
std::vector<StampedPose> poses_of(const PlayedDrive& run) {
  std::vector<StampedPose> poses;
  for (const LoadedFrame& loaded : run.frames) {
    const MotionData& motion = frame_of(loaded).motion;
    poses.insert(poses.end(), motion.poses.begin(), motion.poses.end());
    EXPECT_EQ(motion.accuracy.size(), motion.poses.size());
  }
  return poses;
}

NavigationOrigin origin_in(const PlayedDrive& run) {
  std::vector<NavigationOrigin> origins;
  for (const LoadedFrame& loaded : run.frames) {
    if (const auto& begins = frame_of(loaded).motion.begins) origins.push_back(*begins);
  }
  EXPECT_EQ(origins.size(), 1u);
  return origins.empty() ? NavigationOrigin() : origins.front();
}

}  // namespace

class LiveNavigationTest : public testing::Test {
 protected:
  PlayedDrive run(const LiveData& data) const {
    LiveOptions options = all_data();
    options.has_one_sender = true;
    return play(data, drive_toml(data.drive), options);
  }
  /// The antenna by the poses lies where the positions have it.
  static void expect_true(const PlayedDrive& run, const LiveData& data) {
    const LocalTangentPlane local(origin_in(run).point.value());
    const RigidMotion T_lidar_antenna = data.drive.T_body_lidar.inverse().matrix() *
                                        RigidMotion(Eigen::Translation3d(data.drive.antenna_body));
    const std::vector<StampedPose> poses = poses_of(run);
    ASSERT_FALSE(poses.empty());
    for (const StampedPose& pose : poses) {
      const auto sent =
          std::find_if(data.positions.begin(), data.positions.end(),
                       [&](const RecordedPosition& p) { return p.time == pose.time; });
      ASSERT_NE(sent, data.positions.end());
      const Eigen::Vector3d antenna = (pose.T_local_body * T_lidar_antenna).translation();
      EXPECT_LT((local.T_local_enu(sent->antenna).translation() - antenna).norm(), 1e-3);
    }
  }
};

TEST_F(LiveNavigationTest, PositionsThatComeLaterAreUsed) {
  LiveData data = live_car_by_positions(kScans, /*has_attitudes=*/true);
  drop_before(data.positions, kBegin);
  const PlayedDrive live = run(data);
  EXPECT_FALSE(live.info.navigation);
  EXPECT_FALSE(live.info.origin);
  EXPECT_EQ(first_with_poses(live), kLater);
  expect_true(live, data);
  // The LiDAR is at the origin when navigation begins.
  const Trajectory trajectory(poses_of(live));
  EXPECT_LT(trajectory.at(kLiveStart + kLater * kLiveStep)->translation().norm(), 1e-3);
  EXPECT_THAT(live.figures.notes,
              Contains(HasSubstr("the source of positions is used since 2.5 s")));
  EXPECT_TRUE(live.figures.warnings.empty());
}

TEST_F(LiveNavigationTest, TheFirstFixMayComeLater) {
  LiveData data = live_car_by_positions(kScans, /*has_attitudes=*/true);
  for (RecordedPosition& position : data.positions) {
    if (position.time < kBegin) position.accuracy = std::numeric_limits<double>::infinity();
  }
  const PlayedDrive live = run(data);
  EXPECT_FALSE(live.info.navigation);
  EXPECT_EQ(first_with_poses(live), kLater);
  expect_true(live, data);
}

TEST_F(LiveNavigationTest, AVehicleMayStandAtFirst) {
  LiveData data = live_car_by_positions(kScans, /*has_attitudes=*/false);
  data.inertia.clear();
  for (RecordedPosition& position : data.positions) {
    const double t = seconds(position.time - kLiveStart);
    // Stands, while the receiver wanders by 0.8 m, then drives to the west.
    const double wander = 7e-6 * std::sin(t), west = std::max(0.0, t - 2.5);
    position.antenna = {49 + (west > 0 ? 0 : wander), 8.4 - 1.2e-4 * west, 110};
    position.velocity.reset();
  }
  const PlayedDrive live = run(data);
  const int first = first_with_poses(live);
  EXPECT_GT(first, 25 + 2);
  EXPECT_LT(first, 25 + 10);
  const RigidMotion last = poses_of(live).back().T_local_body;
  EXPECT_LT(last.linear().col(0).x(), -0.99);  // heads to the west
}

TEST_F(LiveNavigationTest, PosesThatComeLaterAreUsed) {
  LiveData data = live_car(kScans);
  drop_before(data.poses, kBegin);
  const PlayedDrive live = run(data);
  EXPECT_FALSE(live.info.navigation);
  EXPECT_EQ(first_with_poses(live), kLater);
  const Eigen::Vector3d world = origin_in(live).world.value();
  EXPECT_FALSE(origin_in(live).point);
  const std::vector<StampedPose> poses = poses_of(live);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RigidMotion T_world_lidar =
        RigidMotion(Eigen::Translation3d(world)) * poses[i].T_local_body;
    const RigidMotion sent = data.poses[i].T_world_body.matrix() * data.drive.T_body_lidar.matrix();
    EXPECT_TRUE(T_world_lidar.isApprox(sent, 1e-9)) << i;
  }
}

TEST_F(LiveNavigationTest, OrientationsOfTheImuServeLaterPositions) {
  LiveData data = live_car_by_positions(kScans, /*has_attitudes=*/false);
  drop_before(data.positions, kBegin);
  const PlayedDrive live = run(data);
  EXPECT_EQ(first_with_poses(live), kLater);
  expect_true(live, data);
}

TEST_F(LiveNavigationTest, ASkippedFrameLosesNoBeginning) {
  LiveData data = live_car_by_positions(kScans, /*has_attitudes=*/true);
  drop_before(data.positions, kBegin);
  data.scans[kLater].points.position.clear();
  PlayedDrive live = run(data);
  std::erase_if(live.frames, [](const LoadedFrame& frame) {
    return std::holds_alternative<SkippedFrame>(frame);
  });
  EXPECT_EQ(first_with_poses(live), kLater + 1);
  expect_true(live, data);
}

TEST_F(LiveNavigationTest, PositionsOfAnotherClockAreNotUsed) {
  LiveData data = live_car_by_positions(kScans, /*has_attitudes=*/true);
  for (RecordedPosition& position : data.positions) position.time -= 1000 * kNsPerSecond;
  const PlayedDrive live = run(data);
  EXPECT_EQ(first_with_poses(live), -1);
  EXPECT_THAT(live.figures.warnings, Contains(HasSubstr("are their times of one clock?")));
}

TEST_F(LiveNavigationTest, PositionsOfNoUseAreExplained) {
  LiveData data = live_car_by_positions(kScans, /*has_attitudes=*/false);
  data.inertia.clear();
  for (RecordedPosition& position : data.positions) {
    position.antenna = {49, 8.4, 110};
    position.velocity.reset();
  }
  const PlayedDrive live = run(data);
  EXPECT_EQ(first_with_poses(live), -1);
  EXPECT_THAT(live.figures.warnings, Contains(HasSubstr("no attitude and never moves by a meter")));
}

TEST_F(LiveNavigationTest, NavigationThatIsNotWantedNeverBegins) {
  LiveData data = live_car_by_positions(kScans, /*has_attitudes=*/true);
  drop_before(data.positions, kBegin);
  LiveOptions options = all_data();
  options.has_one_sender = true;
  options.drive.use_navigation = false;
  const PlayedDrive live = play(data, drive_toml(data.drive), options);
  EXPECT_EQ(first_with_poses(live), -1);
  EXPECT_TRUE(live.figures.notes.empty());
}

}  // namespace fovea::live_navigation_test
