#include "fovea/pipeline/replaced_points.h"

#include <gtest/gtest.h>

#include "../../../tests/sample_map.h"
#include "fovea/pipeline/visible_map_test_support.h"

namespace fovea::replaced_points_test {

constexpr double kSpacing = 0.02, kTile = 4;

PointCloud points_of_level(const std::vector<Eigen::Vector3f>& positions, int level) {
  PointCloud points = one_point_each(positions);
  points.sampling_level.assign(points.size(), static_cast<std::uint8_t>(level));
  return points;
}

/// With as many frames as it takes for all tiles to have their turn.
std::size_t remove_replaced(TileMap& map) {
  Occupancy occupancy(kTile, kSpacing);
  DynamicPointFilter filter(DynamicPointOptions{});
  std::size_t removed = 0;
  for (int frame = 0; frame < 8; ++frame) {
    occupancy.follow(map, {0, 0, 0}, 100);
    removed += remove_replaced_points(map, occupancy, visible_map_test::test_camera(),
                                      RigidMotion::Identity(), 60, frame, filter);
  }
  return removed;
}

TEST(ReplacedPoints, AFinerPointReplacesTheCoarseOneOfItsCellAlone) {
  const float cell = float(kTile / 192);
  TileMap map(kTile);
  map.add_submap(RigidMotion::Identity());
  // Level 2: cells of 4 x 4 x 4 of the finest.
  map.add(points_of_level({{0.5f * cell, 0.5f * cell, 20}, {4.5f * cell, 0.5f * cell, 20}}, 2));
  map.add(points_of_level({{3.5f * cell, 3.5f * cell, 20.01f}}, 0));
  EXPECT_EQ(remove_replaced(map), 1u);
  EXPECT_EQ(map.size(), 2u);
  EXPECT_EQ(remove_replaced(map), 0u);
}

TEST(ReplacedPoints, PointsOfOneLevelStay) {
  TileMap map(kTile);
  map.add_submap(RigidMotion::Identity());
  for (int level = 0; level < kSamplingLevels; ++level) {
    map.add(
        points_of_level({{float(level) + 0.31f, 0, 20}, {float(level) + 0.312f, 0, 20}}, level));
  }
  EXPECT_EQ(remove_replaced(map), 0u);
}

// The finer point comes to a later submap, whose grid is turned against that of the coarse one.
TEST(ReplacedPoints, APointOfALaterSubmapReplacesTheCoarseOneOfAnEarlier) {
  TileMap map(kTile);
  map.add_submap(RigidMotion::Identity());
  map.add(points_of_level({{0, 0, 20}, {1, 0, 20}}, 3));
  map.add_submap(RigidMotion(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ())));
  map.add(points_of_level({{0, 0, 20}}, 1));
  EXPECT_EQ(remove_replaced(map), 1u);
  EXPECT_EQ(map.size(), 2u);
}

TEST(ReplacedPoints, PointsOutOfViewStay) {
  TileMap map(kTile);
  map.add_submap(RigidMotion::Identity());
  map.add(points_of_level({{0, 0, -20}}, 2));
  map.add(points_of_level({{0, 0, -20}}, 0));
  EXPECT_EQ(remove_replaced(map), 0u);
}

}  // namespace fovea::replaced_points_test
