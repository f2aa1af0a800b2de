#include "fovea/core/stable_order.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace fovea::stable_order_test {

struct Pose {
  int key = 0, number = 0;
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();  // aligned to 32 bytes with AVX
};

TEST(StableOrder, EqualValuesKeepTheirOrder) {
  std::vector<Pose> poses;
  for (int i = 0; i < 99; ++i) poses.push_back({i % 3, i, i * Eigen::Matrix4d::Identity()});
  sort_stably(poses, [](const Pose& a, const Pose& b) { return a.key < b.key; });
  for (int i = 0; i < 99; ++i) {
    const Pose& pose = poses[static_cast<std::size_t>(i)];
    EXPECT_EQ(pose.key, i / 33);
    EXPECT_EQ(pose.number, 3 * (i % 33) + i / 33);
    EXPECT_EQ(pose.matrix, pose.number * Eigen::Matrix4d::Identity());
  }
}

TEST(StableOrder, NothingAndOneValueStay) {
  std::vector<int> none, one{7};
  sort_stably(none, std::less());
  sort_stably(one, std::less());
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(one, std::vector{7});
}

}  // namespace fovea::stable_order_test
