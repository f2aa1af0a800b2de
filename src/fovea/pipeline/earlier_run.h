// Checks of the map that a run resumes: same drive, same settings.
#pragma once

#include <filesystem>

#include "fovea/drive/frame_source.h"
#include "fovea/map/map_records.h"
#include "fovea/map/map_store.h"
#include "fovea/pipeline/map_drive.h"

namespace fovea {

/// Whether all frames are in the map.
bool is_complete(const MapMeta& meta);

/// Throws InputError if no run can resume the map, or if the settings or the calibration, stamps or
/// scans of the drive differ. The names of drives do not count.
/// @param meta    the settings of the present run
/// @param record  of `drive`, before any correction of the calibration
void require_same_run(const MapReader& map, const MapMeta& meta, const DriveRecord& record,
                      const FrameSource& drive, const std::filesystem::path& path);

/// The same of a map of a live drive, whose frames continue those of the map. Takes the first frame
/// of the map into `meta` and `record`, and its navigation if this run begins without.
void require_same_live_run(const MapReader& map, MapMeta& meta, DriveRecord& record,
                           const std::filesystem::path& path);

/// The summary of a complete map that a run would resume; nothing if frames are missing.
/// @param meta  the settings of the present run
std::optional<MapSummary> complete_run(const FrameSource& source, const DriveInfo& drive,
                                       const MapJob& job, const MapMeta& meta);

/// Replaces texts that contain the path of the drive by those of the map, since the path may
/// differ.
void keep_names(const MapReader& map, MapMeta& meta, DriveRecord& drive);

}  // namespace fovea
