#include "fovea/map/sensor_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <variant>

#include "fovea/map/json_cursor.h"

namespace fovea {
namespace {

constexpr const char* kClockwise = "clockwise";
constexpr const char* kCounterclockwise = "counterclockwise";

using JsonValue = std::variant<double, std::string, std::vector<double>>;

/// The object's values by key. A null becomes NaN.
std::optional<std::map<std::string, JsonValue>> json_object(std::string_view text) {
  JsonCursor cursor(text);
  std::map<std::string, JsonValue> object;
  if (!cursor.take("{")) return std::nullopt;
  bool more = !cursor.take("}");
  while (more) {
    std::string key, string;
    double number = 0;
    std::vector<double> numbers;
    if (!cursor.string(key) || !cursor.take(":")) return std::nullopt;
    if (cursor.string(string)) {
      object[key] = string;
    } else if (cursor.number(number)) {
      object[key] = number;
    } else if (cursor.numbers(numbers)) {
      object[key] = numbers;
    } else {
      return std::nullopt;
    }
    more = cursor.take(",");
    if (!more && !cursor.take("}")) return std::nullopt;
  }
  if (!cursor.at_end()) return std::nullopt;
  return object;
}

/// Calls visit(key, value) for each number of a profile that is always there.
template <class Profile, class Visit>
void for_each_number(Profile& profile, Visit&& visit) {
  visit("ring_spacing_rad", profile.ring_spacing);
  visit("point_spacing_rad", profile.point_spacing);
  visit("sweep_period_s", profile.sweep.period);
  visit("sweep_start_azimuth_rad", profile.sweep.start_azimuth);
  visit("sweep_stamp_phase", profile.sweep.stamp_phase);
  visit("range_noise_m", profile.range_noise);
}

}  // namespace

std::string to_json(const SensorProfile& profile) {
  const auto require_finite = [](double number) {
    if (!std::isfinite(number)) throw std::invalid_argument("a sensor profile is not finite");
  };
  std::for_each(profile.ring_elevations.begin(), profile.ring_elevations.end(), require_finite);
  std::string json =
      fmt::format("{{\"ring_elevations_rad\":[{}]", fmt::join(profile.ring_elevations, ","));
  for_each_number(profile, [&](const char* key, double number) {
    require_finite(number);
    json += fmt::format(",\"{}\":{}", key, number);
  });
  json += fmt::format(
      ",\"sweep_direction\":\"{}\"",
      profile.sweep.direction == SweepDirection::kClockwise ? kClockwise : kCounterclockwise);
  if (profile.height) require_finite(*profile.height);
  return json + fmt::format(",\"height_m\":{}}}",
                            profile.height ? fmt::to_string(*profile.height) : "null");
}

std::optional<SensorProfile> sensor_profile_from_json(std::string_view text) {
  const auto object = json_object(text);
  if (!object) return std::nullopt;
  bool is_whole = true;
  const auto get = [&]<class Value>(const char* key, Value& value) {
    const auto found = object->find(key);
    const auto* stored = found == object->end() ? nullptr : std::get_if<Value>(&found->second);
    if (stored != nullptr) value = *stored;
    is_whole = is_whole && stored != nullptr;
  };
  SensorProfile profile;
  get("ring_elevations_rad", profile.ring_elevations);
  is_whole = is_whole && std::all_of(profile.ring_elevations.begin(), profile.ring_elevations.end(),
                                     [](double number) { return std::isfinite(number); });
  for_each_number(profile, [&](const char* key, double& number) {
    get(key, number);
    is_whole = is_whole && std::isfinite(number);
  });
  std::string direction;
  get("sweep_direction", direction);
  if (direction == kCounterclockwise) profile.sweep.direction = SweepDirection::kCounterclockwise;
  double height = 0;
  get("height_m", height);
  if (!std::isnan(height)) profile.height = height;
  if (!is_whole || (direction != kClockwise && direction != kCounterclockwise)) return std::nullopt;
  return profile;
}

}  // namespace fovea
