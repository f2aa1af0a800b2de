// fovea export: a map or a city in a form that other programs read.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/export_city.h"
#include "app/export_map.h"
#include "app/job_arguments.h"
#include "app/number_checks.h"
#include "fovea/city/city.h"
#include "fovea/drive/command_files.h"
#include "fovea/exporting/export_files.h"

namespace fovea::app {
namespace {

/// The format asked for, or else the one of the output's ending; CLI::ValidationError without
/// either.
std::string format_of(const ExportArguments& arguments) {
  if (!arguments.format.empty()) return arguments.format;
  const std::string ending = std::filesystem::path(arguments.output).extension().string();
  if (ending == ".png") return "orthophoto";
  for (const char* format : {"ply", "pcd", "las", "glb", "tum", "csv", "geojson"}) {
    if (ending == std::string(".") + format) return format;
  }
  throw CLI::ValidationError(
      "--format", fmt::format("give {}: the output's ending names none", export_format_names()));
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
  const std::vector<std::string> with_points = {"ply", "pcd",    "las",  "3dtiles",   "mesh",
                                                "glb", "colmap", "nerf", "orthophoto"};
  // A tileset's root places it on earth by itself.
  only_for("--crs", {"ply", "pcd", "las", "orthophoto"});
  only_for("--pixel", {"orthophoto"});
  only_for("--double", {"ply", "pcd"});
  only_for("--utc-offset", {"las"});
  only_for("--voxel", {"mesh", "glb", "colmap", "nerf"});
  only_for("--drive", {"colmap", "nerf"});
  only_for("--max-points", {"colmap", "nerf"});
  only_for("--viewer", {"3dtiles", "mesh"});
  only_for("--root-only", {"3dtiles"});
  only_for("--uncolored", with_points);
  only_for("--where", with_points);
  only_for("--color-depth", {"ply", "pcd", "las"});
  only_for("--exposure", with_points);
  if (!arguments.root_only) return;
  for (const char* option : {"--uncolored", "--where", "--exposure"}) {
    if (command.count(option) == 0) continue;
    throw CLI::ValidationError(option, "is for the tiles: the root has their points");
  }
}

CommandFiles files_of(const ExportArguments& arguments, const std::string& format,
                      bool is_of_city) {
  if (!is_of_city) {
    return export_files({arguments.map, arguments.output, arguments.drive}, format,
                        arguments.force);
  }
  CommandFiles files;
  files.inputs = {arguments.map};
  files.folder = {arguments.output, arguments.root_only ? FolderUse::kAddTo : FolderUse::kReplace};
  return files;
}

void run(ExportArguments& arguments, const CLI::App& command, Warnings& warnings) {
  const bool is_of_city = is_city(arguments.map);
  if (is_of_city && arguments.format.empty()) {
    throw CLI::ValidationError("--format", "give it for a city, whose export is a folder");
  }
  const std::string format = format_of(arguments);
  check_options(command, arguments, format);
  if (arguments.root_only && !is_of_city) {
    throw CLI::ValidationError("--root-only", "is for a city");
  }
  if (is_done(arguments.output, arguments.if_missing, arguments.quiet)) return;
  check_files(files_of(arguments, format, is_of_city));
  const auto write = is_of_city ? export_city : export_map;
  write(arguments, format, warnings);
}

}  // namespace

void add_export_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "Write a map or a city in a form that other programs read");
  command
      ->add_option("MAP.fovea", arguments->map,
                   "Map file, or a city: its folder or one of its manifests")
      ->required();
  command
      ->add_option("OUT", arguments->output,
                   "File to write, or folder of 3dtiles and mesh and of all formats of a city")
      ->required();
  command
      ->add_option("--format", arguments->format,
                   "ply, pcd, las or 3dtiles (points; the last a folder), mesh (triangles as "
                   "3dtiles, a folder), glb (triangles, a file), orthophoto (a PNG "
                   "with a world file), colmap or nerf (posed images and points, a "
                   "folder), tum, csv or geojson (where the LiDAR was), "
                   "frames (CSV: stamps, poses and gains), or kitti-poses (T_local_lidar a line); "
                   "default: by OUT's ending")
      ->check(
          CLI::IsMember(std::vector<std::string>(kExportFormats.begin(), kExportFormats.end())));
  command
      ->add_option(
          "--crs", arguments->crs,
          "Coordinates: local (the map's), utm (the origin's zone on WGS 84, ellipsoidal "
          "heights) or ecef (EPSG 4978); default: local, of a city and of an orthophoto on "
          "earth utm")
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
                   "points' spacing; colmap, nerf: one point in each cell of this edge; default: "
                   "0.05")
      ->check(finite_range(0.01, 10.0));
  command
      ->add_option("--drive", arguments->drive,
                   "colmap, nerf: the drive that the map was made of, whose images are written")
      ->type_name("DRIVE");
  command
      ->add_option("--max-points", arguments->max_points,
                   "colmap, nerf: cells grow until there are at most this many points")
      ->capture_default_str()
      ->check(whole_number(kLeastTrainingPoints, kMostTrainingPoints));
  command->add_option("--pixel", arguments->pixel, "orthophoto: edge of a pixel (m)")
      ->capture_default_str()
      ->check(finite_range(0.001, 100.0));
  command->add_flag("--viewer", arguments->viewer,
                    "3dtiles, mesh: with the page of 'fovea view', for any web server to show");
  command->add_flag("--root-only", arguments->root_only,
                    "3dtiles of a city: only the root, above the tiles' tilesets OUT/X_Y");
  command->add_flag("--uncolored", arguments->points.include_uncolored,
                    "Also points that no camera coloured, in grey with camera -1");
  command->add_option(
      "--exposure", arguments->exposure,
      "Of the colors: auto (the median exposure of the images; of a city: map), map "
      "(the map's own), frame:N, or stops above the exposure of the map");
  command
      ->add_option(
          "--color-depth", arguments->color_depth,
          "PLY, PCD, LAS: 16 bits a channel: 257 times the 8-bit value, not tone-mapped; auto is "
          "then the exposure of the map, lowered until 0.1 % of the points are cut off; "
          "default: 8")
      ->check(CLI::IsMember({8, 16}));
  command->add_option(
      "--where", arguments->where,
      "Only points that meet conditions, e.g. \"height < 2 and views >= 2\"; fields: x, y, z (m, "
      "local), height (m above the road), views, spread, range, incidence (degrees), frame, "
      "camera, rule (measured, short-edges, planar, centroid), matched (exposure, 0 or 1), "
      "interpolated, intensity");
  add_if_missing_option(*command, arguments->if_missing);
  command->add_flag("--force", arguments->force, "Overwrite OUT");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback(
      [arguments, command, &session] { run(*arguments, *command, session.warnings); });
}

}  // namespace fovea::app
