// Options of the steps that a job engine runs (docs/city.md).
#pragma once

#include <CLI/App.hpp>
#include <string>

namespace fovea::app {

/// Adds --if-missing.
/// @return the option
CLI::Option* add_if_missing_option(CLI::App& command, bool& if_missing);

/// Adds --scratch.
/// @return the option
CLI::Option* add_scratch_option(CLI::App& command, std::string& scratch);

/// Whether a step is done already: the output exists, and --if-missing was given. Says so.
bool is_done(const std::string& output, bool if_missing, bool quiet);

}  // namespace fovea::app
