// fovea repair: the whole rows of a damaged map, or a map of an older format, as a new map.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "app/command_files.h"
#include "app/commands.h"
#include "fovea/map/repair.h"

namespace fovea::app {
namespace {

struct RepairArguments {
  std::string map, output;
  bool force = false, quiet = false;
};

void run(const RepairArguments& arguments, Warnings& warnings) {
  check_files({{arguments.map}, {{arguments.output, FileKind::kMap, arguments.force}}});
  // Before a file is made: whether this is a map at all.
  const int format = MapReader(arguments.map, [](const std::string&) {}).format_version();
  const auto writer = MapWriter::create(arguments.output, arguments.force);
  const RepairFigures figures = repair_map(arguments.map, *writer, [&](const std::string& damage) {
    if (!arguments.quiet) fmt::print("left out: {}\n", damage);
  });
  if (figures.damages > 0) {
    warnings.add({fmt::format("{} lacks {} parts of {}, which cannot be read", arguments.output,
                              figures.damages, arguments.map)},
                 arguments.quiet);
  }
  if (arguments.quiet) return;
  fmt::print("{}: {} points; {} parts could not be read\n", arguments.output, figures.points,
             figures.damages);
  if (format != kMapFormatVersion) {
    fmt::print("rewritten from format {} in format {}\n", format, kMapFormatVersion);
  }
}

}  // namespace

void add_repair_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<RepairArguments>();
  CLI::App* command = app.add_subcommand(
      "repair",
      "Rewrite a map: save the whole rows of a damaged one, or update the format of an old one");
  command->add_option("MAP.fovea", arguments->map, "Map file")->required();
  command->add_option("-o,--output", arguments->output, "Map file to write")
      ->required()
      ->type_name("OUT.fovea");
  command->add_flag("--force", arguments->force, "Overwrite OUT");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, &session] { run(*arguments, session.warnings); });
}

}  // namespace fovea::app
