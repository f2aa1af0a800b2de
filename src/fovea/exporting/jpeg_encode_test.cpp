#include "fovea/exporting/jpeg_encode.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/drive/images/jpeg_decode.h"

namespace fovea::jpeg_encode_test {

Image picture(int width, int height, int channels) {
  Image image(width, height, channels);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (int c = 0; c < channels; ++c) {
        image.pixel(x, y)[c] =
            static_cast<std::uint8_t>(128 + 100 * std::sin(0.1 * x + c) * std::cos(0.07 * y));
      }
    }
  }
  return image;
}

double mean_difference(const Image& a, const Image& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) sum += std::abs(a.data[i] - b.data[i]);
  return sum / static_cast<double>(a.data.size());
}

TEST(EncodeJpeg, ReadsBackNearlyTheSame) {
  for (const int channels : {1, 3}) {
    const Image image = picture(75, 41, channels);
    const Image read = decode_jpeg(encode_jpeg(image, 90));
    ASSERT_EQ(read.width, 75);
    ASSERT_EQ(read.height, 41);
    ASSERT_EQ(read.channels, channels);
    EXPECT_LT(mean_difference(image, read), 2);
  }
}

// Half the colour resolution (4:2:0) would paint each of these columns in its neighbour's colour.
TEST(EncodeJpeg, KeepsColoursOfSinglePixels) {
  Image image(32, 32, 3);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) image.pixel(x, y)[x % 2 == 0 ? 0 : 2] = 200;
  }
  EXPECT_LT(mean_difference(image, decode_jpeg(encode_jpeg(image, 95))), 8);
}

TEST(EncodeJpeg, QualityBuysBytes) {
  const Image image = picture(200, 100, 3);
  EXPECT_LT(encode_jpeg(image, 30).size(), encode_jpeg(image, 95).size());
  EXPECT_EQ(encode_jpeg(image, 80), encode_jpeg(image, 80));
}

TEST(EncodeJpeg, RefusesNonsense) {
  EXPECT_THROW(encode_jpeg(Image(), 80), std::invalid_argument);
  EXPECT_THROW(encode_jpeg(picture(4, 4, 1), 0), std::invalid_argument);
  EXPECT_THROW(encode_jpeg(picture(4, 4, 1), 101), std::invalid_argument);
}

}  // namespace fovea::jpeg_encode_test
