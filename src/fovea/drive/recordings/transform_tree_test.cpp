#include "fovea/drive/recordings/transform_tree.h"

#include <gtest/gtest.h>

namespace fovea::transform_tree_test {

QuaternionMotion some_motion(double seed) {
  return exp_se3((Twist() << 0.3 * seed, -0.2, 0.1, seed, 2, -0.5 * seed).finished());
}

bool same(const QuaternionMotion& a, const QuaternionMotion& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
}

TransformTree vehicle() {
  TransformTree tree;
  tree.add("base_link", "lidar", 0, some_motion(1), true);
  tree.add("base_link", "mast", 0, some_motion(2), true);
  tree.add("mast", "camera", 0, some_motion(3), true);
  return tree;
}

TEST(TransformTree, ChainsWhatIsFixedAndKeepsANumberThatStandsAlone) {
  const TransformTree tree = vehicle();
  EXPECT_TRUE(same(*tree.fixed("base_link", "lidar"), some_motion(1)));
  EXPECT_TRUE(same(*tree.fixed("lidar", "lidar"), QuaternionMotion()));
  EXPECT_TRUE(tree.fixed("lidar", "camera")
                  ->matrix()
                  .isApprox(some_motion(1).matrix().inverse() * some_motion(2).matrix() *
                                some_motion(3).matrix(),
                            1e-12));
  EXPECT_TRUE(
      tree.fixed("camera", "mast")->matrix().isApprox(some_motion(3).matrix().inverse(), 1e-12));
  EXPECT_FALSE(tree.fixed("lidar", "nowhere"));
  EXPECT_FALSE(tree.fixed("nowhere", "lidar"));
}

TEST(TransformTree, TellsWhatMoves) {
  TransformTree tree = vehicle();
  EXPECT_FALSE(tree.moving("lidar", "camera"));
  tree.add("mast", "camera", 1, some_motion(3), false);
  tree.add("mast", "camera", 2, some_motion(3), false);  // told often, and still
  EXPECT_FALSE(tree.moving("lidar", "camera"));
  tree.add("mast", "camera", 3, some_motion(3.01), false);
  EXPECT_EQ(tree.moving("lidar", "camera"), "camera");
  EXPECT_EQ(tree.moving("camera", "lidar"), "camera");
  EXPECT_FALSE(tree.moving("lidar", "base_link"));
}

TEST(TransformTree, ACourseHasTheNumbersOfItsOneMovingFrame) {
  TransformTree tree = vehicle();
  EXPECT_FALSE(tree.world_of("base_link"));
  for (int i = 0; i < 5; ++i) tree.add("odom", "base_link", 10 * i, some_motion(i), false);
  EXPECT_EQ(tree.world_of("base_link"), "odom");
  const auto course = tree.course("odom", "base_link");
  ASSERT_EQ(course.size(), 5u);
  EXPECT_EQ(course[3].time, 30);
  EXPECT_TRUE(same(course[3].T_a_b, some_motion(3)));
  EXPECT_TRUE(tree.course("lidar", "base_link").empty());
}

TEST(TransformTree, AWorldThatIsCorrectedNowAndThenIsInterpolated) {
  TransformTree tree = vehicle();
  for (int i = 0; i < 5; ++i) tree.add("odom", "base_link", 10 * i, some_motion(i), false);
  const QuaternionMotion still({1, 0, 0}, Eigen::Quaterniond::Identity());
  const QuaternionMotion later({3, 0, 0}, Eigen::Quaterniond::Identity());
  tree.add("map", "odom", 10, still, false);
  tree.add("map", "odom", 30, later, false);
  EXPECT_EQ(tree.world_of("base_link"), "map");
  const auto course = tree.course("map", "lidar");  // fixed to the body
  ASSERT_EQ(course.size(), 5u);
  const std::array<double, 5> x = {1, 1, 2, 3, 3};  // held before and after
  for (std::size_t i = 0; i < 5; ++i) {
    const RigidMotion expected = Eigen::Translation3d(x[i], 0, 0) *
                                 some_motion(double(i)).matrix() * some_motion(1).matrix();
    EXPECT_TRUE(course[i].T_a_b.matrix().isApprox(expected, 1e-12)) << i;
  }
}

TEST(TransformTree, OfSeveralParentsTheMostFrequentCounts) {
  TransformTree tree = vehicle();
  EXPECT_TRUE(tree.ambiguous().empty());
  for (int i = 0; i < 5; ++i) {
    tree.add("odom", "base_link", 10 * i, some_motion(i), false);
    if (i % 2 == 0) tree.add("wheels", "base_link", 10 * i, some_motion(-i), false);
  }
  EXPECT_EQ(tree.ambiguous(), std::vector<std::string>{"base_link"});
  EXPECT_EQ(tree.course("odom", "base_link").size(), 5u);
  EXPECT_EQ(tree.world_of("base_link"), "odom");
}

TEST(TransformTree, ForgetsAllButTheLatest) {
  TransformTree tree = vehicle();
  for (int i = 0; i < 5; ++i) tree.add("odom", "base_link", 10 * i, some_motion(i), false);
  tree.forget_past();
  EXPECT_TRUE(same(*tree.fixed("base_link", "lidar"), some_motion(1)));
  EXPECT_TRUE(same(*tree.fixed("odom", "base_link"), some_motion(4)));
  EXPECT_TRUE(tree.course("odom", "base_link").empty());
  tree.add("odom", "base_link", 50, some_motion(5), false);
  EXPECT_EQ(tree.course("odom", "base_link").size(), 2u);
}

TEST(TransformTree, ARingOfFramesEnds) {
  TransformTree tree;
  tree.add("a", "b", 0, some_motion(1), true);
  tree.add("b", "a", 0, some_motion(2), true);
  tree.add("c", "c", 0, some_motion(3), true);
  EXPECT_TRUE(tree.fixed("a", "b"));
  EXPECT_FALSE(tree.fixed("a", "c"));
  EXPECT_FALSE(tree.world_of("c"));
}

}  // namespace fovea::transform_tree_test
