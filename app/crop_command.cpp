// fovea crop: a part of a map as a map of its own.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "app/commands.h"
#include "app/map_arguments.h"
#include "app/print.h"
#include "fovea/drive/command_files.h"
#include "fovea/map/crop.h"

namespace fovea::app {
namespace {

struct CropArguments {
  std::string map, output, box, polygon;
  bool force = false, quiet = false;
};

void run(const CropArguments& arguments) {
  check_files({{arguments.map}, {{arguments.output, ContentKind::kMap, arguments.force}}});
  const CropRegion region = arguments.box.empty() ? CropRegion::polygon(arguments.polygon)
                                                  : CropRegion::box(arguments.box);
  const MapReader map = open_map(arguments.map);
  const auto writer = MapWriter::create(arguments.output, arguments.force);
  const CropFigures figures = crop_map(map, region, *writer);
  if (arguments.quiet) return;
  print_out("{}: {} points, {} left out\n", arguments.output, figures.points, figures.left_out);
}

}  // namespace

void add_crop_command(CLI::App& app, Session&) {
  auto arguments = std::make_shared<CropArguments>();
  CLI::App* command = app.add_subcommand("crop", "Cut a part out of a map");
  command->add_option("MAP.fovea", arguments->map, "Map file")->required();
  command->add_option("-o,--output", arguments->output, "Map file to write")
      ->required()
      ->type_name("OUT.fovea");
  auto* region = command->add_option_group("region", "What to keep; m in the local frame");
  region->add_option("--box", arguments->box, "From corner to corner")
      ->type_name("X0,Y0,Z0,X1,Y1,Z1");
  region->add_option("--polygon", arguments->polygon, "Seen from above, at any height")
      ->type_name("\"X,Y X,Y X,Y...\"");
  region->require_option(1);
  command->add_flag("--force", arguments->force, "Overwrite OUT");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace fovea::app
