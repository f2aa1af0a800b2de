#include <algorithm>
#include <cmath>

#include "fovea/color.h"

namespace fovea {
namespace {

std::array<std::uint16_t, 256> make_codes_of_bytes() {
  std::array<std::uint16_t, 256> codes;
  for (std::size_t value = 0; value < codes.size(); ++value) {
    codes[value] = color_code(double(value));
  }
  return codes;
}

std::array<std::uint8_t, kMaxColorCode + 1> make_bytes_of_codes() {
  std::array<std::uint8_t, kMaxColorCode + 1> bytes;
  for (std::size_t code = 0; code < bytes.size(); ++code) {
    const double value = color_value(static_cast<std::uint16_t>(code));
    bytes[code] = static_cast<std::uint8_t>(std::lround(std::min(value, 255.0)));
  }
  return bytes;
}

std::array<float, kMaxColorCode + 1> make_values_of_codes() {
  std::array<float, kMaxColorCode + 1> values;
  for (std::size_t code = 0; code < values.size(); ++code) {
    values[code] = static_cast<float>(color_value(static_cast<std::uint16_t>(code)));
  }
  for (std::size_t byte = 0; byte < 256; ++byte) values[codes_of_bytes()[byte]] = float(byte);
  return values;
}

}  // namespace

std::uint16_t color_code(double value) {
  if (!(value > 0)) return 0;
  const double code = kColorCodeOfOne + kColorCodesPerStop * std::log2(value);
  return static_cast<std::uint16_t>(
      std::lround(std::clamp(code, 1.0, static_cast<double>(kMaxColorCode))));
}

double color_value(std::uint16_t code) {
  if (code == 0) return 0;
  return std::exp2(double(code - kColorCodeOfOne) / kColorCodesPerStop);
}

const std::array<std::uint16_t, 256>& codes_of_bytes() {
  static const std::array<std::uint16_t, 256> codes = make_codes_of_bytes();
  return codes;
}

std::uint8_t nearest_byte(std::uint16_t code) {
  static const std::array<std::uint8_t, kMaxColorCode + 1> bytes = make_bytes_of_codes();
  return bytes[std::min<std::size_t>(code, kMaxColorCode)];
}

Eigen::Vector3f to_float(LogColor color) {
  static const std::array<float, kMaxColorCode + 1> values = make_values_of_codes();
  const auto value_of = [](std::uint16_t code) {
    return values[std::min<std::size_t>(code, kMaxColorCode)];
  };
  return {value_of(color.code[0]), value_of(color.code[1]), value_of(color.code[2])};
}

LogColor with_offset(LogColor color, const Eigen::Array3f& codes) {
  for (int c = 0; c < 3; ++c) {
    std::uint16_t& code = color.code[std::size_t(c)];
    if (code == 0) continue;
    const float shifted = std::clamp(float(code) + codes[c], 1.0f, float(kMaxColorCode));
    code = static_cast<std::uint16_t>(std::lround(shifted));
  }
  return color;
}

}  // namespace fovea
