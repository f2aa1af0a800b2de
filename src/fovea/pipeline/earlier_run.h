// The map that a run resumes: it must be of the same drive and settings.
#pragma once

#include <filesystem>

#include "fovea/map/map_records.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// Whether all frames are in the map.
bool is_complete(const MapMeta& meta);

/// InputError if a map was made with other settings or of a drive with another calibration or other
/// stamps, or if no run can resume it. The names of drives do not count.
/// @param meta  the settings of the present run
void require_same_run(const MapReader& map, const MapMeta& meta, const DriveRecord& drive,
                      const std::filesystem::path& path);

/// Replaces texts that contain the path of the drive by those of the map: the path may differ.
void keep_names(const MapReader& map, MapMeta& meta, DriveRecord& drive);

}  // namespace fovea
