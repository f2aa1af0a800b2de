// Text and bytes as they may stand in a page that is well-formed as XML too.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/image.h"

namespace fovea::app {

/// Text for contents and attributes: markup escaped, bytes that are no UTF-8 and control characters
/// replaced by U+FFFD (file names have any encoding).
std::string escaped(std::string_view text);

/// A number for people: `digits` significant ones; "none" where there is no value.
std::string number(double value, int digits = 4);

/// A count with thousands apart: "1 234 567" (with narrow no-break spaces).
std::string count(std::size_t value);

std::string base64(const std::vector<std::uint8_t>& bytes);

/// "data:image/jpeg;base64,...". Pictures wider than kMaxPictureWidth are made smaller.
inline constexpr int kMaxPictureWidth = 1280;
std::string jpeg_uri(const Image& image, int quality);
/// "data:image/png;base64,...": for drawings, whose pixels must stay as they are.
std::string png_uri(const Image& image);

/// The mean of the pixels that each pixel of a picture `width` wide covers; as it is if that is not
/// narrower.
Image shrunk(const Image& image, int width);

}  // namespace fovea::app
