// Names that are also those of folders and of tables in TOML.
#pragma once

#include <algorithm>
#include <string_view>

namespace fovea {

inline bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

/// Letters, digits, '_' and '-'; at least one.
inline bool is_plain_name(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), is_plain);
}

}  // namespace fovea
