// fovea render: a picture of a map, or a whole drive through it.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "app/map_arguments.h"
#include "app/number_checks.h"
#include "app/render_drive.h"
#include "app/render_views.h"
#include "fovea/city/city.h"
#include "fovea/core/output_file.h"
#include "fovea/drive/command_files.h"
#include "fovea/drive/writers/png_encode.h"
#include "fovea/errors.h"
#include "fovea/evaluation/map_picture.h"
#include "fovea/geometry/lidar_data_sheet.h"

namespace fovea::app {
namespace {

struct RenderArguments {
  RenderDriveArguments path;  // with --poses
  std::string map, drive, output, view = "behind";
  std::string camera = "2";
  std::string exposure;  // empty: as the photograph, without one as auto
  std::string from, to;  // places of a free camera
  int frame = -1, width = 1280, height = 720;
  bool force = false, foreign = false;
};

/// What would otherwise be ignored without a word.
void check_options(const CLI::App& command, const RenderArguments& arguments) {
  const bool drive = command.count("--poses") > 0;
  if (is_city(arguments.map) && (drive || arguments.drive.empty())) {
    throw ConfigError("of a city only pictures with DRIVE are made, without --poses", arguments.map,
                      "give one of its drives, or a tile");
  }
  for (const char* option : {"--view", "--frame", "--width", "--height", "--from", "--to"}) {
    if (drive && command.count(option) > 0) {
      throw CLI::ValidationError(option, "is for a single picture, without --poses");
    }
  }
  for (const char* option : {"--cameras", "--lidar", "--rate", "--reach", "--threads", "--quiet"}) {
    if (!drive && command.count(option) > 0) throw CLI::ValidationError(option, "needs --poses");
  }
}

CommandFiles files_of(const RenderArguments& arguments) {
  CommandFiles files;
  files.inputs = {arguments.map, arguments.drive, arguments.path.poses, arguments.camera};
  if (arguments.path.poses.empty()) {
    files.outputs = {{arguments.output, ContentKind::kPng, arguments.force}};
  } else {
    files.folder = {arguments.output};
  }
  return files;
}

PictureOptions options_of(const RenderArguments& arguments) {
  PictureOptions options;
  options.view = arguments.view;
  if (!arguments.from.empty()) options.free_view = parse_free_view(arguments.from, arguments.to);
  options.frame = arguments.frame;
  options.width = arguments.width;
  options.height = arguments.height;
  options.exposure = arguments.exposure;
  return options;
}

Image picture_of(const RenderArguments& arguments) {
  const PictureOptions options = options_of(arguments);
  const auto drive = [&] {
    auto source = DriveArguments{arguments.drive, "", arguments.camera, {}}.open();
    return PhotographedDrive{std::move(source), arguments.drive, arguments.foreign};
  };
  if (is_city(arguments.map)) {
    const City city = open_city(arguments.map);
    return draw_above_photograph(city, arguments.map, drive(), options);
  }
  const MapReader reader = open_map(arguments.map);
  if (arguments.drive.empty()) return draw_map(reader, arguments.map, options);
  return draw_above_photograph(reader, arguments.map, drive(), options);
}

void run(const RenderArguments& arguments) {
  OutputFile output(arguments.output, arguments.force);
  const std::vector<std::uint8_t> png = encode_png(picture_of(arguments));
  output.stream().write(reinterpret_cast<const char*>(png.data()),
                        static_cast<std::streamsize>(png.size()));
  output.commit();
}

}  // namespace

void add_render_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand("render", "Draw a picture of a map");
  command->add_option("MAP", arguments->map, "Map file; with DRIVE also a city")->required();
  command->add_option("DRIVE", arguments->drive,
                      "Draw what a camera of this drive sees, above its photograph");
  command->add_option("-o,--output", arguments->output, "Picture to write, or with --poses a drive")
      ->required()
      ->type_name("OUT.png|DIR");
  command
      ->add_option("--camera", arguments->camera,
                   "Camera of DRIVE; with --poses calib (all of DRIVE's), W,H,fx,fy,cx,cy, or a "
                   "drive or calibration folder")
      ->capture_default_str();
  CLI::Option* view =
      command
          ->add_option("--view", arguments->view,
                       "Without DRIVE: driver, behind or above the vehicle, or map: all of it from "
                       "above")
          ->capture_default_str()
          ->check(CLI::IsMember({"driver", "behind", "above", "map"}));
  CLI::Option* from =
      command
          ->add_option("--from", arguments->from,
                       "Without DRIVE: a free camera at this place of the local frame, m")
          ->type_name("X,Y,Z")
          ->excludes(view);
  CLI::Option* to = command->add_option("--to", arguments->to, "Where the free camera looks")
                        ->type_name("X,Y,Z")
                        ->needs(from);
  from->needs(to);
  command->add_option("--frame", arguments->frame, "From where the vehicle was (default: half way)")
      ->check(whole_number(0))
      ->excludes(from);
  command->add_option("--width", arguments->width, "Pixels")
      ->capture_default_str()
      ->check(whole_number(16, 8192));
  command->add_option("--height", arguments->height, "Pixels")
      ->capture_default_str()
      ->check(whole_number(16, 8192));
  command->add_option("--exposure", arguments->exposure,
                      "Of the colors: auto (the median exposure of the images), frame:N, or stops "
                      "above the exposure of the map (default: that of the photograph, else auto)");
  command->add_flag("--force", arguments->force, "Overwrite OUT");
  add_foreign_option(*command, arguments->foreign);
  RenderDriveArguments& path = arguments->path;
  command->add_option("--poses", path.poses,
                      "Render a drive: images, depth and scans at each pose T_local_lidar of this "
                      "file (docs/rendering.md)");
  command->add_option(
      "--cameras", path.cameras,
      "Which of the cameras there (default: those that map takes; all of a calibration folder)");
  command
      ->add_option("--lidar", path.lidar,
                   fmt::format("Scans, too, of one of {}", fmt::join(lidar_model_names(), ", ")))
      ->check(CLI::IsMember(lidar_model_names()));
  command->add_option("--rate", path.rate, "Frames a second")
      ->capture_default_str()
      ->check(finite_range(0.1, 1000));
  command->add_option("--reach", path.reach, "How far is seen, m")
      ->capture_default_str()
      ->check(finite_range(1, 1000));
  command->add_option("--threads", path.threads, "At most this many threads (default: all)")
      ->check(whole_number(0, kMaxThreads));
  command->add_flag("--quiet", path.quiet, "Say nothing but errors");
  command->callback([arguments, command, &session] {
    check_options(*command, *arguments);
    check_files(files_of(*arguments));
    RenderDriveArguments& drive = arguments->path;
    if (drive.poses.empty()) return run(*arguments);
    drive.map = arguments->map;
    drive.output = arguments->output;
    if (command->count("--camera") > 0) drive.camera = arguments->camera;
    drive.drive = arguments->drive;
    drive.force = arguments->force;
    drive.foreign = arguments->foreign;
    if (!arguments->exposure.empty()) drive.exposure = parse_exposure(arguments->exposure);
    render_drive_command(drive, session.warnings);
  });
}

}  // namespace fovea::app
