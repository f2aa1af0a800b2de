// Depth of nested texts. Parsers take stack for each level.
#pragma once

#include <cstddef>
#include <string_view>

namespace fovea {

/// Levels that no file of ours needs (docs/limits.md).
inline constexpr std::size_t kMaxNesting = 32;

/// The greatest depth of a TOML or JSON text, without parsing it: open brackets and braces, and the
/// dots of the keys on the way. Strings and comments do not count. The point of a number counts as
/// one level. In an invalid text the part up to the first error counts right.
std::size_t nesting_depth(std::string_view text);

}  // namespace fovea
