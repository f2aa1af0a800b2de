// JPEG by libjpeg-turbo.
#pragma once

#include <cstdint>
#include <span>

#include "fovea/image.h"

namespace fovea {

/// Decodes a JPEG file in memory to 8-bit grey or RGB. std::runtime_error with the reason for
/// damage, truncation, colours that are neither (CMYK) or an absurd size.
Image decode_jpeg(std::span<const std::uint8_t> file);

}  // namespace fovea
