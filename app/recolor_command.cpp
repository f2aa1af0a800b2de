// fovea recolor: new colours for a map, without mapping again.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "app/map_arguments.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "app/progress_bar.h"
#include "fovea/core/parallel.h"
#include "fovea/drive/command_files.h"
#include "fovea/errors.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/recolor.h"
#include "fovea/pipeline/stored_calibration.h"

namespace fovea::app {
namespace {

struct RecolorArguments {
  std::string map, output, config;
  DriveArguments drive;
  std::vector<std::string> settings;
  int threads = 0;
  bool force = false, quiet = false, foreign = false;
};

/// The map's own settings, with what is to be different.
MapSettings settings_of(const RecolorArguments& arguments, const MapMeta& meta) {
  MapSettings settings = stored_settings(meta, arguments.map);
  const double tile_size = settings.tile_size();
  if (!arguments.config.empty()) apply_config_file(arguments.config, settings);
  for (const std::string& setting : arguments.settings) apply_setting(setting, settings);
  if (settings.tile_size() != tile_size) {
    throw ConfigError("the tiles of a map keep their size", "map.tile_size_m",
                      "map the drive again for another");
  }
  return settings;
}

void run(RecolorArguments arguments, Warnings& warnings) {
  check_files({{arguments.map, arguments.drive.drive, arguments.config},
               {{arguments.output, ContentKind::kMap, arguments.force}}});
  const ThreadLimit threads(arguments.threads);
  const MapReader map = open_map(arguments.map);
  const MapMeta meta = map.meta();
  RecolorJob job;
  job.output = arguments.output;
  job.settings = settings_of(arguments, meta);
  job.force = arguments.force;
  if (arguments.drive.cameras.empty() && meta.contains(meta_key::kCameras)) {
    arguments.drive.cameras = meta.at(meta_key::kCameras);
  }
  auto drive = arguments.drive.open();
  const auto match =
      find_drive_in_map(map, arguments.map, *drive, arguments.foreign, arguments.quiet);
  if (has_stored_calibration(meta)) {
    drive = with_stored_calibration(std::move(drive), meta, arguments.map);
  }
  if (match) {
    job.drive = match->drives.front();
    drive = with_map_numbers(std::move(drive), *match);
  }
  const RecolorFigures figures = [&] {
    ProgressBar bar(arguments.quiet);
    return recolor_map(map, *drive, job, [&](int done, int total) { bar.draw(done, total); });
  }();
  Messages messages = drive->info();
  if (figures.unread > 0) {
    messages.warn(fmt::format("{} frames of the map cannot be read in the drive", figures.unread));
  }
  warnings.add(messages, "note: ", arguments.quiet);
  if (arguments.quiet) return;
  print_out("{}: {} points coloured by {} frames\n", arguments.output,
            figures.points - figures.uncolored, figures.frames);
  if (figures.uncolored > 0) print_out("without colour: {} points\n", figures.uncolored);
  if (map.drives().size() > 1) {
    print_out("note: the map is of several drives: only the images of this one are used\n");
  }
  if (figures.images_left_out > 0) {
    print_out("left out: {} images, blank or exposed otherwise than the others\n",
              figures.images_left_out);
  }
}

}  // namespace

void add_recolor_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<RecolorArguments>();
  CLI::App* command = app.add_subcommand(
      "recolor", "Colour a map anew from its drive: points and poses stay as they are");
  command->add_option("MAP.fovea", arguments->map, "Map file")->required();
  command->add_option("DRIVE", arguments->drive.drive, "The drive that it was made of")->required();
  command->add_option("-o,--output", arguments->output, "Map file to write")
      ->required()
      ->type_name("OUT.fovea");
  command->add_option("--cameras", arguments->drive.cameras, "Cameras (default: the map's)")
      ->type_name("K,...");
  add_mask_option(*command, arguments->drive);
  command->add_option("--config", arguments->config, "Keys that differ from the map's settings")
      ->type_name("FILE.toml");
  command->add_option("--set", arguments->settings, "One key, may be repeated")
      ->type_name("key=value")
      ->allow_extra_args(false);
  command->add_option("--threads", arguments->threads, "Threads that may be used (default: all)")
      ->check(whole_number(0, kMaxThreads));
  add_foreign_option(*command, arguments->foreign);
  command->add_flag("--force", arguments->force, "Overwrite OUT");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, &session] { run(*arguments, session.warnings); });
}

}  // namespace fovea::app
