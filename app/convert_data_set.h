// fovea convert nuscenes and kitti360: scenes of data sets as a folder with a drive.toml.
#pragma once

#include <CLI/CLI.hpp>

#include "app/commands.h"

namespace fovea::app {

/// Adds a subcommand for each data set.
void add_data_set_commands(CLI::App& convert, Session& session);

}  // namespace fovea::app
