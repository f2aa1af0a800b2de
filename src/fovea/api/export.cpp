#include "fovea/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/drive/command_files.h"
#include "fovea/errors.h"
#include "fovea/exporting/export_files.h"
#include "fovea/exporting/frame_formats.h"
#include "fovea/exporting/mesh/mesh_file_writer.h"
#include "fovea/exporting/mesh/mesh_tileset_writer.h"
#include "fovea/exporting/orthophoto/orthophoto_writer.h"
#include "fovea/exporting/tileset/tileset_writer.h"
#include "fovea/exporting/views/colmap_writer.h"
#include "fovea/exporting/views/nerf_writer.h"
#include "fovea/map/map_store.h"
#include "fovea/map/point_files/las_writer.h"
#include "fovea/map/point_files/pcd_writer.h"
#include "fovea/map/point_files/ply_writer.h"
#include "fovea/time.h"

namespace fovea {
namespace {

constexpr const char* kOrthophoto = "orthophoto";

std::string format_of(const std::filesystem::path& output, const ExportOptions& options) {
  std::string format = options.format;
  if (format.empty() && output.has_extension()) format = output.extension().string().substr(1);
  if (options.format.empty() && format == "png") format = kOrthophoto;
  if (std::find(kExportFormats.begin(), kExportFormats.end(), format) != kExportFormats.end()) {
    return format;
  }
  throw ConfigError(fmt::format("there is no export format '{}'", format), output.string(),
                    "give ExportOptions::format: " + export_format_names());
}

PointChoice point_choice(const MapReader& map, const ExportOptions& options) {
  PointChoice choice;
  const bool has_no_color = map.size() > 0 && map.colored_size() == 0;
  choice.include_uncolored = options.include_uncolored || has_no_color;
  if (!options.where.empty()) choice.where = PointFilter::parse(options.where);
  if (!options.crs.empty()) {
    const std::optional<Crs> crs = crs_of(options.crs);
    if (!crs) {
      throw ConfigError(fmt::format("there is no coordinate system '{}'", options.crs),
                        "ExportOptions::crs", "give local, utm or ecef");
    }
    choice.crs = *crs;
  }
  choice.exposure = parse_exposure(options.exposure);
  choice.deep_colors = options.color_depth == 16;
  return choice;
}

ExportedMap exported(const ExportFigures& figures) {
  return {.points = figures.points,
          .uncolored_left_out = figures.uncolored_left_out,
          .filtered_out = figures.filtered_out};
}

ExportedMap write_mesh(const MapReader& map, const std::filesystem::path& output,
                       const MeshOptions& options, bool is_folder) {
  if (!is_folder) {
    const MeshFigures figures = write_mesh_file(map, output, options);
    ExportedMap result = exported(figures);
    result.triangles = figures.triangles;
    return result;
  }
  const MeshTilesetFigures figures = write_mesh_tileset(map, output, options, {});
  ExportedMap result = exported(figures);
  result.triangles = figures.triangles;
  result.tiles = figures.tiles;
  return result;
}

ExportedMap write_views(const MapReader& reader, const std::filesystem::path& map,
                        const std::filesystem::path& output, const std::string& format,
                        const ExportOptions& options) {
  if (!options.crs.empty() && options.crs != "local") {
    throw ConfigError(fmt::format("the format {} has no other coordinates than local", format),
                      "ExportOptions::crs", "leave it empty");
  }
  if (options.max_points < kLeastTrainingPoints || options.max_points > kMostTrainingPoints ||
      !(options.voxel >= kLeastCell && std::isfinite(options.voxel))) {
    throw ConfigError(fmt::format("the format {} has {} to {} points of cells of {} m or more",
                                  format, kLeastTrainingPoints, kMostTrainingPoints, kLeastCell),
                      "ExportOptions", "give other values of max_points and voxel");
  }
  const auto write = format == "nerf" ? write_nerf : write_colmap;
  const ViewExportFigures figures = write(reader, map, output,
                                          {.points = point_choice(reader, options),
                                           .drive = options.drive,
                                           .max_points = options.max_points,
                                           .cell = options.voxel,
                                           .force = options.force});
  ExportedMap result = exported(figures);
  result.images = figures.images;
  result.held_out = figures.held_out;
  return result;
}

ExportedMap write_picture(const MapReader& map, const std::filesystem::path& output,
                          const ExportOptions& options) {
  OrthophotoOptions picture{
      .points = point_choice(map, options), .pixel = options.pixel, .force = options.force};
  if (options.crs.empty()) picture.points.crs = orthophoto_crs(map);
  const OrthophotoFigures figures = write_orthophoto(map, output, picture);
  ExportedMap result = exported(figures);
  result.width = figures.width;
  result.height = figures.height;
  return result;
}

ExportedMap write_points(const MapReader& map, const std::filesystem::path& output,
                         const std::string& format, const ExportOptions& options) {
  if (format == kOrthophoto) return write_picture(map, output, options);
  const PointChoice points = point_choice(map, options);
  if (format == "mesh" || format == "glb") {
    return write_mesh(map, output, {points, options.voxel, options.force}, format == "mesh");
  }
  if (format == "las") {
    LasOptions las{.points = points, .force = options.force};
    if (options.utc_offset) las.utc_offset = from_seconds(3600 * *options.utc_offset);
    return exported(write_las(map, output, las));
  }
  if (format == "3dtiles") {
    const TilesetFigures figures =
        write_tileset(map, output, {.points = points, .force = options.force});
    ExportedMap result = exported(figures);
    result.tiles = figures.tiles;
    return result;
  }
  const auto write_file = format == "pcd" ? write_pcd : write_ply;
  return exported(write_file(map, output, {points, options.double_positions, options.force}));
}

}  // namespace

ExportedMap export_map(const std::filesystem::path& map, const std::filesystem::path& output,
                       const ExportOptions& options) {
  const std::string format = format_of(output, options);
  check_files(export_files({map, output, options.drive}, format, options.force));
  const MapReader reader(map);
  if (format == "colmap" || format == "nerf") {
    return write_views(reader, map, output, format, options);
  }
  if (!is_frame_format(format)) return write_points(reader, output, format, options);
  write_frame_format(reader, format, output, options.force);
  return {};
}

}  // namespace fovea
