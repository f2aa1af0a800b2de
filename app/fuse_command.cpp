// fovea fuse: one tile of a city from many maps.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/job_arguments.h"
#include "app/map_arguments.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "app/tile_overview.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/errors.h"
#include "fovea/merging/poses_file.h"
#include "fovea/merging/tile_fusion.h"

namespace fovea::app {
namespace {

struct FuseArguments {
  std::vector<std::string> maps;
  std::string poses, tile, output, scratch;
  std::string session = TileFusionJob().session;
  double tile_size = TileFusionJob().tile_size;
  int threads = 0;
  bool if_missing = false, force = false, quiet = false, allow_empty = false;
};

CityTile tile_of(const std::string& text) {
  const auto tile = CityTile::parse(text);
  if (tile) return *tile;
  throw ConfigError("\"" + text + "\" is no tile", "--tile", "give two whole numbers: X,Y");
}

/// Of the points of the maps, m.
double finest_spacing(const std::vector<std::string>& maps) {
  double finest = TileFusionJob().spacing;
  for (const std::string& file : maps) {
    const double spacing = stored_settings(open_map(file).meta(), file).spacing();
    if (spacing > 0) finest = std::min(finest, spacing);
  }
  return finest;
}

void run(const FuseArguments& arguments) {
  if (is_done(arguments.output, arguments.if_missing, arguments.quiet)) return;
  TileFusionJob job;
  job.tile = tile_of(arguments.tile);
  std::vector<std::string> inputs = arguments.maps;
  inputs.push_back(arguments.poses);
  check_files({inputs, {{arguments.output, ContentKind::kMap, arguments.force}}});
  const ThreadLimit threads(arguments.threads);
  job.output = arguments.output;
  job.force = arguments.force;
  job.scratch = arguments.scratch;
  job.allow_empty = arguments.allow_empty;
  job.tile_size = arguments.tile_size;
  job.session = arguments.session;
  job.spacing = finest_spacing(arguments.maps);
  const TileFusionFigures figures = fuse_with_overview(
      {arguments.maps.begin(), arguments.maps.end()}, read_city_poses(arguments.poses), job);
  if (arguments.quiet) return;
  print_out("{}: tile {}, {} points of {} maps\n", arguments.output, job.tile.text(),
            figures.points, figures.maps);
  print_out(
      "points read: {}, of surfaces that another map shows: {}, in space that is free later: "
      "{}\n",
      figures.read, figures.known, figures.parked);
}

}  // namespace

void add_fuse_command(CLI::App& app, Session& /*session*/) {
  auto arguments = std::make_shared<FuseArguments>();
  CLI::App* command = app.add_subcommand("fuse", "Write one tile of a city from many maps");
  command->add_option("MAPS", arguments->maps, "Map files around the tile")->required();
  command->add_option("--poses", arguments->poses, "Poses of the maps, by 'adjust'")
      ->required()
      ->type_name("POSES.json");
  command->add_option("--tile", arguments->tile, "Cell of the city's grid: east, north")
      ->required()
      ->type_name("X,Y");
  command->add_option("--tile-size", arguments->tile_size, "Edge of the cells, m (default: 64)")
      ->check(CLI::Range(1.0, 1000.0));
  command
      ->add_option("--session", arguments->session,
                   "Whose colors count first: best (default), latest, a recording day (2026-05-17) "
                   "or the name of a drive")
      ->type_name("SESSION");
  command->add_option("-o,--output", arguments->output, "Map file to write")
      ->required()
      ->type_name("TILE.fovea");
  command->add_option("--threads", arguments->threads, "Threads that may be used (default: all)")
      ->check(whole_number(0, kMaxThreads));
  command->add_flag("--allow-empty", arguments->allow_empty,
                    "A tile without points is a map without points, not an error");
  add_scratch_option(*command, arguments->scratch);
  add_if_missing_option(*command, arguments->if_missing);
  command->add_flag("--force", arguments->force, "Overwrite TILE.fovea");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace fovea::app
