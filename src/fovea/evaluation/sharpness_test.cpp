#include "fovea/evaluation/sharpness.h"

#include <gtest/gtest.h>

#include "fovea/rendering/wall_test_scene.h"

namespace fovea::sharpness_test {

SplatView draw(const ColoredPoints& map) {
  const Camera camera = forward_camera();
  return splat(map, sample_spacing(map.position), camera, camera.T_cam_lidar);
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

TEST(Sharpness, OfAFaithfulMapIsOneAndFallsWithBlur) {
  const Image photograph = wall_photograph();
  SplatView view = draw(colored_points(WallScene::map(0.01)));
  const double faithful = compare_gradients(view, photograph).sharpness();
  EXPECT_NEAR(faithful, 1, 0.1);
  view.image = blurred(view.image, 1);
  const double soft = compare_gradients(view, photograph).sharpness();
  EXPECT_LT(soft, faithful - 0.03);
  view.image = blurred(view.image, 4);
  EXPECT_LT(compare_gradients(view, photograph).sharpness(), soft - 0.2);
}

TEST(Sharpness, OfTheSamePictureIsExactlyOne) {
  SplatView view = draw(colored_points(WallScene::map(0.05)));
  const GradientSums sums = compare_gradients(view, view.image);
  EXPECT_EQ(sums.sharpness(), 1);
  EXPECT_EQ(sums.pixels, 199u * 99u);
}

TEST(Sharpness, LeavesOutHolesAndOutlines) {
  SplatView view = draw(colored_points(WallScene::map(0.02)));
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

}  // namespace fovea::sharpness_test
