#include "fovea/evaluation/scan_matching.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../../tests/synthetic_drive.h"

namespace fovea::scan_matching_test {

/// What a map of the drive knows of its frames, every pose off by `error` (m, sideways) times its
/// index.
ScoredMap map_with_poses(const SyntheticDrive& drive, double error) {
  ScoredMap map;
  for (std::size_t i = 0; i < drive.T_local_lidar.size(); ++i) {
    FrameRecord record;
    record.index = static_cast<int>(i);
    record.T_local_lidar = drive.T_local_lidar[i];
    record.T_local_lidar.translation().y() += error * static_cast<double>(i);
    map.frames.push_back(record);
  }
  return map;
}

TEST(ScanMatching, WallsLieOnEachOtherUnderTruePosesAndApartByTheErrorOfAPose) {
  const SyntheticDrive drive(street_scene(), 3, 0.0);  // stands still: the same points every time
  SyntheticDrive still = drive;
  for (RigidMotion& T : still.T_local_lidar) T = RigidMotion::Identity();
  const ScanMatching exact = scan_matching(map_with_poses(still, 0), still);
  EXPECT_EQ(exact.pairs, 2u);
  EXPECT_GT(exact.points, 1000u);
  EXPECT_LT(exact.mean, 1e-5);
  // Every point is 5 cm from where it was, and no farther from its nearest neighbour.
  const ScanMatching off = scan_matching(map_with_poses(still, 0.05), still);
  EXPECT_GT(off.mean, 0.02);
  EXPECT_LT(off.mean, 0.0501);
}

TEST(ScanMatching, HeldOutFramesTakeNoPart) {
  const SyntheticDrive drive(street_scene(), 3, 0.5);
  ScoredMap map = map_with_poses(drive, 0);
  map.frames[1].status = FrameStatus::kHeldOut;
  EXPECT_EQ(scan_matching(map, drive).pairs, 1u);
}

TEST(ScanMatching, OfNothingThereIsNone) {
  const SyntheticDrive drive(street_scene(), 1, 0.5);
  const ScanMatching none = scan_matching(map_with_poses(drive, 0), drive);
  EXPECT_EQ(none.pairs, 0u);
  EXPECT_TRUE(std::isnan(none.mean));
}

TEST(MatchScans, MeanDistanceOfPairsUnderAMetre) {
  const std::vector<Eigen::Vector3f> target{{0, 0, 0}, {10, 0, 0}};
  const std::vector<Eigen::Vector3f> source{{0, 0, 0}, {10, 0.1f, 0}, {5, 0, 0}};
  const RigidMotion T_target_source(Eigen::Translation3d(0, 0.3, 0));
  const ScanMatching matching = match_scans(source, target, T_target_source);
  EXPECT_EQ(matching.points, 2u);
  EXPECT_NEAR(matching.mean, 0.35, 1e-6);
  EXPECT_TRUE(std::isnan(match_scans(source, {}, T_target_source).mean));
}

}  // namespace fovea::scan_matching_test
