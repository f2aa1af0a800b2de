// Configuration of the simulator: TOML files and single keys -> SimulationOptions, and back. Scene,
// seed and number of frames are no keys: they say which drive is wanted, not how it is.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "fovea/simulation/simulation_options.h"

namespace fovea {

/// Applies the keys of a TOML file. InputError if it cannot be read; ConfigError naming file, line
/// and key for a syntax error, an unknown key, a wrong type or a value out of range. The options
/// are then as before.
void apply_config_file(const std::filesystem::path& file, SimulationOptions& options);

/// Applies TOML text; `name` stands for the file in errors.
void apply_config_text(std::string_view text, std::string_view name, SimulationOptions& options);

/// Applies one "key=value" of the command line, the value in TOML form (a bare word is a string).
void apply_setting(std::string_view setting, SimulationOptions& options);

/// The configuration as TOML: every key with its value; apply_config_text reads it back to the same
/// options.
std::string to_toml(const SimulationOptions& options);

}  // namespace fovea
