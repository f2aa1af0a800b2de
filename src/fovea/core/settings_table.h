// A settings table: one row for each key. The rows give the parser, the validation, the listing in
// TOML and the page of the documentation.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/core/settings.h"

namespace fovea {

/// The numbers that a setting accepts.
struct Allowed {
  std::string text;  ///< for a user: "0 to 1"
  std::function<bool(double)> accepts;
};

Allowed between(double lowest, double highest);
Allowed above(double bound, double highest);     ///< without the bound itself
Allowed zero_or(double lowest, double highest);  ///< 0 has a meaning of its own
Allowed odd_between(int lowest, int highest);

/// A row: one setting, bound to an option. Angles are radians in options and degrees in settings.
class Setting {
 public:
  Setting(std::string key, bool& option, bool default_value, std::string text);
  Setting(std::string key, int& option, int default_value, const Allowed& allowed,
          std::string text);
  Setting(std::string key, double& option, double default_value, const Allowed& allowed,
          std::string text);
  Setting(std::string key, Degrees option, double default_deg, const Allowed& allowed_deg,
          std::string text);

  /// One of the values that names_of(Enum) returns.
  template <class Enum>
    requires std::is_enum_v<Enum>
  Setting(std::string key, Enum& option, Enum default_value, std::string text)
      : Setting(
            key, names_text<Enum>(), [key, &option](SettingVisitor& visit) { visit(key, option); },
            [&option, default_value] { option = default_value; }, [] { return std::string(); },
            std::move(text)) {}

  /// A row of another form.
  /// @param allowed    the accepted values, for a user
  /// @param visit      visits the key, or several keys
  /// @param reset      sets the option to its default
  /// @param violation  a key whose value is not allowed; empty where all are
  Setting(std::string key, std::string allowed, VisitSettings visit, std::function<void()> reset,
          std::function<std::string()> violation, std::string text);

  /// Adds a rule that more than this option takes part in.
  /// @param rule  completes "give ": "more than foveal.near_range_m"
  Setting&& with_rule(std::string rule, std::function<bool()> holds) &&;

  const std::string& key() const { return key_; }
  const std::string& allowed() const { return allowed_; }
  const std::string& text() const { return text_; }

  void visit(SettingVisitor& visitor) const { visit_(visitor); }
  void reset() const { reset_(); }
  /// ConfigError whose place is the key where the option has a value that is not allowed.
  void validate() const;
  /// The value as TOML; empty for a key that is not there.
  std::string value() const;

 private:
  struct Rule {
    std::string text;
    std::function<bool()> holds;
  };

  template <class Enum>
  static std::string names_text() {
    std::string names;
    for (const auto& entry : names_of(Enum{})) {
      names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", entry.name);
    }
    return names;
  }

  std::string key_, allowed_, text_;
  VisitSettings visit_;
  std::function<void()> reset_;
  std::function<std::string()> violation_;
  std::optional<Rule> rule_;
};

using SettingsTable = std::vector<Setting>;

/// Visits all rows; for SettingsDocument::apply and settings_text.
void visit_rows(const SettingsTable& table, SettingVisitor& visitor);
/// ConfigError whose place is a key.
void validate_rows(const SettingsTable& table);

/// All keys with their values in TOML, each below its sentence and its accepted values.
std::string commented_toml(const SettingsTable& table);
/// A list in Markdown: key and value, accepted values, sentence.
std::string markdown_list(const SettingsTable& table);

}  // namespace fovea
