// fovea export: a map in a form that other programs read.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>

#include "app/commands.h"
#include "fovea/exporting/ply_writer.h"
#include "fovea/exporting/pose_writer.h"
#include "fovea/map/map_store.h"

namespace fovea::app {
namespace {

struct ExportArguments {
  std::string map, output, format, where;
  PlyOptions ply;
  bool quiet = false;
};

/// The format asked for, or else the one of the output's ending; CLI::ValidationError without
/// either.
std::string format_of(const ExportArguments& arguments) {
  if (!arguments.format.empty()) return arguments.format;
  if (std::filesystem::path(arguments.output).extension() == ".ply") return "ply";
  throw CLI::ValidationError("--format",
                             "give ply or kitti-poses: the output's ending names neither");
}

void run(ExportArguments& arguments) {
  const std::string format = format_of(arguments);
  const MapReader map(arguments.map);
  if (format == "kitti-poses") {
    write_kitti_poses(map.frames(), arguments.output, arguments.ply.force);
    return;
  }
  if (!arguments.where.empty()) arguments.ply.where = PointFilter::parse(arguments.where);
  const PlyFigures figures = write_ply(map, arguments.output, arguments.ply);
  if (arguments.quiet) return;
  fmt::print("{}: {} points\n", arguments.output, figures.points);
  if (figures.uncolored_left_out > 0) {
    fmt::print("left out: {} points that no camera coloured (--uncolored keeps them)\n",
               figures.uncolored_left_out);
  }
  if (figures.filtered_out > 0) {
    fmt::print("left out: {} points that do not meet --where\n", figures.filtered_out);
  }
}

}  // namespace

void add_export_command(CLI::App& app) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command =
      app.add_subcommand("export", "Write a map in a form that other programs read");
  command->add_option("MAP.fovea", arguments->map, "Map file")->required();
  command->add_option("OUT", arguments->output, "File to write")->required();
  command
      ->add_option("--format", arguments->format,
                   "ply (points) or kitti-poses (T_local_lidar a line); default: by OUT's ending")
      ->check(CLI::IsMember({"ply", "kitti-poses"}));
  command->add_flag("--double", arguments->ply.double_positions, "PLY positions as double");
  command->add_flag("--uncolored", arguments->ply.include_uncolored,
                    "PLY: also points that no camera coloured, in grey with camera -1");
  command->add_option(
      "--where", arguments->where,
      "PLY: only points that meet conditions, e.g. \"views >= 2 and range < 10\"; fields: "
      "views, spread, range, incidence (degrees), frame, camera, rule (measured, short-edges, "
      "planar, centroid), matched (exposure, 0 or 1), interpolated, intensity");
  command->add_flag("--force", arguments->ply.force, "Overwrite OUT");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace fovea::app
