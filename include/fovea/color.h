// The color of a map point: logarithms, so that a change of exposure adds the same to each color.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "fovea/image.h"

namespace fovea {

/// Codes of one octave, i.e. one stop; one step is 0.27 %.
inline constexpr int kColorCodesPerStop = 256;
/// The code of the value 1, in 8-bit gray values of the reference exposure.
inline constexpr int kColorCodeOfOne = 1024;
/// Codes are 0 (black) to 4095. They span 4 stops below 1 and 4 stops above 255.
inline constexpr int kMaxColorCode = 4095;

/// The code nearest to a value: 0 for a value of 0 or less, else 1024 + 256 log2(value), rounded
/// and clamped to 1..4095.
FOVEA_API std::uint16_t color_code(double value);
/// The value of a code: 0, or 2^((code - 1024) / 256).
FOVEA_API double color_value(std::uint16_t code);

/// The codes of the values 0 to 255. nearest_byte() inverts them exactly.
FOVEA_API const std::array<std::uint16_t, 256>& codes_of_bytes();
/// The 8-bit value nearest to a code's value; 255 for all values above 255. Larger numbers than
/// 4095 count as 4095.
FOVEA_API std::uint8_t nearest_byte(std::uint16_t code);

/// Base-2 logarithms of the gains of red, green and blue: image = map * 2^gain.
using LogGain = Eigen::Array3f;

/// A color as the file of a map stores it (docs/map-format.md): a code for each channel.
struct FOVEA_API LogColor {
  std::array<std::uint16_t, 3> code{};  ///< red, green, blue

  LogColor() = default;
  /// Of 8-bit values, each of which has a code of its own.
  LogColor(std::uint8_t red, std::uint8_t green, std::uint8_t blue)
      : code{codes_of_bytes()[red], codes_of_bytes()[green], codes_of_bytes()[blue]} {}
  LogColor(Rgb color) : LogColor(color.r, color.g, color.b) {}  // implicit: loses nothing
  static LogColor of_codes(std::uint16_t red, std::uint16_t green, std::uint16_t blue) {
    LogColor color;
    color.code = {red, green, blue};
    return color;
  }

  friend bool operator==(const LogColor&, const LogColor&) = default;
};

/// The nearest 8-bit color; values above 255 become 255.
inline Rgb to_rgb(LogColor color) {
  return {nearest_byte(color.code[0]), nearest_byte(color.code[1]), nearest_byte(color.code[2])};
}
/// The codes as numbers.
inline Eigen::Array3f codes_of(LogColor color) {
  return {float(color.code[0]), float(color.code[1]), float(color.code[2])};
}
/// Values of the reference exposure, 0 to 4,085; exact for 8-bit values.
FOVEA_API Eigen::Vector3f to_float(LogColor color);
/// The color under another exposure: its codes plus an offset, clamped. Black stays black.
FOVEA_API LogColor with_offset(LogColor color, const Eigen::Array3f& codes);

}  // namespace fovea
