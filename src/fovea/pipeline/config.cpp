#include "fovea/pipeline/config.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

#include "fovea/base/errors.h"
#include "fovea/pipeline/config_keys.h"
#include "fovea/pipeline/presets.h"

namespace fovea {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

template <class Enum>
std::string choices() {
  std::string text;
  for (const auto& entry : names_of(Enum{})) {
    text += (text.empty() ? "'" : ", '") + std::string(entry.name) + "'";
  }
  return text;
}

/// Assigns what a TOML document says to the options; remembers which keys it met.
class ConfigReader {
 public:
  ConfigReader(const toml::table& table, std::string_view name) : table_(table), name_(name) {}

  template <class T>
  void operator()(std::string_view key, T&& value) {
    known_.insert(std::string(key));
    if (const toml::node* node = table_.at_path(key).node()) read(*node, key, value);
  }

  /// ConfigError for the first key of the document that is not known.
  void reject_unknown_keys() const { reject_unknown(table_, ""); }

  /// "FILE:LINE, KEY" for a key of the document, or the key alone.
  std::string where(std::string_view key) const {
    const toml::node* node = table_.at_path(key).node();
    return node != nullptr ? place(*node, key) : std::string(key);
  }

 private:
  std::string place(const toml::node& node, std::string_view key) const {
    return fmt::format("{}:{}, key '{}'", name_, node.source().begin.line, key);
  }
  [[noreturn]] void wrong_type(const toml::node& node, std::string_view key,
                               std::string_view expected) const {
    throw ConfigError("a value has the wrong type", place(node, key),
                      fmt::format("give {}", expected));
  }

  void read(const toml::node& node, std::string_view key, bool& value) const {
    const auto read_value = node.value_exact<bool>();
    if (!read_value) wrong_type(node, key, "true or false");
    value = *read_value;
  }
  void read(const toml::node& node, std::string_view key, int& value) const {
    const auto read_value = node.value_exact<std::int64_t>();
    if (!read_value || *read_value != static_cast<int>(*read_value)) {
      wrong_type(node, key, "a whole number");
    }
    value = static_cast<int>(*read_value);
  }
  void read(const toml::node& node, std::string_view key, double& value) const {
    if (!node.is_number()) wrong_type(node, key, "a number");
    value = *node.value<double>();
  }
  void read(const toml::node& node, std::string_view key, Degrees& value) const {
    double degrees = 0;
    read(node, key, degrees);
    value.radians = degrees * kDegree;
  }
  void read(const toml::node& node, std::string_view key, Slices& slices) const {
    const char* expected =
        "an array of [azimuth_min, azimuth_max, elevation_min, elevation_max] in degrees";
    const toml::array* array = node.as_array();
    if (array == nullptr) wrong_type(node, key, expected);
    Slices result;
    for (const toml::node& entry : *array) {
      const toml::array* bounds = entry.as_array();
      if (bounds == nullptr || bounds->size() != 4) wrong_type(node, key, expected);
      std::array<double, 4> degrees{};
      for (std::size_t i = 0; i < 4; ++i) read(*bounds->get(i), key, degrees[i]);
      result.push_back(
          {degrees[0] * kDegree, degrees[1] * kDegree, degrees[2] * kDegree, degrees[3] * kDegree});
    }
    slices = std::move(result);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void read(const toml::node& node, std::string_view key, Enum& value) const {
    const auto text = node.value_exact<std::string>();
    if (!text) wrong_type(node, key, "one of " + choices<Enum>());
    for (const auto& entry : names_of(Enum{})) {
      if (entry.name == *text) {
        value = entry.value;
        return;
      }
    }
    throw ConfigError(fmt::format("unknown value '{}'", *text), place(node, key),
                      "give one of " + choices<Enum>());
  }

  void reject_unknown(const toml::table& table, const std::string& prefix) const {
    for (const auto& [name, node] : table) {
      const std::string key = prefix + std::string(name.str());
      if (known_.contains(key)) continue;
      if (const toml::table* inner = node.as_table()) {
        reject_unknown(*inner, key + ".");
      } else {
        throw ConfigError(
            "unknown key", place(node, key),
            "remove it, or see `fovea map --help` and config/default.toml for the keys");
      }
    }
  }

  const toml::table& table_;
  std::string name_;
  std::set<std::string> known_;
};

void apply_table(const toml::table& table, std::string_view name, MapperOptions& options) {
  MapperOptions result = options;
  ConfigReader reader(table, name);
  visit_config(reader, result);
  reader.reject_unknown_keys();
  try {
    result.validate();
  } catch (const ConfigError& error) {
    throw ConfigError(error.problem(), reader.where(error.where()), error.remedy());
  }
  options = result;
}

/// Prints every key; keys of one table follow each other in visit_config.
class ConfigWriter {
 public:
  template <class T>
  void operator()(std::string_view key, T&& value) {
    if constexpr (std::is_same_v<std::decay_t<T>, Slices>) {
      if (value.empty() && key != "foveal.slices") return;  // a camera without slices of its own
    }
    const std::size_t dot = key.find('.');
    if (const auto table = key.substr(0, dot); table != table_) {
      text_ += fmt::format("{}[{}]\n", text_.empty() ? "" : "\n", table);
      table_ = table;
    }
    text_ += fmt::format("{} = {}\n", key.substr(dot + 1), print(value));
  }
  const std::string& text() const { return text_; }

