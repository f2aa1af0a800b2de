// Text from files, for a terminal: control characters would steer it.
#pragma once

#include <string>
#include <string_view>

namespace fovea {

/// The first character of a UTF-8 text.
struct Character {
  std::size_t bytes;  ///< at least 1 of a text that is not empty
  /// Whether it is a control character (C0, DEL, C1), a separator of lines, a mark that reverses
  /// the direction of writing, or no valid UTF-8.
  bool is_control;
};
Character first_character(std::string_view text) noexcept;

/// With '?' for each control character, line ends and tabs included.
std::string printable(std::string_view text);
/// The same for a text of lines, whose line ends and tabs stay.
std::string printable_lines(std::string_view text);

}  // namespace fovea
