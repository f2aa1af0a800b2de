// PNG by libpng.
#pragma once

#include <cstdint>
#include <span>

#include "fovea/base/image.h"

namespace fovea {

/// Decodes a PNG file in memory to 8-bit grey or RGB; palettes are resolved, alpha is dropped.
/// std::runtime_error with the reason for damage, truncation, 16-bit samples or an absurd size.
Image decode_png(std::span<const std::uint8_t> file);

}  // namespace fovea