 private:
  static std::string print(bool value) { return value ? "true" : "false"; }
  static std::string print(int value) { return fmt::format("{}", value); }
  static std::string print(double value) {
    std::string text = fmt::format("{}", value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
  }
  static std::string print(const Degrees& value) { return print_degrees(value.radians); }
  static std::string print_degrees(double radians) {
    // 12 digits: what was given as 70 degrees must not come back as 70.00000000000001.
    return print(std::stod(fmt::format("{:.12g}", radians / kDegree)));
  }
  static std::string print(const Slices& slices) {
    std::vector<std::string> parts;
    for (const AngularSlice& s : slices) {
      parts.push_back(fmt::format("[{}, {}, {}, {}]", print_degrees(s.azimuth_min),
                                  print_degrees(s.azimuth_max), print_degrees(s.elevation_min),
                                  print_degrees(s.elevation_max)));
    }
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  static std::string print(Enum value) {
    for (const auto& entry : names_of(Enum{})) {
      if (entry.value == value) return fmt::format("\"{}\"", entry.name);
    }
    throw std::logic_error("an enumeration value has no name");
  }

  std::string text_;
  std::string table_;
};

toml::table parse(std::string_view text, std::string_view name) {
  try {
    return toml::parse(text, name);
  } catch (const toml::parse_error& error) {
    throw ConfigError(fmt::format("not valid TOML ({})", error.description()),
                      fmt::format("{}:{}", name, error.source().begin.line), "correct that line");
  }
}

}  // namespace

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : kPresets) names.emplace_back(preset.name);
  std::sort(names.begin(), names.end());
  return names;
}

MapperOptions load_preset(std::string_view name) {
  for (const Preset& preset : kPresets) {
    if (preset.name != name) continue;
    MapperOptions options;
    apply_config_text(preset.text, fmt::format("preset {}", name), options);
    return options;
  }
  throw ConfigError(fmt::format("unknown preset '{}'", name), "--preset",
                    fmt::format("give one of {}", fmt::join(preset_names(), ", ")));
}

void apply_config_file(const std::filesystem::path& file, MapperOptions& options) {
  std::ifstream stream(file, std::ios::binary);
  std::stringstream text;
  text << stream.rdbuf();
  if (!stream || std::filesystem::is_directory(file)) {
    throw InputError("the configuration cannot be read", file.string(), "check the path");
  }
  apply_config_text(text.str(), file.string(), options);
}

void apply_config_text(std::string_view text, std::string_view name, MapperOptions& options) {
  apply_table(parse(text, name), name, options);
}

void apply_setting(std::string_view setting, MapperOptions& options) {
  const std::string name = fmt::format("--set {}", setting);
  const std::size_t equals = setting.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw ConfigError("a setting is not of the form key=value", name, "write e.g. upsample.rate=2");
  }
  const std::string key(setting.substr(0, equals)), value(setting.substr(equals + 1));
  toml::table table;
  try {
    table = toml::parse(fmt::format("{} = {}", key, value));
  } catch (const toml::parse_error&) {
    table = parse(fmt::format("{} = \"{}\"", key, value), name);  // a bare word is a string
  }
  apply_table(table, name, options);
}

std::string to_toml(const MapperOptions& options) {
  MapperOptions copy = options;
  ConfigWriter writer;
  visit_config(writer, copy);
  return writer.text();
}

}  // namespace fovea
