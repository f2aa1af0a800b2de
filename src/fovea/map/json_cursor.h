// A small JSON reader for values that map/ has written itself. Private to map/.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace fovea {

/// A text as a JSON string.
inline std::string json_string(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20) {
      quoted += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

/// Reads JSON values in order. Each method returns whether the next value is of its kind.
class JsonCursor {
 public:
  explicit JsonCursor(std::string_view text) : rest_(text) {}

  bool take(std::string_view token) {
    skip_space();
    if (!rest_.starts_with(token)) return false;
    rest_.remove_prefix(token.size());
    return true;
  }

  bool number(double& value) {
    if (take("null")) {
      value = std::numeric_limits<double>::quiet_NaN();
      return true;
    }
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc() || !std::isfinite(value)) return false;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return true;
  }

  bool string(std::string& value) {
    if (!take("\"")) return false;
    value.clear();
    while (!rest_.empty()) {
      const char c = next();
      if (c == '"') return true;
      if (c != '\\') {
        value += c;
      } else if (!escape(value)) {
        return false;
      }
    }
    return false;
  }

  /// A list of numbers.
  bool numbers(std::vector<double>& values) {
    values.clear();
    if (!take("[")) return false;
    if (take("]")) return true;
    do {
      if (!number(values.emplace_back())) return false;
    } while (take(","));
    return take("]");
  }

  bool at_end() {
    skip_space();
    return rest_.empty();
  }

 private:
  char next() {
    const char c = rest_.front();
    rest_.remove_prefix(1);
    return c;
  }

  /// What follows a backslash; of \uXXXX only ASCII, since to_json() writes no other.
  bool escape(std::string& value) {
    if (rest_.empty()) return false;
    const char c = next();
    if (c == '"' || c == '\\' || c == '/') {
      value += c;
      return true;
    }
    int code = 0;
    if (c != 'u' || rest_.size() < 4) return false;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + 4, code, 16);
    if (error != std::errc() || end != rest_.data() + 4 || code < 0 || code > 0x7f) return false;
    rest_.remove_prefix(4);
    value += static_cast<char>(code);
    return true;
  }

  void skip_space() {
    while (!rest_.empty() &&
           std::string_view(" \t\r\n").find(rest_.front()) != std::string_view::npos)
      next();
  }

  std::string_view rest_;
};

}  // namespace fovea
