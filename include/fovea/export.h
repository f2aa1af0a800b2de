// Maps in forms that other programs read.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

struct ExportOptions {
  /// "ply", "pcd", "las", "3dtiles" (a folder), "mesh" (a folder), "glb", "orthophoto" (PNG),
  /// "colmap" or "nerf" (posed images and points, a folder), or, of the frames, "tum", "csv",
  /// "geojson", "frames" (CSV with gains) or "kitti-poses"; empty: by the ending of the output.
  std::string format = {};
  /// "local", "utm" or "ecef"; empty: local, and utm of an orthophoto of a map on earth
  std::string crs = {};
  std::string where = {};          ///< "height < 2 and views >= 2"; empty: all points
  std::string exposure = "auto";   ///< "auto", "map", "frame:N" or stops above that of the map
  bool include_uncolored = false;  ///< also points that no camera saw, in gray
  bool double_positions = false;   ///< PLY and PCD
  int color_depth = 8;             ///< bits of a channel, 8 or 16; PLY, PCD and LAS
  /// Mesh and glb: about the edge of the finest triangles; colmap and nerf: one point in each cell
  /// of this edge, m.
  double voxel = 0.05;
  std::size_t max_points = 500'000;       ///< colmap and nerf: cells grow until there are no more
  std::filesystem::path drive = {};       ///< colmap and nerf: its images are written, too
  double pixel = 0.05;                    ///< orthophoto: edge of a pixel, m
  std::optional<double> utc_offset = {};  ///< LAS: h that the drive's clock is ahead of UTC
  bool force = false;                     ///< replaces the output
};

struct ExportedMap {
  std::size_t points = 0;  ///< or vertices of the points that a mesh was made of
  std::size_t uncolored_left_out = 0, filtered_out = 0;
  std::size_t tiles = 0;      ///< of a tileset
  std::size_t triangles = 0;  ///< of a mesh
  int width = 0, height = 0;  ///< of an orthophoto, pixels
  std::size_t images = 0;     ///< of colmap and nerf, with those held out
  std::size_t held_out = 0;   ///< images
};

/// Writes a map in another form (docs/exports.md).
/// @throws ConfigError  for an option that there is not
/// @throws InputError   if the map is missing or damaged, or lacks the coordinates that are wanted
/// @throws OutputError  if the output exists, except with `force`, or cannot be written
FOVEA_API ExportedMap export_map(const std::filesystem::path& map,
                                 const std::filesystem::path& output,
                                 const ExportOptions& options = {});

}  // namespace fovea
