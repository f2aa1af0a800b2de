// Configuration: presets, TOML files and single keys -> MapperOptions, and back.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/pipeline/mapper_options.h"

namespace fovea {

/// Names of the presets built in (the files config/NAME.toml), sorted.
std::vector<std::string> preset_names();

/// Options of a preset; ConfigError for an unknown name.
MapperOptions load_preset(std::string_view name);

/// Applies the keys of a TOML file. InputError if it cannot be read; ConfigError naming file, line
/// and key for a syntax error, an unknown key, a wrong type or a value out of range.
void apply_config_file(const std::filesystem::path& file, MapperOptions& options);

/// Applies TOML text; `name` stands for the file in errors.
void apply_config_text(std::string_view text, std::string_view name, MapperOptions& options);

/// Applies one "key=value" of the command line, the value in TOML form (a bare word is a string).
void apply_setting(std::string_view setting, MapperOptions& options);

/// The resolved configuration as TOML: every key with its value; apply_config_text reads it back to
/// the same options.
std::string to_toml(const MapperOptions& options);

}  // namespace fovea
