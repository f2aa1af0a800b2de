// fovea view: a finished map in a browser.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "app/commands.h"
#include "app/drive_arguments.h"
#include "app/number_checks.h"
#include "app/view_arguments.h"
#include "app/viewer_page.h"
#include "fovea/base/errors.h"
#include "fovea/base/path_name.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/stored_calibration.h"
#include "fovea/server/map_show.h"

namespace fovea::app {
namespace {

struct ViewArguments {
  std::string map;
  DriveArguments drive;
  WebServerOptions server;
  int port = -1;
  bool no_browser = false, quiet = false;
};

/// Which of the map's frames are the drive's; InputError if the map is not of that drive.
DriveImages::Frames frames_of_drive(const MapReader& map, const ViewArguments& arguments) {
  const std::string name = name_of(arguments.drive.drive);
  const std::vector<MergedDrive> merged = merged_drives(map);
  if (!merged.empty()) {
    const auto found = std::find_if(merged.begin(), merged.end(),
                                    [&](const MergedDrive& drive) { return drive.name == name; });
    if (found != merged.end()) {
      return {found->first_frame, found->end_frame, found->frame_shift};
    }
  } else {
    const MapMeta meta = map.meta();
    const auto known = meta.find(meta_key::kDriveName);
    if (known == meta.end() || known->second == name) return {};
  }
  throw InputError(fmt::format("the map was not made of the drive '{}'", name), arguments.map,
                   "give the drive that 'fovea info' names");
}

std::shared_ptr<const DriveImages> open_images(const ViewArguments& arguments) {
  if (arguments.drive.drive.empty()) return nullptr;
  const MapReader map(arguments.map);
  const MapMeta meta = map.meta();
  const DriveImages::Frames frames = frames_of_drive(map, arguments);
  DriveArguments drive = arguments.drive;
  if (drive.cameras.empty() && meta.contains(meta_key::kCameras))
    drive.cameras = meta.at(meta_key::kCameras);
  std::unique_ptr<FrameSource> source = drive.open();
  if (has_stored_calibration(meta)) {
    source = with_stored_calibration(std::move(source), meta, arguments.map);
  }
  return std::make_shared<const DriveImages>(std::move(source), frames);
}

void run(const ViewArguments& arguments, Session& session) {
  const auto images = open_images(arguments);
  std::optional<MapShow> show;
  open_at_port(arguments.server, arguments.port, [&](const WebServerOptions& options) {
    show.emplace(arguments.map, viewer_page(), images, options);
  });
  if (!arguments.quiet) {
    fmt::print("{} is shown at {} (Ctrl-C ends)\n", arguments.map, show->url());
    std::fflush(stdout);
  }
  if (!arguments.no_browser) open_browser(show->url());
  wait_for(session.interrupt.stop_gently());
}

}  // namespace

void add_view_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ViewArguments>();
  arguments->server.threads = 2;
  CLI::App* command = app.add_subcommand("view", "Show a map in a browser");
  command->add_option("MAP.fovea", arguments->map, "Map file")->required();
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
  command->add_flag("--no-browser", arguments->no_browser, "Open no browser");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, &session] { run(*arguments, session); });
}

}  // namespace fovea::app
