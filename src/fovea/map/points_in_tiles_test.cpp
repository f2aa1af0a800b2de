#include "fovea/map/points_in_tiles.h"

#include <gtest/gtest.h>

#include <limits>

#include "fovea/core/random.h"

namespace fovea::points_in_tiles_test {

constexpr double kTile = 4;

RigidMotion some_pose() {
  RigidMotion T = RigidMotion::Identity();
  T.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 3).normalized()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(1000, -2000, 5);
  return T;
}

/// Points that follow each other in a tile for a while, through more than one chunk.
std::vector<Eigen::Vector3f> points_along_a_way() {
  Random random(7);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 20000; ++i) {
    const auto along = static_cast<float>(i) * 0.01f;
    points.emplace_back(along - 100 + float(random.uniform(-0.1, 0.1)),
                        float(random.uniform(-0.1, 0.1)), 0.01f * along);
  }
  return points;
}

TEST(PointsInTiles, EachIsInItsTileWithinHalfAStep) {
  const RigidMotion T = some_pose();
  const std::vector<Eigen::Vector3f> points = points_along_a_way();
  const PointsInTiles placed = points_in_tiles(points, T, kTile);
  std::vector<int> times(points.size(), 0);
  for (const auto& [key, ranges] : placed.ranges) {
    std::uint32_t last_end = 0;
    for (const auto& [begin, end] : ranges) {
      ASSERT_LT(begin, end);
      EXPECT_TRUE(begin > last_end || begin == 0);  // or the two would be one
      last_end = end;
      for (std::uint32_t i = begin; i < end; ++i) {
        ++times[i];
        const Eigen::Vector3d p_submap = T * points[i].cast<double>();
        const Eigen::Array3d in_tile =
            p_submap.array() - Eigen::Array3d(key.x, key.y, key.z) * kTile;
        EXPECT_TRUE((in_tile >= -1e-9).all() && (in_tile <= kTile + 1e-9).all());
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_NEAR(placed.position[axis][i] * double(kPositionStep), in_tile[Eigen::Index(axis)],
                      double(kPositionStep) * 0.5001);
        }
      }
    }
  }
  EXPECT_EQ(times, std::vector<int>(points.size(), 1));
}

TEST(PointsInTiles, RunsThatChunksCutAreOne) {
  const std::vector<Eigen::Vector3f> points(20000, Eigen::Vector3f(1, 2, 3));
  const PointsInTiles placed = points_in_tiles(points, RigidMotion::Identity(), kTile);
  ASSERT_EQ(placed.ranges.size(), 1u);
  const std::vector<TilePoints::Range>& ranges = placed.ranges.at({0, 0, 0});
  ASSERT_EQ(ranges.size(), 1u);
  EXPECT_EQ(ranges[0].begin, 0u);
  EXPECT_EQ(ranges[0].end, points.size());
}

TEST(PointsInTiles, APointOnAnEdgeIsInTheTileThatBeginsThere) {
  const std::vector<Eigen::Vector3f> points{{4, 0, -4}, {-0.0f, -8, 7.9999f}};
  const PointsInTiles placed = points_in_tiles(points, RigidMotion::Identity(), kTile);
  EXPECT_TRUE(placed.ranges.contains({1, 0, -1}));
  EXPECT_TRUE(placed.ranges.contains({0, -2, 1}));
  EXPECT_EQ(placed.position[2], (std::vector<std::uint16_t>{0, 4000}));
  EXPECT_TRUE(points_in_tiles({}, RigidMotion::Identity(), kTile).ranges.empty());
}

TEST(PointsInTiles, RefusesWhatNoKeyCanSay) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), kInfinity, -kInfinity, 1e12f}) {
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<Eigen::Vector3f> points(300, Eigen::Vector3f(1, 2, 3));
      points[299][axis] = bad;
      EXPECT_THROW(points_in_tiles(points, RigidMotion::Identity(), kTile), std::invalid_argument)
          << bad << " along axis " << axis;
    }
  }
}

}  // namespace fovea::points_in_tiles_test
