#include "fovea/map/number_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>
#include <limits>

namespace fovea {
namespace {

using Matrix34RowMajor = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

std::string json_string(std::string_view text) {
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

/// Reads a flat JSON object of numbers; every method says whether it found what it looks for.
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

}  // namespace

std::string to_text(std::span<const double> numbers) {
  return fmt::format("{}", fmt::join(numbers.begin(), numbers.end(), " "));
}

std::optional<std::vector<double>> numbers_from_text(std::string_view text) {
  std::vector<double> numbers;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    while (at != end && *at == ' ') ++at;
    if (at == end) return numbers;
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
    if (next != end && *next != ' ') return std::nullopt;
    numbers.push_back(value);
    at = next;
  }
}

std::optional<RigidMotion> motion_from_text(std::string_view text) {
  const std::optional<std::vector<double>> numbers = numbers_from_text(text);
  if (!numbers || numbers->size() != 12) return std::nullopt;
  RigidMotion T = RigidMotion::Identity();
  T.matrix().topRows<3>() = Eigen::Map<const Matrix34RowMajor>(numbers->data());
  return T;
}

std::string to_text(const SweepMotion& motion) {
  std::vector<double> numbers(motion.velocity.begin(), motion.velocity.end());
  if (!motion.acceleration.isZero(0)) {
    numbers.insert(numbers.end(), motion.acceleration.begin(), motion.acceleration.end());
  }
  return to_text(numbers);
}

std::optional<SweepMotion> sweep_motion_from_text(std::string_view text) {
  const std::optional<std::vector<double>> numbers = numbers_from_text(text);
  if (!numbers || (numbers->size() != 6 && numbers->size() != 12)) return std::nullopt;
  SweepMotion motion{Eigen::Map<const Twist>(numbers->data())};
  if (numbers->size() == 12) motion.acceleration = Eigen::Map<const Twist>(numbers->data() + 6);
  return motion;
}

std::string to_json(const std::map<std::string, double>& numbers) {
  std::string json = "{";
  for (const auto& [name, value] : numbers) {
    if (json.size() > 1) json += ',';
    json += json_string(name) + ':' + (std::isfinite(value) ? fmt::format("{}", value) : "null");
  }
  return json + '}';
}

std::optional<std::map<std::string, double>> numbers_from_json(std::string_view text) {
  JsonCursor cursor(text);
  std::map<std::string, double> numbers;
  if (!cursor.take("{")) return std::nullopt;
  bool more = !cursor.take("}");
  while (more) {
    std::string name;
    double value = 0;
    if (!cursor.string(name) || !cursor.take(":") || !cursor.number(value)) return std::nullopt;
    numbers[name] = value;
    more = cursor.take(",");
    if (!more && !cursor.take("}")) return std::nullopt;
  }
  if (!cursor.at_end()) return std::nullopt;
  return numbers;
}

}  // namespace fovea
