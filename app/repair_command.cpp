// fovea repair: what is whole of a damaged map, as a map.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "app/commands.h"
#include "fovea/map/crop.h"

namespace fovea::app {
namespace {

struct RepairArguments {
  std::string map, output;
  bool force = false, quiet = false;
};

void run(const RepairArguments& arguments) {
  std::size_t damages = 0;
  const MapReader map(arguments.map, [&](const std::string& damage) {
    ++damages;
    if (!arguments.quiet) fmt::print("left out: {}\n", damage);
  });
  const auto writer = MapWriter::create(arguments.output, arguments.force);
  const CropFigures figures =
      crop_map(map, CropRegion::everything("what was whole of a damaged map"), *writer);
  if (arguments.quiet) return;
  fmt::print("{}: {} points; {} parts could not be read\n", arguments.output, figures.points,
             damages);
}

}  // namespace

void add_repair_command(CLI::App& app) {
  auto arguments = std::make_shared<RepairArguments>();
  CLI::App* command =
      app.add_subcommand("repair", "Save what is whole of a damaged map, and name what is not");
  command->add_option("MAP.fovea", arguments->map, "Map file")->required();
  command->add_option("-o,--output", arguments->output, "Map file to write")
      ->required()
      ->type_name("OUT.fovea");
  command->add_flag("--force", arguments->force, "Overwrite OUT");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace fovea::app
