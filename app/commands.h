// The subcommands of this build. Each is one file, NAME_command.cpp, with the function
// add_NAME_command(), which adds the subcommand to the command line.
#pragma once

#include <CLI/App.hpp>
#include <span>

#include "app/session.h"

namespace fovea::app {

using AddCommand = void (*)(CLI::App& app, Session& session);

/// In the order of --help. app/CMakeLists.txt lists them and leaves out those whose parts this
/// build does not have.
std::span<const AddCommand> commands();

void add_map_command(CLI::App& app, Session& session);
void add_catalog_command(CLI::App& app, Session& session);
void add_check_command(CLI::App& app, Session& session);
void add_calibrate_command(CLI::App& app, Session& session);
void add_info_command(CLI::App& app, Session& session);
void add_evaluate_command(CLI::App& app, Session& session);
void add_convert_command(CLI::App& app, Session& session);
void add_crop_command(CLI::App& app, Session& session);
void add_export_command(CLI::App& app, Session& session);
void add_localize_command(CLI::App& app, Session& session);
void add_adjust_command(CLI::App& app, Session& session);
void add_fuse_command(CLI::App& app, Session& session);
void add_align_command(CLI::App& app, Session& session);
void add_merge_command(CLI::App& app, Session& session);
void add_render_command(CLI::App& app, Session& session);
void add_recolor_command(CLI::App& app, Session& session);
void add_repair_command(CLI::App& app, Session& session);
void add_reproduce_command(CLI::App& app, Session& session);
void add_upsample_command(CLI::App& app, Session& session);
void add_register_command(CLI::App& app, Session& session);
void add_settings_command(CLI::App& app, Session& session);
void add_simulate_command(CLI::App& app, Session& session);
void add_view_command(CLI::App& app, Session& session);

}  // namespace fovea::app
