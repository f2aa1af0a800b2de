#include "fovea/rendering/splat.h"

#include <gtest/gtest.h>

#include "fovea/rendering/wall_test_scene.h"

namespace fovea::splat_test {

SplatView draw(const ColoredPoints& map, const SplatOptions& options = {}) {
  const Camera camera = forward_camera();
  return splat(map, sample_spacing(map.position), camera, camera.T_cam_lidar, options);
}

Image wall_photograph() {
  const Camera camera = forward_camera();
  return WallScene::photograph(camera, camera.T_cam_lidar.inverse(), 3);
}

TEST(Splat, ReproducesThePictureOfATexturedPlane) {
  const SplatView view = draw(colored_points(WallScene::map(0.01)));
  const Image photograph = wall_photograph();
  double error = 0;
  for (int v = 0; v < 100; ++v) {
    for (int u = 0; u < 200; ++u) {
      ASSERT_EQ(view.covered[v * 200 + u], 1) << u << ", " << v;
      EXPECT_NEAR(view.depth[v * 200 + u], WallScene::kWall, 1e-4);
      for (int c = 0; c < 3; ++c) {
        error += std::abs(view.image.pixel(u, v)[c] - photograph.pixel(u, v)[c]);
      }
    }
  }
  // The nearest of samples 1 cm apart lies 3.8 mm off on average; the texture changes by some 400 a
  // m.
  EXPECT_LT(error / (3 * 200 * 100), 2.0);
}

TEST(Splat, DrawsCornersAtPixelCentres) {
  ColoredPoints map;
  map.position = {{10, float(99.5 / 15), float(49.5 / 15)}, {10, float(-99.5 / 15), 0}};
  map.color = {{1, 2, 3}, {4, 5, 6}};
  map.runs = make_runs(map.position, 10);
  const Camera camera = forward_camera();
  const SplatView view = splat(map, {0.001f, 0.001f}, camera, camera.T_cam_lidar);
  EXPECT_EQ(view.covered[0], 1);
  EXPECT_EQ(view.image.pixel(0, 0)[2], 3);
  EXPECT_EQ(std::count(view.covered.begin(), view.covered.end(), 1), 3);  // (199, 49.5): two
  EXPECT_EQ(view.image.pixel(199, 49)[0], 4);
}

TEST(Splat, ANearerSurfaceHidesWhatIsBehind) {
  PointCloud points = WallScene::map(0.02);
  PointCloud behind = points;
  for (Eigen::Vector3f& p : behind.position) p = p * 1.1f;
  for (LogColor& color : behind.color) color = {255, 0, 255};
  points.append(behind);
  const SplatView both = draw(colored_points(points));
  const SplatView front = draw(colored_points(WallScene::map(0.02)));
  EXPECT_EQ(both.image.data, front.image.data);
}

TEST(Splat, DepthLimitsAndEmptyMapsLeaveNothing) {
  SplatOptions options;
  options.max_depth = 7;
  for (const SplatView& view :
       {draw(colored_points(WallScene::map(0.1)), options), draw(ColoredPoints{})}) {
    EXPECT_EQ(std::count(view.covered.begin(), view.covered.end(), 1), 0);
    EXPECT_TRUE(std::isinf(view.depth[0]));
    EXPECT_EQ(view.image.pixel(5, 5)[0], 0);
  }
  EXPECT_THROW(
      splat(colored_points(WallScene::map(0.1)), {}, forward_camera(), RigidMotion::Identity()),
      std::invalid_argument);
}

}  // namespace fovea::splat_test
