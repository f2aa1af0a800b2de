#include "fovea/map/number_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cmath>

#include "fovea/map/json_cursor.h"

namespace fovea {
namespace {

using Matrix34RowMajor = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

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
  if (!motion.acceleration.isZero(0) || motion.path) {
    numbers.insert(numbers.end(), motion.acceleration.begin(), motion.acceleration.end());
  }
  if (motion.path) {
    numbers.push_back(motion.path->begin);
    numbers.push_back(motion.path->step);
    for (const Twist& placement : motion.path->placements) {
      numbers.insert(numbers.end(), placement.begin(), placement.end());
    }
  }
  return to_text(numbers);
}

std::optional<SweepMotion> sweep_motion_from_text(std::string_view text) {
  const std::optional<std::vector<double>> numbers = numbers_from_text(text);
  constexpr std::size_t kTwists = 12, kPath = 14, kLeastPath = kPath + 2 * 6;
  if (!numbers) return std::nullopt;
  const std::size_t size = numbers->size();
  const bool has_path = size >= kLeastPath && (size - kPath) % 6 == 0;
  if (size != 6 && size != kTwists && !has_path) return std::nullopt;
  SweepMotion motion{Eigen::Map<const Twist>(numbers->data())};
  if (size >= kTwists) motion.acceleration = Eigen::Map<const Twist>(numbers->data() + 6);
  if (!has_path) return motion;
  SweepPath& path = motion.path.emplace();
  path.begin = (*numbers)[kTwists];
  path.step = (*numbers)[kTwists + 1];
  constexpr double kLongest = 10;  // s: a sweep takes one at most
  const double length = path.step * double((size - kPath) / 6);
  if (!(path.step > 0 && length < kLongest && std::abs(path.begin) < kLongest)) {
    return std::nullopt;
  }
  for (std::size_t at = kPath; at < size; at += 6) {
    path.placements.emplace_back(Eigen::Map<const Twist>(numbers->data() + at));
  }
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
