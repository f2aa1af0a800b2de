// What a map states of the run that makes it.
#pragma once

#include "fovea/map/map_records.h"
#include "fovea/pipeline/map_drive.h"

namespace fovea {

/// Drive, settings and options of a run. An earlier run is resumed only with the same.
MapMeta meta_of_run(const DriveInfo& drive, const MapJob& job);

/// States where `local` lies; absent: the map is not georeferenced.
void set_origin(const std::optional<GeodeticPoint>& origin, MapMeta& meta);

}  // namespace fovea
