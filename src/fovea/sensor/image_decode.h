// Images from files, PNG or JPEG.
#pragma once

#include <filesystem>

#include "fovea/base/image.h"

namespace fovea {

/// Largest width or height that is believed (pixels). A damaged header must not ask for gigabytes.
inline constexpr unsigned kMaxImageSide = 8'192;

/// Reads an 8-bit grey or RGB image; PNG and JPEG are told apart by their content, not by the name.
/// InputError with the file's name if it is neither, damaged, truncated, of 16 bits or absurdly
/// large.
Image read_image(const std::filesystem::path& file);

}  // namespace fovea
