// The 12-bit logarithmic color code of a map file (docs/map-format.md).
#pragma once

#include <array>
#include <cstdint>

namespace fovea {

/// Codes of one octave, i.e. one stop; one step is 0.27 %.
inline constexpr int kColorCodesPerStop = 256;
/// The code of the value 1, in 8-bit gray values of the reference exposure.
inline constexpr int kColorCodeOfOne = 1024;
/// Codes are 0 (black) to 4095. They span 4 stops below 1 and 4 stops above 255.
inline constexpr int kMaxColorCode = 4095;

/// The code nearest to a value: 0 for a value of 0 or less, else 1024 + 256 log2(value), rounded
/// and clamped to 1..4095.
std::uint16_t color_code(double value);
/// The value of a code: 0, or 2^((code - 1024) / 256).
double color_value(std::uint16_t code);

/// The codes of the values 0 to 255. nearest_byte() inverts them exactly.
const std::array<std::uint16_t, 256>& codes_of_bytes();
/// The 8-bit value nearest to a code's value; 255 for all values above 255. Larger numbers than
/// 4095 count as 4095.
std::uint8_t nearest_byte(std::uint16_t code);

}  // namespace fovea
