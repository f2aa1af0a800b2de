#include "fovea/evaluation/truth_poses.h"

#include <gtest/gtest.h>

#include <numbers>

#include "fovea/errors.h"
#include "fovea/evaluation/truth_test_scene.h"

namespace fovea::truth_poses_test {

constexpr double kDegree = std::numbers::pi / 180;

RigidMotion turned(double degrees, const Eigen::Vector3d& axis, const Eigen::Vector3d& shift) {
  RigidMotion T = RigidMotion::Identity();
  T.linear() = Eigen::AngleAxisd(degrees * kDegree, axis.normalized()).matrix();
  T.translation() = shift;
  return T;
}

/// A bend of 1 m steps, by the truth and by a map in a frame of its own.
std::vector<PosePair> bend(int frames, const RigidMotion& T_true_map) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < frames; ++i) {
    PosePair pair;
    pair.frame = i;
    pair.T_true_lidar = turned(3 * i, {0, 0, 1}, {1.0 * i, 0, 0.1 * i});
    pair.T_map_lidar = T_true_map.inverse() * pair.T_true_lidar;
    pairs.push_back(pair);
  }
  return pairs;
}

TEST(TruthPoses, AlignmentFindsTheMapsFrame) {
  const RigidMotion T_true_map = turned(70, {1, 2, 3}, {500, -20, 3});
  const std::vector<PosePair> pairs = bend(20, T_true_map);
  EXPECT_TRUE(align_trajectories(pairs).isApprox(T_true_map, 1e-9));
  EXPECT_LT(distribution(absolute_errors(pairs, align_trajectories(pairs)).position_m).max, 1e-9);
  EXPECT_LT(distribution(relative_errors(pairs).rotation_deg).max, 1e-5);
}

TEST(TruthPoses, AbsoluteErrorsAreThoseOfTheMapAsItLies) {
  const RigidMotion T_true_map = turned(2, {0, 0, 1}, {0.3, 0, 0.4});
  std::vector<PosePair> pairs = bend(5, RigidMotion::Identity());
  for (PosePair& pair : pairs) {
    pair.T_map_lidar.translation() += T_true_map.translation();
    pair.T_map_lidar.linear() = T_true_map.linear() * pair.T_map_lidar.linear();
  }
  const PoseErrors errors = absolute_errors(pairs, RigidMotion::Identity());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_NEAR(errors.position_m[i], 0.5, 1e-6);
    EXPECT_NEAR(errors.rotation_deg[i], 2, 1e-6);
  }
}

TEST(TruthPoses, OneFrameOffIsSharedOutByTheAlignment) {
  std::vector<PosePair> pairs = bend(10, RigidMotion::Identity());
  pairs[4].T_map_lidar.translation().y() += 0.1;
  const PoseErrors errors = absolute_errors(pairs, align_trajectories(pairs));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_NEAR(errors.position_m[i], i == 4 ? 0.09 : 0.01, 1e-6);
  }
  const PoseErrors relative = relative_errors(pairs);
  ASSERT_EQ(relative.position_m.size(), 9u);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_NEAR(relative.position_m[i], i == 3 || i == 4 ? 0.1 : 0, 1e-6);
  }
}

TEST(TruthPoses, NeighboursAreFramesThatFollowEachOther) {
  std::vector<PosePair> pairs = bend(6, RigidMotion::Identity());
  pairs.erase(pairs.begin() + 2);
  EXPECT_EQ(relative_errors(pairs).position_m.size(), 3u);
}

TEST(TruthPoses, DriftIsAShareOfTheWay) {
  std::vector<PosePair> pairs;
  for (int i = 0; i <= 15; ++i) {
    PosePair pair;
    pair.frame = i;
    pair.T_true_lidar.translation().x() = i;
    pair.T_map_lidar.translation().x() = 1.02 * i;  // a map 2 % too long
    pairs.push_back(pair);
  }
  const std::vector<float> percent = drift_percent(pairs, 10);
  ASSERT_EQ(percent.size(), 6u);
  for (const float p : percent) EXPECT_NEAR(p, 2, 1e-4);
  pairs.resize(8);
  EXPECT_TRUE(drift_percent(pairs, 10).empty());
}

TEST(TruthPoses, TheGeoreferenceTakesTheMapToTheTruth) {
  const GeodeticPoint truth{49.01, 8.43, 114.5};
  // The map's origin lies 100 m east and 50 m north of the truth's.
  const GeodeticPoint origin = LocalTangentPlane(truth).to_geodetic({100, 50, 2});
  const MapMeta meta{{"origin.latitude_deg", fmt::format("{}", origin.latitude)},
                     {"origin.longitude_deg", fmt::format("{}", origin.longitude)},
                     {"origin.height_m", fmt::format("{}", origin.altitude)}};
  const std::optional<RigidMotion> T_true_map = georeference(meta, truth);
  ASSERT_TRUE(T_true_map);
  EXPECT_TRUE(T_true_map->translation().isApprox(Eigen::Vector3d(100, 50, 2), 1e-8));
  EXPECT_LT(rotation_angle(T_true_map->linear()), 1e-4);
  EXPECT_FALSE(georeference({}, truth));
  EXPECT_FALSE(georeference({{"origin.latitude_deg", "north"}}, truth));
}

TEST(TruthPoses, PairsAreTheFramesThatBothKnow) {
  const TruthScene scene(4);
  const DriveTruth truth(scene.drive().info().path);
  std::vector<FrameRecord> records = wall_map({}, 6).frames;
  records[1].status = FrameStatus::kSkipped;
  const std::vector<PosePair> pairs = pose_pairs(records, truth);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[1].frame, 2);
  EXPECT_TRUE(pairs[1].T_true_lidar.isApprox(WallDrive::T_local_lidar(2)));
  records.erase(records.begin(), records.begin() + 4);
  EXPECT_THROW(pose_pairs(records, truth), InputError);
}

}  // namespace fovea::truth_poses_test
