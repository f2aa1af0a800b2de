#include "fovea/core/printable.h"

#include <cstdint>

namespace fovea {
namespace {

bool is_control_code(std::uint32_t code) {
  const bool is_c0 = code < 0x20, is_del_or_c1 = code >= 0x7f && code < 0xa0;
  const bool is_separator = code == 0x2028 || code == 0x2029;
  const bool reverses = (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
  return is_c0 || is_del_or_c1 || is_separator || reverses;
}

/// Bytes of a character by its first byte; 0 if no character begins so.
std::size_t length_of(unsigned char first) {
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0) return 2;
  if (first >= 0xe0 && first < 0xf0) return 3;
  if (first >= 0xf0 && first < 0xf5) return 4;
  return 0;
}

template <class Keep>
std::string replaced(std::string_view text, Keep&& keep) {
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const Character character = first_character(text);
    if (character.is_control && !keep(text.front())) {
      result += '?';
    } else {
      result += text.substr(0, character.bytes);
    }
    text.remove_prefix(character.bytes);
  }
  return result;
}

}  // namespace

Character first_character(std::string_view text) noexcept {
  const auto first = static_cast<unsigned char>(text.front());
  const std::size_t length = length_of(first);
  if (length == 0 || length > text.size()) return {1, true};
  std::uint32_t code = length == 1 ? first : first & (0xffu >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte & 0xc0) != 0x80) return {1, true};
    code = code << 6 | (byte & 0x3f);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  if (code < kLeast[length] || is_surrogate || code > 0x10ffff) return {1, true};
  return {length, is_control_code(code)};
}

std::string printable(std::string_view text) {
  return replaced(text, [](char) { return false; });
}

std::string printable_lines(std::string_view text) {
  return replaced(text, [](char c) { return c == '\n' || c == '\t'; });
}

}  // namespace fovea
