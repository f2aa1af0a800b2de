#include "fovea/core/settings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "fovea/core/angle.h"
#include "fovea/core/input_file.h"
#include "fovea/core/nesting.h"
#include "fovea/core/plain_name.h"
#include "fovea/core/text_encoding.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

/// Calls visit(key, node) for every key below a table that is no table itself.
template <class Visit>
void for_each_key(const toml::table& table, Visit&& visit, const std::string& prefix = "") {
  for (const auto& [name, node] : table) {
    const std::string key = prefix + std::string(name.str());
    if (const toml::table* inner = node.as_table()) {
      for_each_key(*inner, visit, key + ".");
    } else {
      visit(key, node);
    }
  }
}

/// A value in TOML, in one line.
std::string text_of(const toml::node& node) {
  if (const toml::array* array = node.as_array()) {
    std::vector<std::string> entries;
    for (const toml::node& entry : *array) entries.push_back(text_of(entry));
    return fmt::format("[{}]", fmt::join(entries, ", "));
  }
  if (const auto* number = node.as_floating_point()) return number_text(number->get());
  std::ostringstream text;
  node.visit([&](const auto& value) { text << value; });
  return text.str();
}

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
  void reject_unknown_keys(std::string_view help,
                           const std::function<void(std::string_view)>& explain) const {
    for_each_key(table_, [&](const std::string& key, const toml::node& node) {
      if (known_.contains(key)) return;
      if (explain) with_place([&] { explain(key); });
      throw ConfigError("unknown key", place(node, key), fmt::format("remove it, or {}", help));
    });
  }

  /// Calls work(), whose ConfigErrors have a key as their place.
  void with_place(const std::function<void()>& work) const {
    try {
      work();
    } catch (const ConfigError& error) {
      throw ConfigError(error.problem(), where(error.where()), error.remedy());
    }
  }

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
    const auto found = std::find(names.begin(), names.end(), *text);
    if (found == names.end()) {
      throw ConfigError(fmt::format("unknown value '{}'", *text), place(*node, key),
                        "give " + choices);
    }
    chosen = static_cast<std::size_t>(found - names.begin());
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

  const toml::table& table_;
  std::string name_;
  std::set<std::string> known_;
};

toml::table parse(std::string_view text, std::string_view name) {
  if (nesting_depth(text) > kMaxNesting) {
    throw ConfigError(fmt::format("the TOML text is nested over {} levels deep", kMaxNesting),
                      std::string(name), "give keys and arrays of fewer levels");
  }
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
    table = parse(fmt::format("{} = {}", key, value), name);
  } catch (const ConfigError&) {
    table = parse(fmt::format("{} = \"{}\"", key, value), name);  // a bare word is a string
  }
  return SettingsDocument(std::make_unique<Content>(Content{std::move(table), name}));
}

bool SettingsDocument::has(std::string_view key) const {
  return content_->table.at_path(key).node() != nullptr;
}

std::vector<std::string> SettingsDocument::tables(std::string_view key, bool among_keys) const {
  std::vector<std::string> names;
  const toml::node* node = content_->table.at_path(key).node();
  if (node == nullptr) return names;
  const auto place = [&](const toml::node& where) {
    return fmt::format("{}:{}, key '{}'", content_->name, where.source().begin.line, key);
  };
  const std::string remedy = fmt::format("write [{}.NAME]", key);
  const toml::table* tables = node->as_table();
  if (tables == nullptr) throw ConfigError("this is no table", place(*node), remedy);
  for (const auto& [name, inner] : *tables) {
    if (!inner.is_table()) {
      if (among_keys) continue;
      throw ConfigError(fmt::format("'{}' is no table", name.str()), place(inner), remedy);
    }
    names.emplace_back(name.str());
    if (!is_plain_name(names.back())) {
      throw ConfigError("a name has other characters than letters, digits, '_' and '-'",
                        place(inner), "rename it");
    }
  }
  return names;
}

std::vector<SettingText> SettingsDocument::entries() const {
  std::vector<std::pair<toml::source_position, SettingText>> found;
  for_each_key(content_->table, [&](const std::string& key, const toml::node& node) {
    found.push_back({node.source().begin, {key, text_of(node)}});
  });
  std::ranges::sort(found, std::less<>(), [](const auto& entry) { return entry.first; });
  std::vector<SettingText> entries;
  for (auto& [position, entry] : found) entries.push_back(std::move(entry));
  return entries;
}

void SettingsDocument::apply(const VisitSettings& visit, const std::function<void()>& validate,
                             std::string_view help,
                             const std::function<void(std::string_view key)>& explain) const {
  Reader reader(content_->table, content_->name);
  visit(reader);
  reader.reject_unknown_keys(help, explain);
  reader.with_place(validate);
}

}  // namespace fovea
