// Output to the terminal. All commands print through these functions, so that text from files
// (names, notes, topics, paths, settings) cannot steer the terminal.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "fovea/core/printable.h"

namespace fovea::app {

/// Strings become printable(); other values stay as they are.
template <class T>
auto printable_argument(const T& value) {
  if constexpr (std::is_convertible_v<const T&, std::string_view>) {
    return printable(std::string_view(value));
  } else {
    return value;
  }
}

/// Prints to a stream. Line ends are those of the format alone.
template <class... Args>
void print_to(std::FILE* stream, fmt::format_string<const Args&...> format, const Args&... args) {
  const std::tuple values(printable_argument(args)...);
  const std::string text = std::apply(
      [&](const auto&... printables) {
        return fmt::vformat(fmt::string_view(format), fmt::make_format_args(printables...));
      },
      values);
  fmt::print(stream, "{}", printable_lines(text));
}

/// Prints to standard output.
template <class... Args>
void print_out(fmt::format_string<const Args&...> format, const Args&... args) {
  print_to(stdout, format, args...);
}

/// Prints to standard error.
template <class... Args>
void print_err(fmt::format_string<const Args&...> format, const Args&... args) {
  print_to(stderr, format, args...);
}

/// Prints a text of lines, whose line ends and tabs stay.
void print_lines(std::string_view text);

/// Prints a JSON value in lines. Control characters of its strings are escaped, so that a parser
/// reads the same strings.
void print_json_value(const nlohmann::ordered_json& json);

}  // namespace fovea::app
