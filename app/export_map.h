// What `fovea export` does with one map.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "app/warnings.h"
#include "fovea/exporting/mesh/mesh_file_writer.h"
#include "fovea/exporting/orthophoto/orthophoto_writer.h"
#include "fovea/exporting/views/view_export.h"
#include "fovea/map/point_files/point_stream.h"

namespace fovea::app {

struct ExportArguments {
  std::string map, output, format, where, crs, exposure = "auto";
  PointChoice points;
  std::optional<double> utc_offset;  // h
  double voxel = MeshOptions().voxel;
  double pixel = OrthophotoOptions().pixel;
  int color_depth = 8;  // bits
  std::string drive;    // whose images are written, too, or empty
  std::size_t max_points = kTrainingPoints;
  bool double_positions = false, viewer = false, root_only = false;
  bool may_be_empty = false;  // no orthophoto of a map without chosen points
  bool if_missing = false, force = false, quiet = false;
};

/// Files that lie next to a tileset: their bytes, by their place in the folder.
using FilesBeside = std::map<std::string, std::string>;

struct PointExport {
  ExportFigures figures;
  std::size_t tiles = 0;                // of a tileset
  int width = 0, height = 0;            // pixels of an orthophoto
  std::size_t points_without_time = 0;  // in LAS
  bool dated = true;                    // LAS has the times of a calendar
};

/// Sets `arguments.points` by the texts of the other arguments.
void parse_point_choice(ExportArguments& arguments);

/// Writes the points of a map.
/// @param format  ply, pcd, las, 3dtiles or orthophoto
PointExport write_points(const MapReader& map, const std::string& output,
                         const ExportArguments& arguments, const std::string& format,
                         const FilesBeside& beside = {});

/// Prints what was written, and adds warnings.
void report_points(const PointExport& written, const ExportArguments& arguments,
                   const std::string& format, Warnings& warnings);

void export_map(ExportArguments& arguments, const std::string& format, Warnings& warnings);

}  // namespace fovea::app
