// PNG: what cameras write by a decoder of our own, everything else by libpng.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fovea/image.h"

namespace fovea {

/// Decodes a PNG file in memory to 8-bit grey or RGB; palettes are resolved, alpha is dropped.
/// std::runtime_error with the reason for damage, truncation, 16-bit samples or an absurd size.
Image decode_png(std::span<const std::uint8_t> file);

/// The same by libpng alone, which takes half as long again: what decode_png is measured against.
Image decode_png_by_libpng(std::span<const std::uint8_t> file);

/// 16-bit grey samples, rows from the top.
struct Samples16 {
  int width = 0, height = 0;
  std::vector<std::uint16_t> data;  // height * width
};
/// Decodes a PNG file of one 16-bit channel, its samples exactly as they are stored.
/// std::runtime_error as decode_png, and for any other kind of PNG.
Samples16 decode_png_16(std::span<const std::uint8_t> file);

}  // namespace fovea
