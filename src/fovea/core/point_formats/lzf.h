// LZF, the compression inside PCD files (M. Lehmann's format, without headers of its own).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace fovea {

/// No LZF stream grows more than this when unpacked: a reference of 3 bytes stands for up to 264.
inline constexpr std::size_t kLzfMaxRatio = 88;

/// Unpacks a stream that is known to hold `size` bytes; empty if it does not hold exactly that many
/// or refers to bytes before its beginning. The caller bounds `size`, see kLzfMaxRatio.
std::optional<std::string> lzf_decompress(std::string_view packed, std::size_t size);

}  // namespace fovea
