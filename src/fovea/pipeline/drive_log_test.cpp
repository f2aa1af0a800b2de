#include "fovea/pipeline/drive_log.h"

#include <gtest/gtest.h>

namespace fovea::drive_log_test {

FrameRecord record_of(int index, int submap) {
  FrameRecord record;
  record.index = index;
  record.submap = submap;
  record.status = submap < 0 ? FrameStatus::kSkipped : FrameStatus::kMapped;
  record.T_odom_lidar = RigidMotion(Eigen::Translation3d(index, 0, 0));
  return record;
}

/// Submaps begin at frames 0 and 4 with right odometry.
TileMap map_of(double shift) {
  TileMap map;
  map.add_submap(RigidMotion(Eigen::Translation3d(0, 0, 0)));
  map.add_submap(RigidMotion(Eigen::Translation3d(4, shift, 0)));
  return map;
}

TEST(DriveLog, ReturnsEachRecordOnceWithItsSubmapsPose) {
  DriveLog log;
  EXPECT_FALSE(log.has_mapped());
  for (int i = 0; i < 6; ++i) log.add(record_of(i, i == 2 ? -1 : i / 4));
  EXPECT_TRUE(log.has_mapped());
  EXPECT_EQ(log.fresh(), 6u);
  const MapRows rows = log.rows(map_of(0.5), false);
  ASSERT_EQ(rows.frames.size(), 6u);
  EXPECT_TRUE(rows.poses.empty());
  EXPECT_EQ(rows.submaps.size(), 2u);
  for (const FrameRecord& record : rows.frames) {
    const Eigen::Vector3d expected(record.index, record.index < 4 ? 0 : 0.5, 0);
    EXPECT_LT((record.T_local_lidar.translation() - expected).norm(), 1e-12) << record.index;
  }
  EXPECT_EQ(log.fresh(), 0u);
  EXPECT_EQ(log.size(), 6u);
  const MapRows nothing = log.rows(map_of(0.5), true);
  EXPECT_TRUE(nothing.frames.empty() && nothing.poses.empty() && nothing.submaps.empty());
}

TEST(DriveLog, MovedPosesAreReturnedAgain) {
  DriveLog log;
  for (int i = 0; i < 6; ++i) log.add(record_of(i, i / 4));
  log.rows(map_of(0), false);
  EXPECT_TRUE(log.rows(map_of(1e-4), false).poses.empty());  // below the threshold
  const MapRows exact = log.rows(map_of(1e-4), true);
  EXPECT_EQ(exact.submaps.size(), 1u);
  ASSERT_EQ(exact.poses.size(), 2u);
  EXPECT_EQ(exact.poses[0].first, 4);
  EXPECT_EQ(exact.poses[0].second.translation().y(), 1e-4);
  const MapRows moved = log.rows(map_of(0.01), false);
  EXPECT_EQ(moved.poses.size(), 2u);
  EXPECT_EQ(moved.submaps.size(), 1u);
}

TEST(DriveLog, ASkippedFrameIsInterpolatedOrExtrapolated) {
  DriveLog log;
  for (int i = 0; i < 6; ++i) log.add(record_of(i, i == 0 || i == 2 || i == 5 ? -1 : 0));
  const MapRows rows = log.rows(map_of(0), true);
  for (const int skipped : {0, 2, 5}) {
    EXPECT_LT((rows.frames[std::size_t(skipped)].T_local_lidar.translation() -
               Eigen::Vector3d(skipped - 1, 0, 0))
                  .norm(),
              1e-12);
  }
  DriveLog one;
  one.add(record_of(7, 0));
  one.add(record_of(8, -1));
  const MapRows both = one.rows(map_of(0), true);
  EXPECT_EQ(both.frames[0].T_local_lidar.matrix(), both.frames[1].T_local_lidar.matrix());
}

TEST(DriveLog, ContinuesWithTheFramesOfAnEarlierRun) {
  DriveLog first, second;
  for (int i = 0; i < 4; ++i) first.add(record_of(i, 0));
  for (const FrameRecord& record : first.rows(map_of(0), true).frames) second.add_stored(record);
  EXPECT_EQ(second.fresh(), 0u);
  second.add(record_of(4, 1));
  const MapRows rows = second.rows(map_of(0.5), true);
  ASSERT_EQ(rows.frames.size(), 1u);
  EXPECT_TRUE(rows.poses.empty());
  EXPECT_EQ(rows.frames[0].T_local_lidar.translation(), Eigen::Vector3d(4, 0.5, 0));
}

}  // namespace fovea::drive_log_test
