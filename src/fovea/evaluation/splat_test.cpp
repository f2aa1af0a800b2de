#include "fovea/evaluation/splat.h"

#include <gtest/gtest.h>

#include "fovea/evaluation/sharpness.h"
#include "fovea/evaluation/test_scene.h"

namespace fovea::splat_test {

SplatView draw(const ColouredPoints& map, const SplatOptions& options = {}) {
  const Camera camera = forward_camera();
  return splat(map, sample_spacing(map.position), camera, camera.T_cam_lidar, options);
}

Image wall_photograph() {
  const Camera camera = forward_camera();
  return WallScene::photograph(camera, camera.T_cam_lidar.inverse(), 3);
}

/// Mean of each pixel and its neighbours within `radius`.
Image blurred(const Image& image, int radius) {
  Image out = image;
  for (int v = radius; v < image.height - radius; ++v) {
    for (int u = radius; u < image.width - radius; ++u) {
      for (int c = 0; c < image.channels; ++c) {
        int sum = 0;
        for (int dv = -radius; dv <= radius; ++dv) {
          for (int du = -radius; du <= radius; ++du) sum += image.pixel(u + du, v + dv)[c];
        }
        out.pixel(u, v)[c] = static_cast<std::uint8_t>(sum / ((2 * radius + 1) * (2 * radius + 1)));
      }
    }
  }
  return out;
}

TEST(Splat, ReproducesThePictureOfATexturedPlane) {
  const SplatView view = draw(coloured_points(WallScene::map(0.01)));
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
  ColouredPoints map;
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
  for (Rgb& color : behind.color) color = {255, 0, 255};
  points.append(behind);
  const SplatView both = draw(coloured_points(points));
  const SplatView front = draw(coloured_points(WallScene::map(0.02)));
  EXPECT_EQ(both.image.data, front.image.data);
}

TEST(Splat, DepthLimitsAndEmptyMapsLeaveNothing) {
  SplatOptions options;
  options.max_depth = 7;
  for (const SplatView& view :
       {draw(coloured_points(WallScene::map(0.1)), options), draw(ColouredPoints{})}) {
    EXPECT_EQ(std::count(view.covered.begin(), view.covered.end(), 1), 0);
    EXPECT_TRUE(std::isinf(view.depth[0]));
    EXPECT_EQ(view.image.pixel(5, 5)[0], 0);
  }
  EXPECT_THROW(
      splat(coloured_points(WallScene::map(0.1)), {}, forward_camera(), RigidMotion::Identity()),
      std::invalid_argument);
}

TEST(Sharpness, OfAFaithfulMapIsOneAndFallsWithBlur) {
  const Image photograph = wall_photograph();
  SplatView view = draw(coloured_points(WallScene::map(0.01)));
  const double faithful = compare_gradients(view, photograph).sharpness();
  EXPECT_NEAR(faithful, 1, 0.1);
  view.image = blurred(view.image, 1);
  const double soft = compare_gradients(view, photograph).sharpness();
  EXPECT_LT(soft, faithful - 0.03);
  view.image = blurred(view.image, 4);
  EXPECT_LT(compare_gradients(view, photograph).sharpness(), soft - 0.2);
}

TEST(Sharpness, OfTheSamePictureIsExactlyOne) {
  SplatView view = draw(coloured_points(WallScene::map(0.05)));
  const GradientSums sums = compare_gradients(view, view.image);
  EXPECT_EQ(sums.sharpness(), 1);
  EXPECT_EQ(sums.pixels, 199u * 99u);
}

TEST(Sharpness, LeavesOutHolesAndOutlines) {
  SplatView view = draw(coloured_points(WallScene::map(0.02)));
  const Image photograph = wall_photograph();
  const std::size_t all = compare_gradients(view, photograph).pixels;
  view.covered[50 * 200 + 100] = 0;  // counts neither itself nor for its left and upper neighbours
  EXPECT_EQ(compare_gradients(view, photograph).pixels, all - 3);
  view.depth[20 * 200 + 20] = 5;
  EXPECT_EQ(compare_gradients(view, photograph).pixels, all - 6);
  std::fill(view.covered.begin(), view.covered.end(), std::uint8_t{0});
  EXPECT_TRUE(std::isnan(compare_gradients(view, photograph).sharpness()));
  EXPECT_THROW(compare_gradients(view, Image(3, 3, 3)), std::invalid_argument);
}

}  // namespace fovea::splat_test
