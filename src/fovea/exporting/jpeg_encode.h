// Images as JPEG files' bytes.
#pragma once

#include <cstdint>
#include <vector>

#include "fovea/image.h"

namespace fovea {

/// 8-bit grey or RGB, colours at full resolution. The same bytes for the same image.
/// std::invalid_argument for an empty image or a quality outside 1-100.
std::vector<std::uint8_t> encode_jpeg(const Image& image, int quality);

}  // namespace fovea
