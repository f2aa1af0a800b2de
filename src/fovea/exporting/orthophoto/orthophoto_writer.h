// A map seen from above, as a picture with its place on earth.
#pragma once

#include <array>
#include <filesystem>

#include "fovea/map/point_files/point_stream.h"

namespace fovea {

struct OrthophotoOptions {
  /// The CRS is local or utm; see orthophoto_crs().
  PointChoice points = {};
  double pixel = 0.05;  ///< edge, m
  /// A map without chosen points gives no files: of a city, not each tile has some.
  bool may_be_empty = false;
  bool force = false;  ///< replaces existing files
};

struct OrthophotoFigures : ExportFigures {
  int width = 0, height = 0;      ///< pixels
  std::size_t filled_pixels = 0;  ///< small gaps between pixels with points
};

/// The CRS of an orthophoto where none is chosen: utm if the map has a place on earth, else local.
Crs orthophoto_crs(const MapReader& map);

/// The files of an orthophoto: the picture, OUT.pgw and OUT.png.aux.xml.
std::array<std::filesystem::path, 3> orthophoto_files(const std::filesystem::path& path);

/// Writes the highest surface of the chosen points (TopView), north up: a PNG with transparent
/// pixels where there are no points, a world file, and the CRS as GDAL has it. Memory does not
/// grow with the map: the picture is made in stripes. The picture appears last.
/// @param path  ends in ".png"
/// ConfigError for another ending, too many pixels or geocentric coordinates; InputError as
/// PointStream or if no point is chosen; OutputError if a file exists and `force` is false, or
/// cannot be written.
OrthophotoFigures write_orthophoto(const MapReader& map, const std::filesystem::path& path,
                                   const OrthophotoOptions& options = {});

}  // namespace fovea
