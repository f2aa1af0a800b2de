#include "fovea/mapping/image_pyramid.h"

#include <gtest/gtest.h>

#include "fovea/core/random.h"

namespace fovea::image_pyramid_test {

template <class F>
Image painted(int width, int height, int channels, F&& value) {
  Image image(width, height, channels);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        image.pixel(x, y)[c] = static_cast<std::uint8_t>(value(x, y, c));
      }
    }
  }
  return image;
}

Image noise_image(int width, int height, int channels, std::uint64_t seed) {
  Random random(seed);
  return painted(width, height, channels, [&](int, int, int) { return random.below(256); });
}

Eigen::Vector3f color_at(const ImagePyramid& pyramid, double u, double v, float footprint) {
  const auto u_float = static_cast<float>(u), v_float = static_cast<float>(v);
  ColorBlock color;
  pyramid.colors_at({&u_float, 1}, {&v_float, 1}, {&footprint, 1}, color);
  return {color.red[0], color.green[0], color.blue[0]};
}

TEST(ImagePyramid, AConstantImageIsConstant) {
  const ImagePyramid pyramid(painted(37, 21, 3, [](int, int, int c) { return 40 + 70 * c; }));
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3f color = color_at(pyramid, random.uniform(0, 36), random.uniform(0, 20),
                                           static_cast<float>(random.uniform(0, 100)));
    ASSERT_LT((color - Eigen::Vector3f(40, 110, 180)).norm(), 1e-3f);
  }
}

// Half a pixel of shift between levels would be 2^level / 2 pixels here: 8 gray values at 16.
TEST(ImagePyramid, ARampHasItsValueAtEveryFootprint) {
  const ImagePyramid pyramid(painted(200, 120, 3, [](int x, int y, int c) {
    return c == 0 ? x : c == 1 ? y : x / 2 + y;
  }));
  Random random(2);
  for (int i = 0; i < 5000; ++i) {
    const double u = random.uniform(32, 150), v = random.uniform(32, 80);
    const auto footprint = static_cast<float>(random.uniform(0.5, 32));
    const Eigen::Vector3f color = color_at(pyramid, u, v, footprint);
    // 2 x 2 means are rounded: halves up, at most half a gray value a level.
    ASSERT_NEAR(color.x(), u, 2.6) << footprint;
    ASSERT_NEAR(color.y(), v, 2.6) << footprint;
  }
}

TEST(ImagePyramid, RampsAreExactWhereNothingIsRounded) {
  const ImagePyramid pyramid(painted(60, 60, 1, [](int x, int y, int) { return 2 * (x + y); }));
  for (const float footprint : {1.f, 1.3f, 2.f}) {
    for (const double u : {10.0, 10.5, 23.25}) {
      ASSERT_NEAR(color_at(pyramid, u, 20.75, footprint).x(), 2 * (u + 20.75), 1e-4) << footprint;
    }
  }
}

TEST(ImagePyramid, ACheckerboardIsGrayFromTwoPixelsOn) {
  const ImagePyramid pyramid(
      painted(64, 48, 3, [](int x, int y, int) { return (x + y) % 2 == 0 ? 0 : 200; }));
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const double u = random.uniform(0, 63), v = random.uniform(0, 47);
    const auto footprint = static_cast<float>(random.uniform(2, 60));
    ASSERT_NEAR(color_at(pyramid, u, v, footprint).x(), 100, 1e-3);
  }
  EXPECT_NEAR(color_at(pyramid, 10, 10, 1.f).x(), 0, 1e-3);
  const float between = color_at(pyramid, 10, 10, 1.4f).x();
  EXPECT_GT(between, 30);
  EXPECT_LT(between, 70);
}

TEST(ImagePyramid, ASmallFootprintIsBilinear) {
  const Image image = noise_image(31, 17, 3, 4);
  const ImagePyramid pyramid(image);
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const double u = random.uniform(0, 30), v = random.uniform(0, 16);
    const auto footprint = static_cast<float>(random.uniform(0, 1));
    ASSERT_LT((color_at(pyramid, u, v, footprint) - bilinear(image, u, v)).norm(), 1e-3f);
  }
}

// At the center of a coarse pixel: the mean of its pixels, up to the rounding of the levels.
TEST(ImagePyramid, ACoarsePixelIsTheMeanOfItsPixels) {
  const Image image = noise_image(96, 64, 1, 6);
  const ImagePyramid pyramid(image);
  for (const int edge : {2, 4, 8, 16}) {
    for (int y = 0; y + edge <= 64; y += edge) {
      for (int x = 0; x + edge <= 96; x += edge) {
        double mean = 0;
        for (int j = 0; j < edge; ++j) {
          for (int i = 0; i < edge; ++i) mean += image.pixel(x + i, y + j)[0];
        }
        mean /= edge * edge;
        const double center = (edge - 1) / 2.0;
        ASSERT_NEAR(color_at(pyramid, x + center, y + center, float(edge)).x(), mean, 1.5) << edge;
      }
    }
  }
}

TEST(ImagePyramid, IsContinuousInTheFootprint) {
  const ImagePyramid pyramid(noise_image(64, 64, 3, 7));
  for (const float footprint : {1.f, 2.f, 4.f, 8.f, 16.f, 32.f}) {
    const Eigen::Vector3f below = color_at(pyramid, 30.3, 28.9, footprint * 0.9999f);
    const Eigen::Vector3f above = color_at(pyramid, 30.3, 28.9, footprint * 1.0001f);
    EXPECT_LT((below - above).norm(), 0.1f) << footprint;
  }
}

TEST(ImagePyramid, ABlockHasTheColorsOfEachAlone) {
  const ImagePyramid pyramid(noise_image(57, 43, 3, 9));
  Random random(10);
  for (const std::size_t count : {std::size_t{0}, std::size_t{3}, ColorBlock::kSize}) {
    std::vector<float> u(count), v(count), footprint(count);
    for (std::size_t i = 0; i < count; ++i) {
      u[i] = static_cast<float>(random.uniform(0, 56));
      v[i] = static_cast<float>(random.uniform(0, 42));
      footprint[i] = static_cast<float>(random.uniform(0, 50));
    }
    ColorBlock colors;
    pyramid.colors_at(u, v, footprint, colors);
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3f together(colors.red[i], colors.green[i], colors.blue[i]);
      ASSERT_LT((together - color_at(pyramid, u[i], v[i], footprint[i])).norm(), 1e-3f);
    }
  }
}

TEST(ImagePyramid, OddAndTinyImagesWork) {
  for (const int channels : {1, 3}) {
    for (const auto& [width, height] :
         {std::pair(1, 1), {2, 1}, {1, 9}, {3, 3}, {5, 4}, {33, 65}, {1242, 2}}) {
      const ImagePyramid pyramid(noise_image(width, height, channels, 8));
      for (const float footprint : {0.f, 1.f, 1.5f, 2.f, 7.f, 1000.f}) {
        for (const double u : {0.0, (width - 1) / 2.0, width - 1.0}) {
          for (const double v : {0.0, height - 1.0}) {
            const Eigen::Vector3f color = color_at(pyramid, u, v, footprint);
            ASSERT_GE(color.minCoeff(), 0);
            ASSERT_LE(color.maxCoeff(), 255.001f);
            if (channels == 1) {
              ASSERT_EQ(color.x(), color.y());
              ASSERT_EQ(color.x(), color.z());
            }
          }
        }
      }
    }
  }
}

}  // namespace fovea::image_pyramid_test
