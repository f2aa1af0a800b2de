#include "fovea/mapping/calibration/gray_plane.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/core/random.h"

namespace fovea::gray_plane_test {

GrayPlane random_plane(int width, int height) {
  Random random(1);
  GrayPlane plane{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    plane.values.push_back(static_cast<float>(random.uniform(0, 255)));
  }
  return plane;
}

/// A plane that is 1 in one pixel.
GrayPlane impulse(int size) {
  GrayPlane plane{size, size, std::vector<float>(std::size_t(size * size), 0.0f)};
  plane.values[std::size_t(size / 2 * size + size / 2)] = 1;
  return plane;
}

/// Standard deviation along x of an impulse's response.
double spread_of(const GrayPlane& plane) {
  double sum = 0, square = 0;
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) {
      sum += double(plane.at(x, y));
      square += double(plane.at(x, y)) * std::pow(x - plane.width / 2, 2);
    }
  }
  return std::sqrt(square / sum);
}

TEST(GrayPlane, IsTheBrightness) {
  Image gray(3, 2, 1), rgb(3, 2, 3);
  for (std::size_t i = 0; i < gray.data.size(); ++i) {
    gray.data[i] = static_cast<std::uint8_t>(40 * i);
    rgb.data[3 * i] = 100, rgb.data[3 * i + 1] = static_cast<std::uint8_t>(40 * i);
  }
  const GrayPlane of_gray = gray_plane(gray), of_rgb = gray_plane(rgb);
  EXPECT_EQ(of_gray.width, 3);
  EXPECT_EQ(of_gray.height, 2);
  EXPECT_EQ(of_gray.at(2, 1), 200);
  EXPECT_EQ(of_gray.at(1, 0), 40);
  EXPECT_NEAR(of_rgb.at(2, 1), 0.299 * 100 + 0.587 * 200, 1e-4);
}

TEST(GrayPlane, OfBlocksIsTheirMean) {
  Image image(7, 5, 1);  // the last column and row fill no block
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<std::uint8_t>(i);
  const GrayPlane plane = gray_plane(image, 2);
  ASSERT_EQ(plane.width, 3);
  ASSERT_EQ(plane.height, 2);
  EXPECT_EQ(plane.values.size(), 6u);
  EXPECT_EQ(plane.at(0, 0), (0 + 1 + 7 + 8) / 4.0f);
  EXPECT_EQ(plane.at(2, 1), (18 + 19 + 25 + 26) / 4.0f);
}

TEST(GrayPlane, BoxBlurIsTheMeanOfTheNeighborhood) {
  const GrayPlane plane = random_plane(11, 7);
  for (const int radius : {1, 2, 9}) {  // 9: beyond the plane
    const GrayPlane blurred = box_blurred(plane, radius);
    ASSERT_EQ(blurred.width, plane.width);
    ASSERT_EQ(blurred.height, plane.height);
    for (int y = 0; y < plane.height; ++y) {
      for (int x = 0; x < plane.width; ++x) {
        double sum = 0;
        for (int dy = -radius; dy <= radius; ++dy) {
          for (int dx = -radius; dx <= radius; ++dx) {
            sum += double(plane.at(std::clamp(x + dx, 0, plane.width - 1),
                                   std::clamp(y + dy, 0, plane.height - 1)));
          }
        }
        EXPECT_NEAR(blurred.at(x, y), sum / std::pow(2 * radius + 1, 2), 1e-3);
      }
    }
  }
}

TEST(GrayPlane, BoxBlurOfNoRadiusChangesNothing) {
  const GrayPlane plane = random_plane(4, 3);
  EXPECT_EQ(box_blurred(plane, 0).values, plane.values);
}

TEST(GrayPlane, SmoothingHasItsStandardDeviation) {
  for (const double sigma : {1.5, 2.0, 3.0, 6.0, 12.0}) {
    const GrayPlane plane = smoothed(impulse(121), sigma);
    EXPECT_NEAR(spread_of(plane), sigma, 0.7) << sigma;  // the boxes are of whole pixels
    double sum = 0;
    for (const float value : plane.values) sum += double(value);
    EXPECT_NEAR(sum, 1, 1e-3);
  }
  // The least is that of two boxes of three pixels.
  EXPECT_NEAR(spread_of(smoothed(impulse(9), 0.1)), std::sqrt(4.0 / 3), 1e-3);
}

TEST(GrayPlane, SmoothingIsSymmetric) {
  const GrayPlane plane = smoothed(impulse(41), 4);
  for (int k = 1; k < 20; ++k) {
    EXPECT_NEAR(plane.at(20 + k, 20), plane.at(20 - k, 20), 1e-6);
    EXPECT_NEAR(plane.at(20 + k, 20), plane.at(20, 20 + k), 1e-6);
    EXPECT_LE(plane.at(20 + k, 20), plane.at(20 + k - 1, 20) + 1e-6f);
  }
}

TEST(GrayPlane, SmoothingKeepsAConstant) {
  const GrayPlane plane{5, 4, std::vector<float>(20, 77.0f)};
  for (const float value : smoothed(plane, 3).values) EXPECT_NEAR(value, 77, 1e-4);
}

}  // namespace fovea::gray_plane_test
