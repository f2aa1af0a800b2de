// The subcommands, one file each. Each adds itself to the command line; what it does runs when the
// command line has been parsed and it was named.
#pragma once

#include <CLI/App.hpp>

#include "app/session.h"

namespace fovea::app {

void add_map_command(CLI::App& app, Session& session);
void add_info_command(CLI::App& app);
void add_evaluate_command(CLI::App& app, Session& session);
void add_convert_command(CLI::App& app, Session& session);
void add_crop_command(CLI::App& app);
void add_export_command(CLI::App& app, Session& session);
void add_localize_command(CLI::App& app, Session& session);
void add_merge_command(CLI::App& app, Session& session);
void add_render_command(CLI::App& app, Session& session);
void add_recolor_command(CLI::App& app, Session& session);
void add_repair_command(CLI::App& app, Session& session);
void add_reproduce_command(CLI::App& app, Session& session);
void add_upsample_command(CLI::App& app);
void add_register_command(CLI::App& app);
void add_settings_command(CLI::App& app);
void add_simulate_command(CLI::App& app);
void add_view_command(CLI::App& app, Session& session);

}  // namespace fovea::app
