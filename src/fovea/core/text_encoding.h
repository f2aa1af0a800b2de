// Byte order marks at the start of text files.
#pragma once

#include <string_view>

namespace fovea {

/// The text without the byte order mark of UTF-8. InputError if the text is UTF-16 or UTF-32.
/// @param name  stands for the file in the error
std::string_view without_byte_order_mark(std::string_view text, std::string_view name);

}  // namespace fovea
