// fovea export: a map in a form that other programs read.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/map_arguments.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "app/viewer_page.h"
#include "fovea/drive/command_files.h"
#include "fovea/exporting/frame_table.h"
#include "fovea/exporting/mesh/mesh_file_writer.h"
#include "fovea/exporting/mesh/mesh_tileset_writer.h"
#include "fovea/exporting/pose_writer.h"
#include "fovea/exporting/tileset/tileset_writer.h"
#include "fovea/map/map_store.h"
#include "fovea/map/point_files/las_writer.h"
#include "fovea/map/point_files/pcd_writer.h"
#include "fovea/map/point_files/ply_writer.h"

namespace fovea::app {
namespace {

struct ExportArguments {
  std::string map, output, format, where, crs = "local", exposure = "auto";
  PointChoice points;
  std::optional<double> utc_offset;  // h
  double voxel = MeshOptions().voxel;
  int color_depth = 8;  // bits
  bool double_positions = false, viewer = false, force = false, quiet = false;
};

constexpr const char* kFormats = "ply, pcd, las, 3dtiles, mesh, glb, frames or kitti-poses";

/// The format asked for, or else the one of the output's ending; CLI::ValidationError without
/// either.
std::string format_of(const ExportArguments& arguments) {
  if (!arguments.format.empty()) return arguments.format;
  const std::string ending = std::filesystem::path(arguments.output).extension().string();
  for (const char* format : {"ply", "pcd", "las", "glb"}) {
    if (ending == std::string(".") + format) return format;
  }
  throw CLI::ValidationError("--format",
                             fmt::format("give {}: the output's ending names none", kFormats));
}

/// What would otherwise be ignored without a word.
void check_options(const CLI::App& command, const ExportArguments& arguments,
                   const std::string& format) {
  const auto only_for = [&](const char* option, const std::vector<std::string>& formats) {
    const bool applies = std::find(formats.begin(), formats.end(), format) != formats.end();
    if (applies || command.count(option) == 0) return;
    throw CLI::ValidationError(option, fmt::format("is for {}", fmt::join(formats, ", ")));
  };
  if (format == "mesh" && std::filesystem::path(arguments.output).extension() == ".glb") {
    throw CLI::ValidationError("--format", "mesh is a folder; leave it out for one .glb file");
  }
  only_for("--crs", {"ply", "pcd", "las"});  // a tileset's root places it on earth by itself
  only_for("--double", {"ply", "pcd"});
  only_for("--utc-offset", {"las"});
  only_for("--voxel", {"mesh", "glb"});
  only_for("--viewer", {"3dtiles", "mesh"});
  only_for("--uncolored", {"ply", "pcd", "las", "3dtiles", "mesh", "glb"});
  only_for("--where", {"ply", "pcd", "las", "3dtiles", "mesh", "glb"});
  only_for("--color-depth", {"ply", "pcd", "las"});
  only_for("--exposure", {"ply", "pcd", "las", "3dtiles", "mesh", "glb"});
}

void print_figures(const ExportArguments& arguments, const ExportFigures& figures) {
  print_out("{}: {} points\n", arguments.output, figures.points);
  if (figures.uncolored_left_out > 0) {
    print_out("left out: {} points that no camera coloured (--uncolored keeps them)\n",
              figures.uncolored_left_out);
  }
  if (figures.filtered_out > 0) {
    print_out("left out: {} points that do not meet --where\n", figures.filtered_out);
  }
}

/// A warning if the times of points are missing.
std::vector<std::string> warnings_of(const LasFigures& figures) {
  if (figures.points_without_time == 0) return {};
  return {fmt::format("{} points are of frames without a stamp and have time 0",
                      figures.points_without_time)};
}

void print_mesh(const MeshFigures& figures) {
  print_out("{} triangles of {} cells with points\n", figures.triangles, figures.cells);
  if (figures.lonely_cells > 0) {
    print_out("{} cells have too few others around them for a surface\n", figures.lonely_cells);
  }
  if (figures.uncolored_vertices > 0) {
    print_out("{} vertices are grey: no coloured point is near\n", figures.uncolored_vertices);
  }
}

/// A warning if points were left out.
std::vector<std::string> warnings_of(const MeshFigures& figures) {
  if (figures.without_frame == 0) return {};
  return {fmt::format("left out: {} points of frames that the map does not have",
                      figures.without_frame)};
}

/// A surface, as levels of detail in a folder or as one file.
void write_mesh(const MapReader& map, const ExportArguments& arguments, bool levels,
                Warnings& warnings) {
  const MeshOptions options{arguments.points, arguments.voxel, arguments.force};
  if (!levels) {
    const MeshFigures figures = write_mesh_file(map, arguments.output, options);
    warnings.add(warnings_of(figures), arguments.quiet);
    if (arguments.quiet) return;
    print_figures(arguments, figures);
    print_mesh(figures);
    return;
  }
  std::map<std::string, std::string> beside;
  if (arguments.viewer) beside = viewer_files(map, viewer_page(), /*mesh=*/true);
  const MeshTilesetFigures figures = write_mesh_tileset(map, arguments.output, options, beside);
  warnings.add(warnings_of(figures), arguments.quiet);
  if (arguments.quiet) return;
  print_figures(arguments, figures);
  print_mesh(figures);
  print_out("{} tiles\n", figures.tiles);
}

CommandFiles files_of(const ExportArguments& arguments, const std::string& format) {
  CommandFiles files;
  files.inputs = {arguments.map};
  const std::map<std::string, ContentKind> kinds{
      {"ply", ContentKind::kPly},           {"pcd", ContentKind::kPcd},
      {"las", ContentKind::kLas},           {"glb", ContentKind::kGlb},
      {"frames", ContentKind::kFrameTable}, {"kitti-poses", ContentKind::kPoses}};
  if (const auto kind = kinds.find(format); kind != kinds.end()) {
    files.outputs = {{arguments.output, kind->second, arguments.force}};
  } else {
    files.folder = {arguments.output};
  }
  return files;
}

void write(const MapReader& map, ExportArguments& arguments, const std::string& format,
           Warnings& warnings) {
  if (format == "frames") {
    map.check();  // frames need no tile
    write_frame_table(map.frames(), arguments.output, arguments.force);
    return;
  }
  if (format == "kitti-poses") {
    map.check();
    write_kitti_poses(map.frames(), arguments.output, arguments.force);
    return;
  }
  if (map.size() > 0 && map.colored_size() == 0 && !arguments.points.include_uncolored) {
    arguments.points.include_uncolored = true;
    if (!arguments.quiet) print_out("the map has no colors: its points are gray\n");
  }
  if (!arguments.where.empty()) arguments.points.where = PointFilter::parse(arguments.where);
  arguments.points.crs = *crs_of(arguments.crs);
  arguments.points.exposure = parse_exposure(arguments.exposure);
  arguments.points.deep_colors = arguments.color_depth == 16;
  const auto report = [&](const ExportFigures& figures) {
    if (!arguments.quiet) print_figures(arguments, figures);
  };
  if (format == "las") {
    LasOptions options{.points = arguments.points, .force = arguments.force};
    if (arguments.utc_offset) options.utc_offset = from_seconds(3600 * *arguments.utc_offset);
    const LasFigures figures = write_las(map, arguments.output, options);
    report(figures);
    if (!arguments.quiet && !figures.dated) {
      print_out("the drive's stamps have no date: LAS has them in seconds, as GPS week time\n");
    }
    warnings.add(warnings_of(figures), arguments.quiet);
    return;
  }
  if (format == "3dtiles") {
    TilesetOptions options{.points = arguments.points, .force = arguments.force};
    if (arguments.viewer) {
      options.with_sources = true;
      options.beside = viewer_files(map, viewer_page(), /*mesh=*/false);
    }
    const TilesetFigures figures = write_tileset(map, arguments.output, options);
    report(figures);
    if (!arguments.quiet) print_out("{} tiles\n", figures.tiles);
    return;
  }
  if (format == "mesh" || format == "glb") {
    return write_mesh(map, arguments, format == "mesh", warnings);
  }
  const auto write_points = format == "pcd" ? write_pcd : write_ply;
  report(write_points(map, arguments.output,
                      {arguments.points, arguments.double_positions, arguments.force}));
}

void run(ExportArguments& arguments, const CLI::App& command, Warnings& warnings) {
  const std::string format = format_of(arguments);
  check_options(command, arguments, format);
  check_files(files_of(arguments, format));
  const MapReader map = open_map(arguments.map);
  write(map, arguments, format, warnings);
  warnings.add(warnings_of_map(map.meta()), arguments.quiet);
}

}  // namespace

void add_export_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "Write a map in a form that other programs read");
  command->add_option("MAP.fovea", arguments->map, "Map file")->required();
  command->add_option("OUT", arguments->output, "File to write, or folder of 3dtiles and mesh")
      ->required();
  command
      ->add_option("--format", arguments->format,
                   "ply, pcd, las or 3dtiles (points; the last a folder), mesh (triangles as "
                   "3dtiles, a folder), glb (triangles, a file), frames (CSV: stamps, poses "
                   "and gains), or kitti-poses (T_local_lidar a line); default: by OUT's ending")
      ->check(
          CLI::IsMember({"ply", "pcd", "las", "3dtiles", "mesh", "glb", "frames", "kitti-poses"}));
  command
      ->add_option("--crs", arguments->crs,
                   "Coordinates: local (the map's), utm (the origin's zone on WGS 84, ellipsoidal "
                   "heights) or ecef (EPSG 4978); default: local")
      ->check(CLI::IsMember({"local", "utm", "ecef"}));
  command->add_flag("--double", arguments->double_positions,
                    "PLY, PCD: positions as double, as they are in utm and ecef anyway");
  command
      ->add_option(
          "--utc-offset", arguments->utc_offset,
          "LAS: hours that the drive's clock is ahead of UTC, for GPS times; default: 0, or 2 for "
          "KITTI drives (Karlsruhe's summer time)")
      ->check(finite_range(-24.0, 24.0));
  command
      ->add_option("--voxel", arguments->voxel,
                   "mesh, glb: about the edge of the finest triangles (m), at least twice the "
                   "points' spacing; default: 0.05")
      ->check(finite_range(0.01, 10.0));
  command->add_flag("--viewer", arguments->viewer,
                    "3dtiles, mesh: with the page of 'fovea view', for any web server to show");
  command->add_flag("--uncolored", arguments->points.include_uncolored,
                    "Also points that no camera coloured, in grey with camera -1");
  command->add_option("--exposure", arguments->exposure,
                      "Of the colors: auto (the median exposure of the images), frame:N, or stops "
                      "above the exposure of the map");
  command
      ->add_option(
          "--color-depth", arguments->color_depth,
          "PLY, PCD, LAS: 16 bits a channel: 257 times the 8-bit value, not tone-mapped; auto is "
          "then the exposure of the map, lowered until 0.1 % of the points are cut off; "
          "default: 8")
      ->check(CLI::IsMember({8, 16}));
  command->add_option(
      "--where", arguments->where,
      "Only points that meet conditions, e.g. \"views >= 2 and range < 10\"; fields: "
      "views, spread, range, incidence (degrees), frame, camera, rule (measured, short-edges, "
      "planar, centroid), matched (exposure, 0 or 1), interpolated, intensity");
  command->add_flag("--force", arguments->force, "Overwrite OUT");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback(
      [arguments, command, &session] { run(*arguments, *command, session.warnings); });
}

}  // namespace fovea::app
