// fovea repair: the whole rows of a damaged map, or a map of an older format, as a new map.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>

#include "app/commands.h"
#include "app/map_arguments.h"
#include "app/print.h"
#include "fovea/drive/command_files.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/repair.h"

namespace fovea::app {
namespace {

struct RepairArguments {
  std::string map, output;
  bool force = false, quiet = false;
};

void run(const RepairArguments& arguments, Warnings& warnings) {
  check_files({{arguments.map}, {{arguments.output, ContentKind::kMap, arguments.force}}});
  // Before a file is made: whether this is a map at all.
  const int format = MapReader(arguments.map, [](const std::string&) {}).format_version();
  const auto writer = MapWriter::create(arguments.output, arguments.force);
  const RepairFigures figures = repair_map(arguments.map, *writer, [&](const std::string& damage) {
    if (!arguments.quiet) print_out("{}\n", damage);
  });
  if (figures.left_out > 0) {
    warnings.add({fmt::format("{} lacks {} parts of {}, which cannot be read", arguments.output,
                              figures.left_out, arguments.map)},
                 arguments.quiet);
  }
  if (arguments.quiet) return;
  print_out("{}: {} points; {} parts could not be read\n", arguments.output, figures.points,
            figures.left_out);
  if (!figures.restored.empty()) {
    print_out("restored from other tables: {}\n",
              fmt::format("{}", fmt::join(figures.restored, ", ")));
  }
  if (!figures.lost.empty()) {
    const bool has_calibration =
        std::count(figures.lost.begin(), figures.lost.end(), meta_key::kCalibration) == 0;
    print_out("lost: {}{}\n", fmt::format("{}", fmt::join(figures.lost, ", ")),
              has_calibration ? "" : ", and a corrected calibration, if the map had one");
  }
  if (format != kMapFormatVersion) {
    print_out("rewritten from format {} in format {}\n", format, kMapFormatVersion);
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
