// A map's points as a LAS file, the format of surveyors.
#pragma once

#include <filesystem>
#include <optional>

#include "fovea/map/point_files/point_stream.h"
#include "fovea/time.h"

namespace fovea {

struct LasOptions {
  PointChoice points = {};
  /// How far the stamps are ahead of UTC. Absent: the kind of each drive of the map determines it.
  std::optional<TimeNs> utc_offset = {};
  bool force = false;  ///< replace an existing file
};

struct LasFigures : ExportFigures {
  std::size_t points_without_time = 0;  ///< their frames have no stamp: GPS time 0
  bool dated = true;                    ///< stamps have a date, so that times are GPS times
};

/// Writes the map's points, tile by tile, as LAS 1.4 with point format 7: positions in millimetres
/// from the map's origin rounded to a metre, intensity, colour (8 bits times 257), GPS time of the
/// scan (adjusted standard; of drives without dates the stamps themselves, as GPS week time), the
/// synthetic flag for interpolated points; CRS as WKT 1; camera, frame, range, interpolated, views,
/// spread, reason as extra bytes. The same map gives the same bytes. The file appears when it is
/// whole. OutputError if it cannot be written or exists and `force` is false; InputError as
/// PointStream, or if a point lies over 2147 km from the map's origin.
LasFigures write_las(const MapReader& map, const std::filesystem::path& path,
                     const LasOptions& options = {});

}  // namespace fovea
