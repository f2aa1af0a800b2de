// Text from files, for a terminal: control characters would steer it.
#pragma once

#include <algorithm>
#include <string>

namespace fovea {

inline bool is_control(char c) { return static_cast<unsigned char>(c) < ' ' || c == 0x7f; }

/// With '?' for each control character.
inline std::string printable(std::string text) {
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

}  // namespace fovea
