#include "fovea/mapping/projected_block.h"

#include <gtest/gtest.h>

#include "fovea/core/random.h"

namespace fovea::projected_block_test {

Camera test_camera() { return {0, 640, 200, 350, 360, 310, 94, RigidMotion::Identity()}; }

TEST(ProjectedBlock, ProjectsAsTheCameraDoes) {
  const Camera camera = test_camera();
  const RigidMotion T_cam_b = exp_se3((Twist() << 0.3, -0.5, 0.2, 1, -2, 3).finished());
  Random random(1);
  ProjectedBlock block(camera);
  std::size_t in_view = 0;
  for (const std::size_t size : {std::size_t{1}, std::size_t{7}, ProjectedBlock::kSize}) {
    for (int trial = 0; trial < 20; ++trial) {
      std::vector<Eigen::Vector3f> points_b(size);
      for (Eigen::Vector3f& p : points_b) {
        p = Eigen::Vector3d(random.uniform(-9, 9), random.uniform(-3, 3), random.uniform(-9, 9))
                .cast<float>();
      }
      block.project(points_b, T_cam_b.linear().cast<float>(), T_cam_b.translation().cast<float>());
      for (std::size_t i = 0; i < size; ++i) {
        const Eigen::Vector3d p_cam = T_cam_b * points_b[i].cast<double>();
        ASSERT_LT((block.p_cam(i).cast<double>() - p_cam).norm(), 1e-5);
        ASSERT_EQ(block.depth(i), block.p_cam(i).z());
        const std::optional<Eigen::Vector2d> pixel = camera.project(p_cam);
        ASSERT_EQ(block.in_view(i), pixel && camera.in_view(*pixel)) << p_cam.transpose();
        if (!block.in_view(i)) continue;
        ++in_view;
        ASSERT_LT((block.pixel(i).cast<double>() - *pixel).norm(), 0.01);
      }
    }
  }
  EXPECT_GT(in_view, 300u);
}

TEST(ProjectedBlock, PointsBehindAndNonFinitePointsAreNotInView) {
  ProjectedBlock block(test_camera());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<Eigen::Vector3f> points = {{0, 0, -5},  {0, 0, 0},   {0, 0, 0.05f},
                                               {nan, 0, 5}, {0, 0, nan}, {0, 0, 5}};
  block.project(points, Eigen::Matrix3f::Identity(), Eigen::Vector3f::Zero());
  for (std::size_t i = 0; i + 1 < points.size(); ++i) EXPECT_FALSE(block.in_view(i)) << i;
  EXPECT_TRUE(block.in_view(points.size() - 1));
}

}  // namespace fovea::projected_block_test
