// Images as PNG files' bytes.
#pragma once

#include <cstdint>
#include <vector>

#include "fovea/image.h"

namespace fovea {

/// 8-bit grey or RGB; fast rather than small. std::invalid_argument for an empty image.
std::vector<std::uint8_t> encode_png(const Image& image);

/// 16-bit grey, row by row. std::invalid_argument if there are not width * height values.
std::vector<std::uint8_t> encode_png_16(int width, int height,
                                        const std::vector<std::uint16_t>& values);

}  // namespace fovea
