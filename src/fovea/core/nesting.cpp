#include "fovea/core/nesting.h"

#include <algorithm>
#include <vector>

namespace fovea {
namespace {

/// The text behind the string that `text` begins with. A string of one line ends with its line.
std::string_view behind_string(std::string_view text) {
  const char quote = text.front();
  const bool has_escapes = quote == '"';
  const bool is_long = text.size() >= 3 && text[1] == quote && text[2] == quote;
  std::size_t at = is_long ? 3 : 1;
  const auto closes = [&] {
    if (!is_long) return text[at] == quote || text[at] == '\n';
    return at + 2 < text.size() && text[at] == quote && text[at + 1] == quote &&
           text[at + 2] == quote;
  };
  while (at < text.size() && !closes()) at += has_escapes && text[at] == '\\' ? 2 : 1;
  at += is_long ? 3 : 1;
  // Up to two quotes before the closing ones belong to the string.
  for (int i = 0; is_long && i < 2 && at < text.size() && text[at] == quote; ++i) ++at;
  return text.substr(std::min(at, text.size()));
}

}  // namespace

std::size_t nesting_depth(std::string_view text) {
  std::vector<std::size_t> dots_outside;  // of the keys before each open bracket
  std::size_t dots = 0, outside = 0, deepest = 0;
  while (!text.empty()) {
    const char c = text.front();
    if (c == '"' || c == '\'') {
      text = behind_string(text);
      continue;
    }
    if (c == '#') {
      text.remove_prefix(std::min(text.find('\n'), text.size()));
      continue;
    }
    if (c == '.') ++dots;
    if (c == '[' || c == '{') {
      dots_outside.push_back(dots);
      outside += dots;
      dots = 0;
    }
    if ((c == ']' || c == '}') && !dots_outside.empty()) {
      outside -= dots_outside.back();
      dots_outside.pop_back();
      dots = 0;
    }
    if (c == ',' || c == '\n') dots = 0;
    deepest = std::max(deepest, dots_outside.size() + outside + dots);
    text.remove_prefix(1);
  }
  return deepest;
}

}  // namespace fovea
