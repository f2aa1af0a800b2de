// The PNG files that cameras write, without libpng: 8 bits a sample, rows in order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "fovea/image.h"

namespace fovea {

/// No deflate stream grows more than this when unpacked: two bits stand for up to 258 bytes.
inline constexpr std::size_t kDeflateMaxRatio = 1032;

/// Decodes a PNG of 8-bit grey or RGB samples, with alpha (dropped) or without, that is not
/// interlaced. All checksums are checked.
/// @return empty for any other file, and for any fault, which is for libpng to name: what is given
///         back is what libpng would make of the file
std::optional<Image> decode_plain_png(std::span<const std::uint8_t> file);

}  // namespace fovea
