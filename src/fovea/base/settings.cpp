#include "fovea/base/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

#include "fovea/base/angle.h"
#include "fovea/base/errors.h"
#include "fovea/base/input_file.h"
#include "fovea/base/text_encoding.h"

namespace fovea {
namespace {

/// Assigns what a TOML document says; remembers which keys it met.
class Reader : public SettingVisitor {
 public:
  Reader(const toml::table& table, std::string_view name) : table_(table), name_(name) {}

  void operator()(std::string_view key, bool& value) override { visit(key, value); }
  void operator()(std::string_view key, int& value) override { visit(key, value); }
  void operator()(std::string_view key, double& value) override { visit(key, value); }
  void operator()(std::string_view key, std::string& value) override { visit(key, value); }
  void operator()(std::string_view key, std::vector<int>& value) override { visit(key, value); }
  void operator()(std::string_view key, std::vector<double>& value) override { visit(key, value); }
  void operator()(std::string_view key, Degrees value) override { visit(key, value); }
  void operator()(std::string_view key, DegreeRows value) override { visit(key, value); }
  bool is_given(std::string_view key) override { return find(key) != nullptr; }

  /// ConfigError for the first key of the document that is not known.
  void reject_unknown_keys(std::string_view help) const { reject_unknown(table_, "", help); }

  /// "FILE:LINE, KEY" for a key of the document, or of the table that it should be in; else "FILE,
  /// KEY".
  std::string where(std::string_view key) const {
    std::string_view path = key;
    while (true) {
      if (const toml::node* node = table_.at_path(path).node()) return place(*node, key);
      const std::size_t dot = path.rfind('.');
      if (dot == std::string_view::npos) return fmt::format("{}, key '{}'", name_, key);
      path = path.substr(0, dot);
    }
  }

 protected:
  void choose(std::string_view key, std::span<const std::string_view> names,
              std::size_t& chosen) override {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    const std::string choices = fmt::format("one of '{}'", fmt::join(names, "', '"));
    const auto text = node->value_exact<std::string>();
    if (!text) wrong_type(*node, key, choices);
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == *text) {
        chosen = i;
        return;
      }
    }
    throw ConfigError(fmt::format("unknown value '{}'", *text), place(*node, key),
                      "give " + choices);
  }

 private:
  const toml::node* find(std::string_view key) {
    known_.insert(std::string(key));
    return table_.at_path(key).node();
  }
  template <class T>
  void visit(std::string_view key, T& value) {
    if (const toml::node* node = find(key)) read(*node, key, value);
  }

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
  void read(const toml::node& node, std::string_view key, std::string& value) const {
    const auto read_value = node.value_exact<std::string>();
    if (!read_value) wrong_type(node, key, "a text in quotes");
    value = *read_value;
  }
  void read(const toml::node& node, std::string_view key, std::vector<double>& value) const {
    const toml::array* array = node.as_array();
    if (array == nullptr) wrong_type(node, key, "an array of numbers");
    std::vector<double> result;
    for (const toml::node& entry : *array) {
      if (const toml::array* row = entry.as_array()) {
        for (const toml::node& number : *row) read(number, key, result.emplace_back());
      } else {
        read(entry, key, result.emplace_back());
      }
    }
    value = std::move(result);
  }
  void read(const toml::node& node, std::string_view key, std::vector<int>& value) const {
    const toml::array* array = node.as_array();
    if (array == nullptr) wrong_type(node, key, "an array of whole numbers");
    std::vector<int> result;
    for (const toml::node& entry : *array) read(entry, key, result.emplace_back());
    value = std::move(result);
  }
  void read(const toml::node& node, std::string_view key, Degrees& value) const {
    double degrees = 0;
    read(node, key, degrees);
    const double radians = degrees * kDegree;
    // A number too small for its digits could not be printed and read back.
    value.radians = std::fpclassify(radians) == FP_SUBNORMAL ? 0 : radians;
  }
  void read(const toml::node& node, std::string_view key, DegreeRows& value) const {
    const std::string expected = fmt::format("an array of {} in degrees", value.columns);
    const toml::array* array = node.as_array();
    if (array == nullptr) wrong_type(node, key, expected);
    std::vector<std::array<double, 4>> result;
    for (const toml::node& entry : *array) {
      const toml::array* numbers = entry.as_array();
      std::array<double, 4>& row = result.emplace_back();
      if (numbers == nullptr || numbers->size() != row.size()) wrong_type(node, key, expected);
      for (std::size_t i = 0; i < row.size(); ++i) {
        Degrees angle{row[i]};
        read(*numbers->get(i), key, angle);
      }
    }
    value.radians = std::move(result);
  }

  void reject_unknown(const toml::table& table, const std::string& prefix,
                      std::string_view help) const {
    for (const auto& [name, node] : table) {
      const std::string key = prefix + std::string(name.str());
      if (known_.contains(key)) continue;
      if (const toml::table* inner = node.as_table()) {
        reject_unknown(*inner, key + ".", help);
      } else {
        throw ConfigError("unknown key", place(node, key), fmt::format("remove it, or {}", help));
      }
    }
  }

  const toml::table& table_;
  std::string name_;
  std::set<std::string> known_;
};

