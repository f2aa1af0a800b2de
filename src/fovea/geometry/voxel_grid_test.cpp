#include "fovea/geometry/voxel_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <tuple>

#include "fovea/core/random.h"

namespace fovea::voxel_grid_test {

using Voxel = std::tuple<int, int, int>;
Voxel voxel_of(const Eigen::Vector3f& p, float size) {
  return {static_cast<int>(std::floor(p.x() / size)), static_cast<int>(std::floor(p.y() / size)),
          static_cast<int>(std::floor(p.z() / size))};
}

TEST(VoxelGrid, KeepsThePointNearestToTheMean) {
  const std::vector<Eigen::Vector3f> points{
      {0.1f, 0.5f, 0.5f},
      {0.9f, 0.5f, 0.5f},
      {0.6f, 0.5f, 0.5f},   // mean x = 0.53
      {-0.1f, 0.5f, 0.5f},  // the voxel on the other side of 0
      {1.5f, 0.5f, 0.5f}};
  EXPECT_EQ(voxel_sample(points, 1), (std::vector<std::uint32_t>{2, 3, 4}));
}

TEST(VoxelGrid, OnePointAVoxelAndNoneLost) {
  constexpr float kSize = 0.5f;
  Random random(3);
  std::vector<Eigen::Vector3f> points(20'000);
  for (Eigen::Vector3f& p : points) {
    for (float& value : p) value = static_cast<float>(random.uniform(-4, 4));
  }
  std::set<Voxel> occupied, kept;
  for (const auto& p : points) occupied.insert(voxel_of(p, kSize));
  const auto chosen = voxel_sample(points, kSize);
  for (const std::uint32_t i : chosen) {
    EXPECT_TRUE(kept.insert(voxel_of(points[i], kSize)).second);
  }
  EXPECT_EQ(kept, occupied);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
}

TEST(VoxelGrid, DuplicatesGiveTheFirst) {
  const std::vector<Eigen::Vector3f> points(10, {3.3f, 3.3f, 3.3f});
  EXPECT_EQ(voxel_sample(points, 0.1f), (std::vector<std::uint32_t>{0}));
}

TEST(VoxelGrid, EmptyInputAndBadSize) {
  EXPECT_TRUE(voxel_sample({}, 1).empty());
  const std::vector<Eigen::Vector3f> points(1, {0, 0, 0});
  EXPECT_THROW(voxel_sample(points, 0), std::invalid_argument);
  EXPECT_THROW(voxel_sample(points, std::nanf("")), std::invalid_argument);
}

}  // namespace fovea::voxel_grid_test
