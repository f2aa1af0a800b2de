// A map's points as a PLY file, which nearly every point-cloud program reads.
#pragma once

#include <cstddef>
#include <filesystem>

#include "fovea/map/map_store.h"
#include "fovea/map/point_filter.h"

namespace fovea {

/// Colour of points that no camera has coloured, so that no program shows them as black things.
inline constexpr Rgb kUncolored{128, 128, 128};

struct PlyOptions {
  bool double_positions = false;   ///< x y z as double: keeps 0.1 mm beyond 1 km from the origin
  bool include_uncolored = false;  ///< also points that no camera has coloured: grey, camera -1
  PointFilter where = {};          ///< only points that pass
  bool force = false;              ///< replace an existing file
};

struct PlyFigures {
  std::size_t points = 0;  ///< written
  std::size_t uncolored_left_out = 0;
  std::size_t filtered_out = 0;  ///< by `where`, of the others
};

/// Writes the map's points, tile by tile, as binary little endian PLY: x y z (m, local frame), red
/// green blue (uchar), camera (char), frame (int), range (float, m), interpolated, views, spread,
/// reason (uchar). The file appears when it is whole. OutputError if it cannot be written or exists
/// and `force` is false; InputError if the map is damaged or grows meanwhile.
PlyFigures write_ply(const MapReader& map, const std::filesystem::path& path,
                     const PlyOptions& options = {});

}  // namespace fovea
