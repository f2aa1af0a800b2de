// fovea convert: recordings of ROS 2 and ROS 1 as a folder with a drive.toml.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/print.h"
#include "app/progress_bar.h"
#include "fovea/core/errors.h"
#include "fovea/drive/command_files.h"
#include "fovea/drive/recordings/convert_bags.h"
#include "fovea/drive/writers/camera_name.h"

namespace fovea::app {
namespace {

struct ConvertArguments {
  std::vector<std::string> bags, cameras;
  std::string output, poses = "auto";
  ConvertOptions options;
  bool force = false, quiet = false;
};

const std::map<std::string, NavigationSource> kSources = {{"auto", NavigationSource::kAuto},
                                                          {"gnss", NavigationSource::kGnss},
                                                          {"odometry", NavigationSource::kOdometry},
                                                          {"tf", NavigationSource::kTf},
                                                          {"none", NavigationSource::kNone}};

/// NAME=TOPIC of each.
std::vector<ConvertOptions::CameraTopic> parse_camera_topics(
    const std::vector<std::string>& texts) {
  std::vector<ConvertOptions::CameraTopic> cameras;
  std::set<std::string> names, topics;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    if (equals == std::string::npos || !is_camera_name(name) || !names.insert(name).second ||
        !topics.insert(text.substr(equals + 1)).second) {
      throw ConfigError("this names no camera, or one or its topic twice", "--camera " + text,
                        "give NAME=TOPIC, the name of letters, digits, '_' and '-'");
    }
    cameras.push_back({name, text.substr(equals + 1)});
  }
  return cameras;
}

void run(const ConvertArguments& arguments, Warnings& warnings) {
  check_files({arguments.bags, {}, {arguments.output}});
  ConvertOptions options = arguments.options;
  options.cameras = parse_camera_topics(arguments.cameras);
  options.poses = kSources.at(arguments.poses);
  const std::vector<std::filesystem::path> bags(arguments.bags.begin(), arguments.bags.end());
  const ConvertFigures figures = [&] {
    ProgressBar bar(arguments.quiet, "messages");
    return convert_bags(bags, arguments.output, arguments.force, options,
                        [&](int done, int total) { bar.draw(done, total); });
  }();
  warnings.add(figures, "", arguments.quiet);
  if (arguments.quiet) return;
  print_out("{}: {} scans and {} images of {} camera{}\n", arguments.output, figures.scans,
            figures.images, figures.cameras, figures.cameras == 1 ? "" : "s");
}

}  // namespace

void add_convert_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ConvertArguments>();
  ConvertOptions& options = arguments->options;
  CLI::App* command =
      app.add_subcommand("convert", "Turn recordings of ROS 2 or ROS 1 into a drive, without ROS");
  command
      ->add_option("BAG", arguments->bags,
                   "Files (.mcap, .bag, .db3) or bags' folders of one drive")
      ->required();
  command->add_option("-o,--output", arguments->output, "Folder to make (docs/drives.md)")
      ->required()
      ->type_name("DIR");
  command->add_option("--lidar", options.lidar, "The scans (default: the only topic of scans)")
      ->type_name("TOPIC");
  command
      ->add_option("--camera", arguments->cameras,
                   "A camera's images, may be repeated (default: all with calibration and place)")
      ->type_name("NAME=TOPIC")
      ->allow_extra_args(false);
  command
      ->add_option("--poses", arguments->poses,
                   "Where they come from: auto takes the first of the others that there is")
      ->capture_default_str()
      ->check(CLI::IsMember(kSources));
  command->add_option("--fix", options.fix, "NavSatFix, where there are several")
      ->type_name("TOPIC");
  command->add_option("--imu", options.imu, "Imu, where there are several, or none")
      ->type_name("TOPIC");
  command->add_option("--odometry", options.odometry, "Odometry, where there are several")
      ->type_name("TOPIC");
  command->add_option("--body", options.body, "Frame of the vehicle (default: base_link)")
      ->type_name("FRAME");
  command->add_option("--world", options.world, "Frame that --poses tf are in (default: outermost)")
      ->type_name("FRAME");
  command->add_flag("--compensated", options.sweep_compensated,
                    "The scans' motion was undone when they were recorded");
  command->add_flag("--allow-dropped", options.allow_dropped,
                    "Convert scans even if over 10 % of their points cannot be used");
  command->add_flag("--force", arguments->force, "Replace DIR");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  command->callback([arguments, &session] { run(*arguments, session.warnings); });
}

}  // namespace fovea::app
