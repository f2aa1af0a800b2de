#include "app/map_arguments.h"

#include <fmt/format.h>

#include "app/print.h"
#include "fovea/map/checked_map.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/settings_of_map.h"

namespace fovea::app {

MapReader open_map(const std::string& map) { return open_checked_map(map); }

std::vector<std::string> warnings_of_map(const MapMeta& meta) {
  const bool is_repaired = meta.contains(meta_key::kRepair);
  const auto complete = meta.find(meta_key::kComplete);
  std::vector<std::string> warnings;
  if (is_repaired) warnings.emplace_back("the map was repaired and lacks parts");
  // A repaired map may have lost the key.
  if (complete == meta.end() ? !is_repaired : complete->second != "1") {
    warnings.emplace_back("the map is unfinished: 'fovea map --resume' continues it");
  }
  return warnings;
}

MapSettings stored_settings(const MapMeta& meta, const std::string& map) {
  return settings_of_map(meta, map);
}

void add_foreign_option(CLI::App& command, bool& foreign) {
  command.add_flag("--foreign", foreign, "Accept a drive that the map was not made of");
}

std::optional<DriveMatch> find_drive_in_map(const MapReader& map, const std::string& path,
                                            const FrameSource& drive, bool foreign, bool quiet) {
  if (foreign) return std::nullopt;
  DriveMatch match = match_drive(map, drive, path);
  if (!quiet) {
    for (const std::string& note : match.notes) print_out("note: {}\n", note);
  }
  return match;
}

}  // namespace fovea::app
