// Configuration: presets, TOML files and single keys -> MapSettings, and back.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/pipeline/map_settings.h"

namespace fovea {

/// Names of the presets built in (the files config/NAME.toml), sorted.
std::vector<std::string> preset_names();

/// Settings of a preset; ConfigError for an unknown name.
MapSettings load_preset(std::string_view name);

/// Applies the keys of a TOML file. InputError if it cannot be read; ConfigError naming file, line
/// and key for a syntax error, an unknown key, a wrong type or a value out of range.
void apply_config_file(const std::filesystem::path& file, MapSettings& settings);

/// Applies TOML text; `name` stands for the file in errors.
void apply_config_text(std::string_view text, std::string_view name, MapSettings& settings);

/// Applies one "key=value" of the command line, the value in TOML form (a bare word is a string).
void apply_setting(std::string_view setting, MapSettings& settings);

/// The settings that a map stores, also a map of an earlier version.
/// @param name  stands for the map in errors
MapSettings stored_settings(std::string_view text, std::string_view name);

/// ConfigError whose place is the key of an option out of its range.
void validate(const MapSettings& settings);

/// The resolved configuration as TOML: the mapper, and every key with its value. apply_config_text
/// reads it back to the same settings.
std::string to_toml(const MapSettings& settings);

}  // namespace fovea
