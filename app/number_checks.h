// Checks of numbers on the command line. Their messages name the value and what to give.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace fovea::app {

inline constexpr int kMaxThreads = 4096;

/// A number from `low` to `high`, without anything behind it. NaN is none.
/// @param noun  what the number is, for the message
/// @param help  the range in the text of --help
template <class Number>
CLI::Validator number_in_range(Number low, Number high, const char* noun, const std::string& help) {
  return {[=](const std::string& text) {
            Number value = 0;
            const char* const end = text.data() + text.size();
            const auto [after, error] = std::from_chars(text.data(), end, value);
            const bool good = error == std::errc() && after == end && value >= low && value <= high;
            return good ? std::string()
                        : fmt::format("'{}' is not a {} from {} to {}", text, noun, low, high);
          },
          help};
}

/// A finite number from `low` to `high`.
inline CLI::Validator finite_range(double low, double high) {
  return number_in_range(low, high, "number", fmt::format("[{} - {}]", low, high));
}

/// A whole number from `low` to `high`.
template <class Number>
CLI::Validator whole_number(Number low, Number high = std::numeric_limits<Number>::max()) {
  return number_in_range(low, high, "whole number", "");
}

/// Replaces a size with a unit ("512MiB") by its number of bytes.
inline CLI::Validator memory_size() {
  return {[](std::string& text) -> std::string {
            const std::string given = text;
            const bool positive = !text.empty() && text[0] >= '0' && text[0] <= '9';
            try {
              if (positive && CLI::AsSizeValue(/*kb_is_1000=*/false)(text).empty()) return {};
            } catch (const CLI::ValidationError&) {  // an unknown unit
            }
            return fmt::format("'{}' is not a size of memory: give e.g. 512MiB or 2GiB", given);
          },
          ""};
}

}  // namespace fovea::app
