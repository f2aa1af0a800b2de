// Structs of options <-> keys of TOML. A struct has one function that lists its keys; it serves the
// reader and the writer alike.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace fovea {

/// An angle as it is written: 12 digits, so that 70 degrees do not come back as 70.00000000000001.
double written_degrees(double radians);

/// A number in TOML; one without fraction ends with ".0".
std::string number_text(double value);

/// A value kept in radians and written in degrees.
struct Degrees {
  double& radians;
};

/// Rows of angles, kept in radians and written as an array of arrays in degrees.
struct DegreeRows {
  std::vector<std::array<double, 4>>& radians;
  std::string_view columns;  ///< what the numbers of a row are ("[azimuth_min, ...]"), for errors
};

/// What an enumeration's values are called: names_of(Enum) returns an array of these.
template <class Enum>
struct EnumName {
  Enum value;
  std::string_view name;
};

/// A list of keys calls this with every key ("table.name"; the keys of one table in a row) and a
/// reference to its value. A reader assigns, a writer prints.
class SettingVisitor {
 public:
  virtual ~SettingVisitor() = default;

  virtual void operator()(std::string_view key, bool& value) = 0;
  virtual void operator()(std::string_view key, int& value) = 0;
  virtual void operator()(std::string_view key, double& value) = 0;
  virtual void operator()(std::string_view key, std::string& value) = 0;
  virtual void operator()(std::string_view key, std::vector<int>& value) = 0;
  /// Also read from rows, an array of arrays, one behind the other.
  virtual void operator()(std::string_view key, std::vector<double>& value) = 0;
  virtual void operator()(std::string_view key, Degrees value) = 0;
  virtual void operator()(std::string_view key, DegreeRows value) = 0;

  /// One of the values that names_of(Enum) knows.
  template <class Enum>
    requires std::is_enum_v<Enum>
  void operator()(std::string_view key, Enum& value) {
    const auto entries = names_of(Enum{});
    std::vector<std::string_view> names;
    std::size_t chosen = entries.size();
    for (const auto& entry : entries) {
      if (entry.value == value) chosen = names.size();
      names.push_back(entry.name);
    }
    choose(key, names, chosen);
    value = entries.at(chosen).value;
  }

  /// A key that need not be there: printed only if it has a value.
  template <class T>
  void operator()(std::string_view key, std::optional<T>& value) {
    if (!value && !is_given(key)) return;
    T present = value.value_or(T{});
    (*this)(key, present);
    value = present;
  }

  /// Whether the document that is read has the key, which counts as known from now on; a writer
  /// says no. For keys that are visited only sometimes.
  virtual bool is_given(std::string_view key) = 0;

 protected:
  /// @param chosen  place in `names`
  virtual void choose(std::string_view key, std::span<const std::string_view> names,
                      std::size_t& chosen) = 0;
};

/// A function that lists the keys of some options.
using VisitSettings = std::function<void(SettingVisitor&)>;

/// A key and the text of its value in TOML.
struct SettingText {
  std::string key, value;
};

/// What a user gave: TOML.
class SettingsDocument {
 public:
  /// @param name  stands for the file in errors. ConfigError with name and line for a syntax error.
  static SettingsDocument from_text(std::string_view text, std::string_view name);
  /// InputError if the file cannot be read; ConfigError as above.
  static SettingsDocument from_file(const std::filesystem::path& file);
  /// One "key=value" of the command line, the value in TOML form (a bare word is a string).
  /// @param example  what a right one looks like ("surface.spacing_m=0.03"), for errors
  static SettingsDocument from_assignment(std::string_view assignment, std::string_view example);

  ~SettingsDocument();
  SettingsDocument(SettingsDocument&&) noexcept;

  /// Whether the document has a key or table of this name.
  bool has(std::string_view key) const;

  /// Names of the tables below `key` ("camera" of [camera.left] and [camera.right]), sorted: where
  /// a list of keys depends on them. ConfigError if something below the key is no table, or has a
  /// name of other characters than letters, digits, '_' and '-'.
  /// @param among_keys  `key` may have keys of its own next to the tables
  std::vector<std::string> tables(std::string_view key, bool among_keys = false) const;

  /// All keys with their values, in the order of the text.
  std::vector<SettingText> entries() const;

  /// Assigns what the document says to the options that `visit` lists, then validates them.
  /// ConfigError naming file, line and key for an unknown key, a wrong type or what `validate`
  /// rejects (a ConfigError whose place is the key); the options are then half changed.
  /// @param help  what to do about an unknown key, after "remove it, or "
  /// @param explain  throws a ConfigError whose place is the key for an unknown key that needs
  ///                 another error than this
  void apply(const VisitSettings& visit, const std::function<void()>& validate,
             std::string_view help,
             const std::function<void(std::string_view key)>& explain = {}) const;

 private:
  struct Content;
  explicit SettingsDocument(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

/// Every key with its value.
std::vector<SettingText> setting_texts(const VisitSettings& visit);

/// The keys as TOML, which SettingsDocument::from_text reads back. Keys of one table follow each
/// other, and keys without a table come first.
std::string toml_of(std::span<const SettingText> settings);

/// Every key with its value as TOML.
std::string settings_text(const VisitSettings& visit);

}  // namespace fovea
