// The functions of settings.h that print.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <sstream>
#include <stdexcept>

#include "fovea/core/angle.h"
#include "fovea/core/settings.h"

namespace fovea {
namespace {

/// Prints every key.
class Writer : public SettingVisitor {
 public:
  void operator()(std::string_view key, bool& value) override {
    print(key, value ? "true" : "false");
  }
  void operator()(std::string_view key, int& value) override {
    print(key, fmt::format("{}", value));
  }
  void operator()(std::string_view key, double& value) override { print(key, number_text(value)); }
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
    for (const double number : value) numbers.push_back(number_text(number));
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

  std::vector<SettingText> take() { return std::move(texts_); }

 protected:
  void choose(std::string_view key, std::span<const std::string_view> names,
              std::size_t& chosen) override {
    if (chosen >= names.size()) throw std::logic_error("an enumeration value has no name");
    print(key, fmt::format("\"{}\"", names[chosen]));
  }

 private:
  void print(std::string_view key, std::string value) {
    texts_.push_back({std::string(key), std::move(value)});
  }
  static std::string degrees_text(double radians) { return number_text(written_degrees(radians)); }

  std::vector<SettingText> texts_;
};

}  // namespace

double written_degrees(double radians) {
  return std::stod(fmt::format("{:.12g}", radians / kDegree));
}

std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

std::vector<SettingText> setting_texts(const VisitSettings& visit) {
  Writer writer;
  visit(writer);
  return writer.take();
}

std::string toml_of(std::span<const SettingText> settings) {
  std::string text, table;
  for (const auto& [key, value] : settings) {
    const std::size_t dot = key.find('.');
    const std::string of = dot == std::string::npos ? "" : key.substr(0, dot);
    if (of != table) {
      text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", of);
      table = of;
    }
    text += fmt::format("{} = {}\n", dot == std::string::npos ? key : key.substr(dot + 1), value);
  }
  return text;
}

std::string settings_text(const VisitSettings& visit) { return toml_of(setting_texts(visit)); }

}  // namespace fovea