/// Prints every key.
class Writer : public SettingVisitor {
 public:
  void operator()(std::string_view key, bool& value) override {
    print(key, value ? "true" : "false");
  }
  void operator()(std::string_view key, int& value) override {
    print(key, fmt::format("{}", value));
  }
  void operator()(std::string_view key, double& value) override { print(key, text_of(value)); }
  void operator()(std::string_view key, std::string& value) override {
    std::ostringstream quoted;
    quoted << toml::value<std::string>(value);
    print(key, quoted.str());
  }
  void operator()(std::string_view key, std::vector<int>& value) override {
    print(key, fmt::format("[{}]", fmt::join(value, ", ")));
  }
  void operator()(std::string_view key, std::vector<double>& value) override {
    std::vector<std::string> numbers;
    numbers.reserve(value.size());
    for (const double number : value) numbers.push_back(text_of(number));
    print(key, fmt::format("[{}]", fmt::join(numbers, ", ")));
  }
  void operator()(std::string_view key, Degrees value) override {
    print(key, degrees_text(value.radians));
  }
  void operator()(std::string_view key, DegreeRows value) override {
    std::vector<std::string> rows;
    for (const std::array<double, 4>& row : value.radians) {
      std::vector<std::string> numbers;
      numbers.reserve(row.size());
      for (const double angle : row) numbers.push_back(degrees_text(angle));
      rows.push_back(fmt::format("[{}]", fmt::join(numbers, ", ")));
    }
    print(key, fmt::format("[{}]", fmt::join(rows, ", ")));
  }
  bool is_given(std::string_view) override { return false; }

  const std::string& text() const { return text_; }

 protected:
  void choose(std::string_view key, std::span<const std::string_view> names,
              std::size_t& chosen) override {
    if (chosen >= names.size()) throw std::logic_error("an enumeration value has no name");
    print(key, fmt::format("\"{}\"", names[chosen]));
  }

 private:
  void print(std::string_view key, std::string_view value) {
    const std::size_t dot = key.find('.');
    if (const auto table = key.substr(0, dot); table != table_) {
      text_ += fmt::format("{}[{}]\n", text_.empty() ? "" : "\n", table);
      table_ = table;
    }
    text_ += fmt::format("{} = {}\n", key.substr(dot + 1), value);
  }
  static std::string text_of(double value) {
    std::string text = fmt::format("{}", value);
    return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
  }
  static std::string degrees_text(double radians) {
    // 12 digits: what was given as 70 degrees must not come back as 70.00000000000001.
    return text_of(std::stod(fmt::format("{:.12g}", radians / kDegree)));
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

struct SettingsDocument::Content {
  toml::table table;
  std::string name;
};

SettingsDocument::SettingsDocument(std::unique_ptr<Content> content)
    : content_(std::move(content)) {}
SettingsDocument::~SettingsDocument() = default;
SettingsDocument::SettingsDocument(SettingsDocument&&) noexcept = default;

SettingsDocument SettingsDocument::from_text(std::string_view text, std::string_view name) {
  return SettingsDocument(std::make_unique<Content>(Content{parse(text, name), std::string(name)}));
}

SettingsDocument SettingsDocument::from_file(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = InputFile(file, kSettingsFile).bytes();
  const std::string text(bytes.begin(), bytes.end());
  return from_text(without_byte_order_mark(text, file.string()), file.string());
}

SettingsDocument SettingsDocument::from_assignment(std::string_view assignment,
                                                   std::string_view example) {
  const std::string name = fmt::format("--set {}", assignment);
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos || equals == 0) {
    throw ConfigError("a setting is not of the form key=value", name,
                      fmt::format("write e.g. {}", example));
  }
  const std::string key(assignment.substr(0, equals)), value(assignment.substr(equals + 1));
  toml::table table;
  try {
    table = toml::parse(fmt::format("{} = {}", key, value));
  } catch (const toml::parse_error&) {
    table = parse(fmt::format("{} = \"{}\"", key, value), name);  // a bare word is a string
  }
  return SettingsDocument(std::make_unique<Content>(Content{std::move(table), name}));
}

std::vector<std::string> SettingsDocument::tables(std::string_view key) const {
  std::vector<std::string> names;
  const toml::node* node = content_->table.at_path(key).node();
  if (node == nullptr) return names;
  const auto place = [&](const toml::node& where) {
    return fmt::format("{}:{}, key '{}'", content_->name, where.source().begin.line, key);
  };
  const toml::table* tables = node->as_table();
  if (tables == nullptr) {
    throw ConfigError("this is no table", place(*node), fmt::format("write [{}.NAME]", key));
  }
  for (const auto& [name, inner] : *tables) {
    if (!inner.is_table()) {
      throw ConfigError(fmt::format("'{}' is no table", name.str()), place(inner),
                        fmt::format("write [{}.NAME]", key));
    }
    const auto plain = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
             c == '_' || c == '-';
    };
    names.emplace_back(name.str());
    if (names.back().empty() || !std::all_of(names.back().begin(), names.back().end(), plain)) {
      throw ConfigError("a name has other characters than letters, digits, '_' and '-'",
                        place(inner), "rename it");
    }
  }
  return names;
}

void SettingsDocument::apply(const VisitSettings& visit, const std::function<void()>& validate,
                             std::string_view help) const {
  Reader reader(content_->table, content_->name);
  visit(reader);
  reader.reject_unknown_keys(help);
  try {
    validate();
  } catch (const ConfigError& error) {
    throw ConfigError(error.problem(), reader.where(error.where()), error.remedy());
  }
}

std::string settings_text(const VisitSettings& visit) {
  Writer writer;
  visit(writer);
  return writer.text();
}

}  // namespace fovea
