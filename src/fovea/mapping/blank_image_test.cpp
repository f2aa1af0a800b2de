#include "fovea/mapping/blank_image.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fovea::blank_image_test {

Image filled(std::uint8_t value, int channels = 3, int width = 160, int height = 80) {
  Image image(width, height, channels);
  std::fill(image.data.begin(), image.data.end(), value);
  return image;
}

/// Sets the top share of the image to a value.
Image with_rows(Image image, double share, std::uint8_t value) {
  std::fill_n(image.data.begin(), static_cast<std::ptrdiff_t>(share * double(image.data.size())),
              value);
  return image;
}

TEST(BlankImage, BlackAndWhiteOnesAreBlank) {
  for (const int channels : {1, 3}) {
    EXPECT_TRUE(is_blank(filled(0, channels)));
    EXPECT_TRUE(is_blank(filled(5, channels)));
    EXPECT_TRUE(is_blank(filled(255, channels)));
    EXPECT_FALSE(is_blank(filled(30, channels)));
    EXPECT_FALSE(is_blank(filled(240, channels)));
  }
}

TEST(BlankImage, AnImageWithATenthOfAStreetIsNot) {
  EXPECT_FALSE(is_blank(with_rows(filled(0), 0.1, 90)));
  EXPECT_FALSE(is_blank(with_rows(filled(255), 0.1, 90)));
  EXPECT_FALSE(is_blank(with_rows(filled(0), 0.5, 255)));  // half black, half white: a pattern
}

TEST(BlankImage, SaturatedColorsAreNot) {
  Image red = filled(0);
  for (std::size_t i = 0; i < red.data.size(); i += 3) red.data[i] = 255;
  EXPECT_FALSE(is_blank(red));
}

TEST(BlankImage, SmallImagesAreLookedAt) {
  EXPECT_TRUE(is_blank(filled(0, 1, 1, 1)));
  EXPECT_FALSE(is_blank(filled(100, 1, 3, 2)));
}

}  // namespace fovea::blank_image_test
