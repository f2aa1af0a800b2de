#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fovea/color.h"

namespace fovea::log_color_test {

TEST(ColorCode, EveryByteSurvives) {
  for (int value = 0; value < 256; ++value) {
    const std::uint16_t code = codes_of_bytes()[std::size_t(value)];
    EXPECT_EQ(code, color_code(value)) << value;
    EXPECT_EQ(nearest_byte(code), value);
    if (value > 0) {
      EXPECT_GT(code, codes_of_bytes()[std::size_t(value - 1)]) << value;
    }
  }
}

TEST(ColorCode, IsAsThePageOfTheFormatStates) {
  EXPECT_EQ(color_code(0), 0);
  EXPECT_EQ(color_code(1), 1024);
  EXPECT_EQ(color_code(2), 1280);
  EXPECT_EQ(color_code(128), 1024 + 7 * 256);
  EXPECT_EQ(color_code(255), 3071);
  EXPECT_EQ(color_value(1280), 2);
  EXPECT_EQ(color_value(0), 0);
  // 4 stops above 255 and 4 stops below 1.
  EXPECT_GT(color_value(kMaxColorCode), 15.9 * 255);
  EXPECT_LT(color_value(1), 1.01 / 16);
}

TEST(ColorCode, StepsAreEqualRatios) {
  const double ratio = std::exp2(1.0 / 256);
  for (std::uint16_t code = 1; code <= kMaxColorCode; ++code) {
    EXPECT_EQ(color_code(color_value(code)), code);
    if (code > 1) {
      EXPECT_NEAR(color_value(code) / color_value(std::uint16_t(code - 1)), ratio, 1e-12);
    }
  }
}

TEST(ColorCode, ClampsWhatIsOutOfRange) {
  EXPECT_EQ(color_code(-1), 0);
  EXPECT_EQ(color_code(std::nan("")), 0);
  EXPECT_EQ(color_code(1e-9), 1);
  EXPECT_EQ(color_code(1e9), kMaxColorCode);
  EXPECT_EQ(color_code(std::numeric_limits<double>::infinity()), kMaxColorCode);
  EXPECT_EQ(nearest_byte(color_code(300)), 255);
  EXPECT_EQ(nearest_byte(65535), 255);
  EXPECT_EQ(nearest_byte(color_code(0.4)), 0);
}

TEST(LogColor, OfBytesIsExact) {
  for (int value = 0; value < 256; ++value) {
    const auto byte = static_cast<std::uint8_t>(value);
    const LogColor color(byte, 255, 0);
    EXPECT_EQ(to_rgb(color), (Rgb{byte, 255, 0}));
    EXPECT_EQ(to_float(color), Eigen::Vector3f(float(value), 255, 0));
  }
}

TEST(LogColor, OfOtherValuesIsWithinHalfAStep) {
  const LogColor color = LogColor::of_codes(color_code(1000), color_code(300.5), color_code(1e9));
  EXPECT_NEAR(to_float(color).x(), 1000, 1.4);
  EXPECT_NEAR(to_float(color).y(), 300.5, 0.42);
  EXPECT_NEAR(to_float(color).z(), 4084.9, 0.1);
  EXPECT_EQ(to_rgb(color), (Rgb{255, 255, 255}));
}

}  // namespace fovea::log_color_test
