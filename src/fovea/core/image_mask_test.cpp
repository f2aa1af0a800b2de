#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/random.h"
#include "fovea/image.h"

namespace fovea::image_mask_test {

TEST(ImageMask, EqualsASearchThroughThePixels) {
  Random random(4);
  Image picture(23, 17, 3);
  for (std::uint8_t& value : picture.data) value = random.below(40) == 0 ? 127 : 128;
  const ImageMask mask(picture);
  for (int trial = 0; trial < 2000; ++trial) {
    const auto u = float(random.uniform(-4, 27)), v = float(random.uniform(-4, 21));
    const auto half = float(random.uniform(0, 5));
    bool expected = false;
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < picture.width; ++x) {
        const bool is_inside =
            std::abs(float(x) - u) <= half + 0.5f && std::abs(float(y) - v) <= half + 0.5f;
        for (int c = 0; c < 3; ++c) expected |= is_inside && picture.pixel(x, y)[c] < 128;
      }
    }
    ASSERT_EQ(mask.covers(u, v, half), expected) << u << " " << v << " " << half;
  }
}

TEST(ImageMask, AMaskWithoutDarkPixelsCoversNothing) {
  Image white(8, 8, 1);
  std::fill(white.data.begin(), white.data.end(), std::uint8_t{255});
  EXPECT_FALSE(ImageMask(white).covers(4, 4, 100));
  Image one = white;
  one.data[9] = 0;
  EXPECT_TRUE(ImageMask(one).covers(1, 1, 0));
  EXPECT_FALSE(ImageMask(one).covers(3, 1, 1));
  EXPECT_NE(ImageMask(one).fingerprint(), ImageMask(white).fingerprint());
}

}  // namespace fovea::image_mask_test
