// What a camera may be called: its name is a folder's and a table's of drive.toml, too.
#pragma once

#include <algorithm>
#include <string_view>

namespace fovea {

inline bool may_name_a_camera(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
         c == '_';
}

/// Letters, digits, '_' and '-'; at least one.
inline bool is_camera_name(std::string_view name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), may_name_a_camera);
}

}  // namespace fovea
