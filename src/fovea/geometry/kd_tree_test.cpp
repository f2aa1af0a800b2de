#include "fovea/geometry/kd_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "fovea/core/random.h"

namespace fovea::kd_tree_test {

std::vector<Eigen::Vector3f> random_points(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector3f> points(count);
  for (Eigen::Vector3f& p : points) {
    for (float& value : p) value = static_cast<float>(random.uniform(-10, 10));
  }
  return points;
}

class KdTreeOfLeafSize : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(, KdTreeOfLeafSize,
                         testing::Values(KdTree::kLeafSize, KdTree::kLargeLeafSize));

TEST_P(KdTreeOfLeafSize, FindsWhatATestOfAllPointsFinds) {
  const auto points = random_points(3000, 1);
  const KdTree tree(points, GetParam());
  std::vector<KdTree::Neighbor> found;
  for (const Eigen::Vector3f& query : random_points(200, 2)) {
    std::vector<std::pair<float, std::uint32_t>> all;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      all.emplace_back((points[i] - query).squaredNorm(), i);
    }
    std::sort(all.begin(), all.end());
    const KdTree::Neighbor nearest = tree.nearest(query);
    EXPECT_EQ(nearest.index, all[0].second);
    EXPECT_FLOAT_EQ(nearest.squared_distance, all[0].first);
    tree.nearest_k(query, 12, found);
    ASSERT_EQ(found.size(), 12u);
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_EQ(found[k].index, all[k].second);
  }
}

TEST(KdTree, NothingBeyondTheLimit) {
  const std::vector<Eigen::Vector3f> points{{1, 0, 0}, {5, 0, 0}};
  const KdTree tree(points);
  EXPECT_EQ(tree.nearest({0, 0, 0}, 1.5f).index, 0u);
  EXPECT_EQ(tree.nearest({0, 0, 0}, 1.0f).squared_distance, 1.0f);  // the limit itself is within
  EXPECT_TRUE(std::isinf(tree.nearest({0, 0, 0}, 0.99f).squared_distance));
}

TEST(KdTree, OfEquallyNearPointsTheFirst) {
  // 1000 copies fill many leaves; the lowest index must not depend on where the tree split them.
  std::vector<Eigen::Vector3f> points(1000, {1, 2, 3});
  points[0] = {9, 9, 9};
  const KdTree tree(points);
  EXPECT_EQ(tree.nearest({1, 2, 4}).index, 1u);
  EXPECT_EQ(tree.nearest({1, 2, 3}).index, 1u);
}

TEST(KdTree, NearestUnmarkedIsTheNearestInATreeWithoutTheMarkedPoints) {
  const auto points = random_points(3000, 3);
  std::vector<std::uint8_t> marks;
  std::vector<Eigen::Vector3f> others;
  for (std::size_t i = 0; i < points.size(); ++i) {
    marks.push_back(i % 3 != 1);
    if (marks.back() == 0) others.push_back(points[i]);
  }
  const KdTree tree(points), tree_of_others(others);
  for (const Eigen::Vector3f& query : random_points(200, 4)) {
    const KdTree::Neighbor found = tree.nearest_unmarked(query, marks);
    const KdTree::Neighbor expected = tree_of_others.nearest(query);
    EXPECT_EQ(found.squared_distance, expected.squared_distance);
    EXPECT_EQ(points[found.index], others[expected.index]);
  }
  const std::vector<std::uint8_t> all(points.size(), 1);
  EXPECT_TRUE(std::isinf(tree.nearest_unmarked({0, 0, 0}, all).squared_distance));
}

TEST(KdTree, SmallAndEmptyInputs) {
  std::vector<KdTree::Neighbor> found(3);
  const KdTree empty(std::span<const Eigen::Vector3f>{});
  EXPECT_TRUE(std::isinf(empty.nearest({0, 0, 0}).squared_distance));
  empty.nearest_k({0, 0, 0}, 5, found);
  EXPECT_TRUE(found.empty());

  const std::vector<Eigen::Vector3f> two{{1, 0, 0}, {3, 0, 0}};
  KdTree tree(two);
  tree.nearest_k({0, 0, 0}, 5, found);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1].squared_distance, 9.0f);
  tree.nearest_k({0, 0, 0}, 0, found);
  EXPECT_TRUE(found.empty());
  const KdTree moved = std::move(tree);
  EXPECT_EQ(moved.nearest({4, 0, 0}).index, 1u);
}

}  // namespace fovea::kd_tree_test
