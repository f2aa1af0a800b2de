#include "fovea/core/settings_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fovea/core/angle.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr std::size_t kTomlWidth = 100, kMarkdownWidth = 120;

/// A rule for a number as the violation of a row.
template <class Number>
std::function<std::string()> violation_of(std::string key, const Allowed& allowed, Number number) {
  return [key = std::move(key), accepts = allowed.accepts, number] {
    return accepts(number()) ? std::string() : key;
  };
}

/// Text in lines that begin with a prefix each.
std::string wrapped(std::string_view text, std::size_t width, std::string_view first,
                    std::string_view others) {
  std::string lines;
  for (std::string_view prefix = first; !text.empty(); prefix = others) {
    std::size_t end = text.size();
    if (prefix.size() + end > width) end = text.rfind(' ', width - prefix.size());
    lines += fmt::format("{}{}\n", prefix, text.substr(0, end));
    text.remove_prefix(std::min(end, text.size() - 1) + 1);
  }
  return lines;
}

}  // namespace

Allowed between(double lowest, double highest) {
  return {fmt::format("{} to {}", lowest, highest),
          [=](double value) { return value >= lowest && value <= highest; }};
}

Allowed above(double bound, double highest) {
  return {fmt::format("above {}, up to {}", bound, highest),
          [=](double value) { return value > bound && value <= highest; }};
}

Allowed zero_or(double lowest, double highest) {
  return {fmt::format("0, or {} to {}", lowest, highest),
          [=](double value) { return value == 0 || (value >= lowest && value <= highest); }};
}

Allowed odd_between(int lowest, int highest) {
  return {fmt::format("an odd number, {} to {}", lowest, highest), [=](double value) {
            return value >= lowest && value <= highest && std::fmod(value, 2) == 1;
          }};
}

Setting::Setting(std::string key, std::string allowed, VisitSettings visit,
                 std::function<void()> reset, std::function<std::string()> violation,
                 std::string text)
    : key_(std::move(key)),
      allowed_(std::move(allowed)),
      text_(std::move(text)),
      visit_(std::move(visit)),
      reset_(std::move(reset)),
      violation_(std::move(violation)) {}

Setting::Setting(std::string key, bool& option, bool default_value, std::string text)
    : Setting(
          key, "true or false", [key, &option](SettingVisitor& visit) { visit(key, option); },
          [&option, default_value] { option = default_value; }, [] { return std::string(); },
          std::move(text)) {}

Setting::Setting(std::string key, int& option, int default_value, const Allowed& allowed,
                 std::string text)
    : Setting(
          key, allowed.text, [key, &option](SettingVisitor& visit) { visit(key, option); },
          [&option, default_value] { option = default_value; },
          violation_of(key, allowed, [&option] { return option; }), std::move(text)) {}

Setting::Setting(std::string key, double& option, double default_value, const Allowed& allowed,
                 std::string text)
    : Setting(
          key, allowed.text, [key, &option](SettingVisitor& visit) { visit(key, option); },
          [&option, default_value] { option = default_value; },
          violation_of(key, allowed, [&option] { return option; }), std::move(text)) {}

Setting::Setting(std::string key, Degrees option, double default_deg, const Allowed& allowed_deg,
                 std::string text)
    : Setting(
          key, allowed_deg.text, [key, option](SettingVisitor& visit) { visit(key, option); },
          [option, default_deg] { option.radians = default_deg * kDegree; },
          violation_of(key, allowed_deg, [option] { return written_degrees(option.radians); }),
          std::move(text)) {}

Setting&& Setting::with_rule(std::string rule, std::function<bool()> holds) && {
  rule_ = Rule{std::move(rule), std::move(holds)};
  return std::move(*this);
}

void Setting::validate() const {
  if (const std::string key = violation_(); !key.empty()) {
    throw ConfigError("a value is not allowed", key, fmt::format("give {}", allowed_));
  }
  if (rule_ && !rule_->holds()) {
    throw ConfigError("a value is not allowed", key_, fmt::format("give {}", rule_->text));
  }
}

std::string Setting::value() const {
  const std::vector<SettingText> texts = setting_texts(visit_);
  return texts.empty() ? "" : texts.front().value;
}

void visit_rows(const SettingsTable& table, SettingVisitor& visitor) {
  for (const Setting& row : table) row.visit(visitor);
}

void validate_rows(const SettingsTable& table) {
  for (const Setting& row : table) row.validate();
}

std::string commented_toml(const SettingsTable& table) {
  std::string text, section;
  for (const Setting& row : table) {
    const std::string value = row.value();
    const std::size_t dot = row.key().find('.');
    const std::string of = row.key().substr(0, dot), name = row.key().substr(dot + 1);
    text += of == section ? "\n" : fmt::format("{}[{}]\n", text.empty() ? "" : "\n", of);
    section = of;
    text += wrapped(fmt::format("{} ({})", row.text(), row.allowed()), kTomlWidth, "# ", "# ");
    text += fmt::format("{}{} = {}\n", value.empty() ? "# " : "", name,
                        value.empty() ? "[...]" : value);
  }
  return text;
}

std::string markdown_list(const SettingsTable& table) {
  std::string text;
  for (const Setting& row : table) {
    const std::string value = row.value();
    const std::string entry =
        fmt::format("`{}{}{}` ({}): {}", row.key(), value.empty() ? "" : " = ", value,
                    row.allowed(), row.text());
    text += wrapped(entry, kMarkdownWidth, "- ", "  ");
  }
  return text;
}

}  // namespace fovea
