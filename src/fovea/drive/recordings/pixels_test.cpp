#include "fovea/drive/recordings/pixels.h"

#include <gtest/gtest.h>

#include "fovea/errors.h"

namespace fovea::pixels_test {

ros::ImageMessage message_of(std::string_view encoding, std::uint32_t width, std::uint32_t height,
                             std::uint32_t step, const std::string& data) {
  ros::ImageMessage message;
  message.encoding = encoding;
  message.width = width, message.height = height, message.step = step;
  message.data = data;
  return message;
}

Rgb color_at(const Image& image, int x, int y) {
  const std::uint8_t* p = image.pixel(x, y);
  return {p[0], p[1], p[2]};
}

TEST(Pixels, ChannelsComeInTheirOrderWithoutPadding) {
  const std::string data = "rgbRGB..abcABC";  // the last row without its padding
  const Image rgb = image_of(message_of("rgb8", 2, 2, 8, data), "t");
  EXPECT_EQ(color_at(rgb, 1, 0), (Rgb{'R', 'G', 'B'}));
  EXPECT_EQ(color_at(rgb, 1, 1), (Rgb{'A', 'B', 'C'}));
  const Image bgr = image_of(message_of("bgr8", 2, 2, 8, data), "t");
  EXPECT_EQ(color_at(bgr, 0, 1), (Rgb{'c', 'b', 'a'}));
  const Image bgra = image_of(message_of("bgra8", 1, 2, 5, "bgra.BGRA"), "t");
  EXPECT_EQ(color_at(bgra, 0, 1), (Rgb{'R', 'G', 'B'}));
  const Image grey = image_of(message_of("mono8", 3, 1, 3, "xyz"), "t");
  EXPECT_EQ(grey.channels, 1);
  EXPECT_EQ(*grey.pixel(2, 0), 'z');
}

TEST(Pixels, EveryBayerPatternOfAPlainColourIsThatColour) {
  const Rgb color{200, 100, 50};
  for (const std::string pattern : {"rggb", "bggr", "gbrg", "grbg"}) {
    std::string data;
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 6; ++x) {
        const char c = pattern[std::size_t(2 * (y % 2) + x % 2)];
        data += char(c == 'r' ? color.r : c == 'g' ? color.g : color.b);
      }
    }
    const Image image = image_of(message_of("bayer_" + pattern + "8", 6, 5, 6, data), "t");
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 6; ++x) EXPECT_EQ(color_at(image, x, y), color) << pattern << x << y;
    }
  }
}

TEST(Pixels, ABayerRampIsInterpolatedBetweenItsSamples) {
  std::string data;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) data += char(10 * x + 20 * y);
  }
  const Image image = image_of(message_of("bayer_rggb8", 6, 4, 6, data), "t");
  for (int y = 1; y < 3; ++y) {
    for (int x = 1; x < 5; ++x) {
      const auto value = std::uint8_t(10 * x + 20 * y);
      EXPECT_EQ(color_at(image, x, y), (Rgb{value, value, value}));
    }
  }
}

TEST(Pixels, YuvIsThatOfBt601) {
  // Red of full saturation: Y 81, U 90, V 240; white and black: Y 235 and 16 without colour.
  const std::string red = "\x5a\x51\xf0\x51", grey = "\x80\xeb\x80\x10";
  const Image image = image_of(message_of("yuv422", 2, 2, 4, red + grey), "t");
  EXPECT_NEAR(color_at(image, 0, 0).r, 254, 2);
  EXPECT_NEAR(color_at(image, 1, 0).g, 0, 2);
  EXPECT_NEAR(color_at(image, 1, 0).b, 0, 2);
  EXPECT_EQ(color_at(image, 0, 1), (Rgb{255, 255, 255}));
  EXPECT_EQ(color_at(image, 1, 1), (Rgb{0, 0, 0}));
  const Image yuyv = image_of(message_of("yuv422_yuy2", 2, 1, 4, "\x51\x5a\x51\xf0"), "t");
  EXPECT_EQ(color_at(yuyv, 0, 0), color_at(image, 0, 0));
}

TEST(Pixels, RefusesWhatItDoesNotKnowAndWhatIsTooShort) {
  EXPECT_FALSE(is_known_encoding("32FC1"));
  EXPECT_THROW(image_of(message_of("16UC1", 1, 1, 2, "ab"), "t"), InputError);
  EXPECT_THROW(image_of(message_of("rgb8", 2, 2, 6, "12345678901"), "t"), InputError);
  EXPECT_THROW(image_of(message_of("rgb8", 2, 2, 5, "123456789012"), "t"), InputError);
  EXPECT_THROW(image_of(message_of("mono8", 0, 1, 1, "1"), "t"), InputError);
  EXPECT_THROW(image_of(message_of("mono8", 100'000, 1, 100'000, "1"), "t"), InputError);
  EXPECT_THROW(image_of(message_of("mono8", 1, 0xffffffff, 0xffffffff, "1"), "t"), InputError);
}

}  // namespace fovea::pixels_test
