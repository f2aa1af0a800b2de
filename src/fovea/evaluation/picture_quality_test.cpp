#include "fovea/evaluation/picture_quality.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/evaluation/test_scene.h"

namespace fovea::picture_quality_test {

Image wall_photograph() {
  const Camera camera = forward_camera();
  return WallScene::photograph(camera, camera.T_cam_lidar.inverse(), 3);
}

SplatView drawn(Image image) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  return {std::move(image), std::vector<float>(pixels, 5), std::vector<std::uint8_t>(pixels, 1)};
}

TEST(PictureQuality, OfTheSamePicture) {
  const PictureSums sums = compare_pictures(drawn(wall_photograph()), wall_photograph());
  EXPECT_TRUE(std::isinf(sums.psnr_all()));
  EXPECT_NEAR(sums.mean_ssim_all(), 1, 1e-6);
  EXPECT_NEAR(sums.mean_ssim_covered(), 1, 1e-6);
  EXPECT_EQ(sums.share_covered(), 1);
}

TEST(PictureQuality, OfEvenPictures) {
  // Two even greys: variances 0, so SSIM = (2 a b + C1) / (a^2 + b^2 + C1), also at the border.
  Image a(30, 20, 3), b(30, 20, 3);
  std::fill(a.data.begin(), a.data.end(), std::uint8_t{100});
  std::fill(b.data.begin(), b.data.end(), std::uint8_t{110});
  const PictureSums sums = compare_pictures(drawn(a), b);
  EXPECT_NEAR(sums.psnr_all(), 10 * std::log10(255.0 * 255 / 100), 1e-9);
  const double c1 = 2.55 * 2.55;
  EXPECT_NEAR(sums.mean_ssim_all(), (22000 + c1) / (22100 + c1), 1e-4);
}

TEST(PictureQuality, WhatIsNotCoveredIsBlackInAllAndAbsentInCovered) {
  const Image photograph = wall_photograph();
  SplatView half = drawn(photograph);
  for (int y = 0; y < photograph.height; ++y) {
    for (int x = 0; x < 100; ++x) {
      half.covered[static_cast<std::size_t>(y) * photograph.width + x] = 0;
      std::fill_n(half.image.pixel(x, y), 3, std::uint8_t{0});
    }
  }
  const PictureSums sums = compare_pictures(half, photograph);
  EXPECT_EQ(sums.share_covered(), 0.5);
  EXPECT_TRUE(std::isinf(sums.psnr_covered()));
  EXPECT_NEAR(sums.mean_ssim_covered(), 1, 1e-6);
  EXPECT_LT(sums.psnr_all(), 10);
  EXPECT_NEAR(sums.mean_ssim_all(), 0.5, 0.05);
}

TEST(PictureQuality, OfNothing) {
  SplatView nothing = drawn(Image(30, 20, 3));
  std::fill(nothing.covered.begin(), nothing.covered.end(), std::uint8_t{0});
  EXPECT_TRUE(std::isnan(compare_pictures(nothing, Image(30, 20, 1)).psnr_covered()));
  EXPECT_EQ(compare_shifts(nothing, Image(30, 20, 1)).best(), Eigen::Vector2i(0, 0));
}

TEST(TextureShift, IsFound) {
  const Image photograph = wall_photograph();
  Image shifted(photograph.width, photograph.height, 3);
  for (int y = 0; y < photograph.height; ++y) {
    for (int x = 0; x < photograph.width; ++x) {
      const int from_x = std::min(x + 5, photograph.width - 1), from_y = std::max(y - 2, 0);
      std::copy_n(photograph.pixel(from_x, from_y), 3, shifted.pixel(x, y));
    }
  }
  EXPECT_EQ(compare_shifts(drawn(shifted), photograph).best(), Eigen::Vector2i(5, -2));
  EXPECT_EQ(compare_shifts(drawn(photograph), photograph).best(), Eigen::Vector2i(0, 0));
}

}  // namespace fovea::picture_quality_test
