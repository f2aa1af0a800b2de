#include "fovea/map/point_filter.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "fovea/core/angle.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr std::string_view kRuleField = "rule";
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// The number that a condition states; of a rule its name will do.
std::optional<double> number_of(std::string_view field, std::string_view text) {
  if (field == kRuleField) {
    const auto named = std::find(kPointRuleNames.begin(), kPointRuleNames.end(), text);
    if (named != kPointRuleNames.end()) return double(named - kPointRuleNames.begin());
  }
  double value = 0;
  const auto [last, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || last != text.data() + text.size()) return std::nullopt;
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

constexpr std::string_view kBlanks = " \t";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

[[noreturn]] void reject(std::string_view condition) {
  throw ConfigError(fmt::format("the condition '{}' is not understood", condition), "--where",
                    "write FIELD OPERATOR NUMBER, joined by 'and', e.g. \"views >= 2 and range < "
                    "10\"; fields are x, y, z, height, views, spread, range, incidence, frame, "
                    "camera, rule, matched, interpolated, intensity");
}

using Cloud = const PointCloud&;
using Index = std::size_t;
using Place = const PointPlace&;

}  // namespace

const PointFilter::Field* PointFilter::find_field(std::string_view name) {
  static constexpr std::array<Field, 14> kFields = {{
      {"x", [](Cloud, Index, Place p) { return p.p_local.x(); }, Needs::kPosition},
      {"y", [](Cloud, Index, Place p) { return p.p_local.y(); }, Needs::kPosition},
      {"z", [](Cloud, Index, Place p) { return p.p_local.z(); }, Needs::kPosition},
      {"height", [](Cloud, Index, Place p) { return p.height; }, Needs::kHeight},
      {"views", [](Cloud p, Index i, Place) { return double(p.views[i]); }},
      {"spread", [](Cloud p, Index i, Place) { return double(p.spread[i]); }},
      {"range", [](Cloud p, Index i, Place) { return double(p.range[i]); }},
      {"incidence", [](Cloud p, Index i, Place) { return double(p.incidence[i]) / kDegree; }},
      {"frame", [](Cloud p, Index i, Place) { return double(p.frame[i]); }},
      {"camera", [](Cloud p, Index i, Place) { return double(p.camera[i]); }},
      {kRuleField, [](Cloud p, Index i, Place) { return double(rule_number(p.reason[i])); }},
      {"matched",
       [](Cloud p, Index i, Place) { return (p.reason[i] & kExposureMatched) != 0 ? 1.0 : 0.0; }},
      {"interpolated", [](Cloud p, Index i, Place) { return double(p.interpolated[i]); }},
      {"intensity", [](Cloud p, Index i,
                       Place) { return p.intensity.empty() ? kNone : double(p.intensity[i]); }},
  }};
  const auto found = std::find_if(kFields.begin(), kFields.end(),
                                  [name](const Field& field) { return field.name == name; });
  return found == kFields.end() ? nullptr : &*found;
}

bool PointFilter::Condition::holds(double v) const {
  switch (op) {
    case Operator::kLess:
      return v < number;
    case Operator::kLessEqual:
      return v <= number;
    case Operator::kGreater:
      return v > number;
    case Operator::kGreaterEqual:
      return v >= number;
    case Operator::kEqual:
      return v == number;
    case Operator::kNotEqual:
      return !std::isnan(v) && v != number;
  }
  return false;
}

PointFilter::Condition PointFilter::parse_condition(const std::string& text) {
  const std::size_t at = text.find_first_of("<>=!");
  if (at == std::string::npos) reject(text);
  const std::size_t end = std::min(text.find_first_not_of("<>=!", at), text.size());
  const std::string_view field = trimmed(std::string_view(text).substr(0, at));
  const std::string_view sign = std::string_view(text).substr(at, end - at);
  const std::string_view number = trimmed(std::string_view(text).substr(end));

  constexpr std::array<std::pair<std::string_view, Operator>, 7> kOperators = {
      {{"<", Operator::kLess},
       {"<=", Operator::kLessEqual},
       {">", Operator::kGreater},
       {">=", Operator::kGreaterEqual},
       {"==", Operator::kEqual},
       {"=", Operator::kEqual},
       {"!=", Operator::kNotEqual}}};
  const auto found_sign = std::find_if(kOperators.begin(), kOperators.end(),
                                       [sign](const auto& entry) { return entry.first == sign; });
  const Field* found_field = find_field(field);
  const std::optional<double> value = number_of(field, number);
  if (found_field == nullptr || found_sign == kOperators.end() || !value) reject(text);
  return {found_field, found_sign->second, *value};
}

PointFilter PointFilter::parse(std::string_view text) {
  constexpr std::string_view kAnd = " and ";
  PointFilter filter;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(kAnd, begin), text.size());
    filter.conditions_.push_back(
        parse_condition(std::string(trimmed(text.substr(begin, end - begin)))));
    begin = end + (end == text.size() ? 1 : kAnd.size());
  }
  return filter;
}

bool PointFilter::needs_place() const {
  return std::any_of(conditions_.begin(), conditions_.end(), [](const Condition& condition) {
    return condition.field->needs != Needs::kColumns;
  });
}

bool PointFilter::needs_height() const {
  return std::any_of(conditions_.begin(), conditions_.end(), [](const Condition& condition) {
    return condition.field->needs == Needs::kHeight;
  });
}

bool PointFilter::matches(const PointCloud& tile, std::size_t index,
                          const PointPlace& place) const {
  return std::all_of(conditions_.begin(), conditions_.end(), [&](const Condition& condition) {
    return condition.holds(condition.field->value(tile, index, place));
  });
}

}  // namespace fovea
