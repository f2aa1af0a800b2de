// fovea view: a finished map or a city in a browser.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "app/map_arguments.h"
#include "app/number_checks.h"
#include "app/print.h"
#include "app/view_arguments.h"
#include "app/viewer_page.h"
#include "fovea/city/city.h"
#include "fovea/errors.h"
#include "fovea/exporting/city/tile_overview.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/stored_calibration.h"
#include "fovea/server/city_content.h"
#include "fovea/server/map_server.h"

namespace fovea::app {
namespace {

struct ViewArguments {
  std::string map, exposure = "auto";
  DriveArguments drive;
  WebServerOptions server;
  int port = -1;
  bool no_browser = false, quiet = false, foreign = false;
};

std::shared_ptr<const FrameImages> open_images(const MapReader& map,
                                               const ViewArguments& arguments) {
  if (arguments.drive.drive.empty()) return nullptr;
  const MapMeta meta = map.meta();
  DriveArguments drive = arguments.drive;
  if (drive.cameras.empty() && meta.contains(meta_key::kCameras))
    drive.cameras = meta.at(meta_key::kCameras);
  std::unique_ptr<FrameSource> source = drive.open();
  const auto match =
      find_drive_in_map(map, arguments.map, *source, arguments.foreign, arguments.quiet);
  if (has_stored_calibration(meta)) {
    source = with_stored_calibration(std::move(source), meta, arguments.map);
  }
  if (match) source = with_map_numbers(std::move(source), *match);
  return std::make_shared<const DriveImages>(std::move(source));
}

/// Makes the content of a site, as often as it is called.
using MakeContent = std::function<std::unique_ptr<SiteContent>()>;

MakeContent city_content(const ViewArguments& arguments) {
  if (!arguments.drive.drive.empty()) {
    throw ConfigError("a city has many drives", "--drive", "leave it out, or view a map");
  }
  return [city = open_city(arguments.map),
          exposure = exposure_of_city(parse_exposure(arguments.exposure))] {
    return make_city_content(city, exposure);
  };
}

void run(const ViewArguments& arguments, Session& session) {
  std::shared_ptr<const FrameImages> images;
  MakeContent content;
  const bool is_of_city = is_city(arguments.map);
  if (is_of_city) {
    content = city_content(arguments);
  } else {
    // The map is not kept open: its writer could not merge the log.
    images = open_images(open_map(arguments.map), arguments);
    content = [&arguments, images, exposure = parse_exposure(arguments.exposure)] {
      return make_map_content(arguments.map, images.get(), exposure);
    };
  }
  std::optional<MapServer> show;
  open_at_port(arguments.server, arguments.port, [&](const WebServerOptions& options) {
    show.emplace(content(), viewer_page(), images, options);
  });
  if (!arguments.quiet) {
    print_out("{} is shown at {} (Ctrl-C ends)\n", arguments.map, show->url());
    std::fflush(stdout);
  }
  if (!arguments.no_browser) open_browser(show->url());
  wait_for(session.interrupt.stop_gently());
  show.reset();
  if (!is_of_city) fold_log(arguments.map);  // of a map whose writer ended in the meantime
}

}  // namespace

void add_view_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ViewArguments>();
  arguments->server.threads = 2;
  CLI::App* command = app.add_subcommand("view", "Show a map or a city in a browser");
  command
      ->add_option("MAP.fovea", arguments->map,
                   "Map file, or a city: its folder or one of its manifests")
      ->required();
  command
      ->add_option("--drive", arguments->drive.drive,
                   "The drive that the map was made of, for its cameras' images")
      ->type_name("DRIVE");
  command
      ->add_option("--cameras", arguments->drive.cameras,
                   "Cameras of the drive (default: those that the map was made of)")
      ->type_name("K,...")
      ->needs("--drive");
  command
      ->add_option("--port", arguments->port,
                   fmt::format("Port (default: {}, or another if it is taken; 0: any)", kUsualPort))
      ->check(whole_number(0, 65535));
  command
      ->add_option("--address", arguments->server.address,
                   "Address to serve at: 0.0.0.0 shows the map to all that reach this machine")
      ->capture_default_str();
  command->add_option(
      "--exposure", arguments->exposure,
      "Of the colors: auto (the median exposure of the images; of a city: map), map "
      "(the map's own), frame:N, or stops above the exposure of the map");
  add_foreign_option(*command, arguments->foreign);
  command->add_flag("--no-browser", arguments->no_browser, "Open no browser");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace fovea::app
