// What commands that make a map of maps need to know of them.
#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fovea/map/map_store.h"
#include "fovea/pipeline/drive_match.h"
#include "fovea/pipeline/map_settings.h"

namespace fovea::app {

/// open_checked_map(), for all commands.
MapReader open_map(const std::string& map);

/// Warnings of a map that may lack parts: it was repaired, or is unfinished.
std::vector<std::string> warnings_of_map(const MapMeta& meta);

/// settings_of_map().
MapSettings stored_settings(const MapMeta& meta, const std::string& map);

/// Adds the option --foreign.
void add_foreign_option(CLI::App& command, bool& foreign);

/// The frames of a map that are the drive's (match_drive()). InputError if the map was not made of
/// the drive; nothing for a `foreign` drive. Prints what could not be compared.
/// @param path   of the map, for errors
/// @param drive  under its own calibration
std::optional<DriveMatch> find_drive_in_map(const MapReader& map, const std::string& path,
                                            const FrameSource& drive, bool foreign,
                                            bool quiet = false);

}  // namespace fovea::app
