// fovea convert: recordings of ROS 2 and ROS 1 as a folder with a drive.toml.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.h"
#include "app/convert_bridge.h"
#include "app/convert_data_set.h"
#include "app/print.h"
#include "app/progress_bar.h"
#include "app/topic_arguments.h"
#include "fovea/drive/bridge/bridge_address.h"
#include "fovea/drive/command_files.h"
#include "fovea/drive/recordings/convert_bags.h"
#include "fovea/errors.h"

namespace fovea::app {
namespace {

struct ConvertArguments {
  std::vector<std::string> bags;
  std::string output, poses = "auto";
  TopicArguments topics;
  double reconnect = 30;  // s
  bool list = false, force = false, quiet = false;
};

const std::map<std::string, NavigationSource> kSources = {{"auto", NavigationSource::kAuto},
                                                          {"gnss", NavigationSource::kGnss},
                                                          {"odometry", NavigationSource::kOdometry},
                                                          {"tf", NavigationSource::kTf},
                                                          {"none", NavigationSource::kNone}};

std::string line_of(const RecordingContents::Topic& topic) {
  std::string line = fmt::format("{:>8} {}  {}", topic.messages, topic.name, topic.type);
  if (!topic.first) return line;
  const double duration = seconds(*topic.last - *topic.first);
  line += fmt::format(", frame {}, {:.2f} s", topic.frame, duration);
  if (duration > 0) line += fmt::format(", {:.1f} Hz", double(topic.messages - 1) / duration);
  return line;
}

void list(const ConvertArguments& arguments, Warnings& warnings) {
  const RecordingContents contents = list_bags({arguments.bags.begin(), arguments.bags.end()});
  for (const RecordingContents::Topic& topic : contents.topics) print_out("{}\n", line_of(topic));
  warnings.add(contents, "", arguments.quiet);
}

/// Whether a running robot is given. ConfigError if it is one of several inputs.
bool is_live(const ConvertArguments& arguments) {
  const auto address = std::find_if(arguments.bags.begin(), arguments.bags.end(),
                                    [](const std::string& bag) { return bridge::is_address(bag); });
  if (address == arguments.bags.end()) return false;
  if (arguments.bags.size() == 1) return true;
  throw ConfigError("a running robot is converted alone", *address, "give it without recordings");
}

ConvertFigures convert(const ConvertArguments& arguments, Session& session) {
  ConvertOptions options = arguments.topics.options();
  options.poses = kSources.at(arguments.poses);
  if (is_live(arguments)) {
    return convert_bridge({arguments.bags.front(), arguments.output, options, arguments.reconnect,
                           arguments.force, arguments.quiet},
                          session);
  }
  check_files({arguments.bags, {}, {arguments.output}});
  const std::vector<std::filesystem::path> bags(arguments.bags.begin(), arguments.bags.end());
  ProgressBar bar(arguments.quiet, "messages");
  return convert_bags(bags, arguments.output, arguments.force, options,
                      [&](int done, int total) { bar.draw(done, total); });
}

void run(const ConvertArguments& arguments, Session& session) {
  if (arguments.bags.empty()) {
    throw ConfigError("there is no recording", "fovea convert", "name one, or see --help");
  }
  if (arguments.list && is_live(arguments)) return list_bridge(arguments.bags.front());
  if (arguments.list) return list(arguments, session.warnings);
  if (arguments.output.empty()) {
    throw ConfigError("there is no folder to make", "-o", "name one");
  }
  const ConvertFigures figures = convert(arguments, session);
  session.warnings.add(figures, "", arguments.quiet);
  if (arguments.quiet) return;
  const std::string lidars =
      figures.lidars > 1 ? fmt::format(" of {} LiDARs", figures.lidars) : std::string();
  print_out("{}: {} scans{} and {} images of {} camera{}\n", arguments.output, figures.scans,
            lidars, figures.images, figures.cameras, figures.cameras == 1 ? "" : "s");
}

}  // namespace

void add_convert_command(CLI::App& app, Session& session) {
  auto arguments = std::make_shared<ConvertArguments>();
  ConvertOptions& options = arguments->topics.chosen;
  CLI::App* command = app.add_subcommand(
      "convert", "Turn a recording of ROS 2 or ROS 1, or a scene of a data set, into a drive");
  command->add_option(
      "BAG", arguments->bags,
      "Files (.mcap, .bag, .db3) or bags' folders of one drive, or the Foxglove bridge "
      "of a running robot (ws://HOST:8765)");
  command->add_option("-o,--output", arguments->output, "Folder to make (docs/drives.md)")
      ->type_name("DIR");
  command->add_flag("--list", arguments->list,
                    "Print the topics of the recording, and make nothing");
  command
      ->add_option("--start", options.start, "Leave out what comes before, s from the first scan")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--duration", options.duration, "Length of the part to convert, s")
      ->check(CLI::PositiveNumber);
  add_topic_options(*command, arguments->topics);
  command
      ->add_option("--poses", arguments->poses,
                   "Where they come from: auto takes the first of the others that there is")
      ->capture_default_str()
      ->check(CLI::IsMember(kSources));
  command->add_flag("--allow-dropped", options.allow_dropped,
                    "Convert scans even if over 10 % of their points cannot be used");
  command
      ->add_option("--reconnect", arguments->reconnect,
                   "How long a lost connection to a robot is tried again, s")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 86'400.0));
  command->add_flag("--force", arguments->force, "Replace DIR");
  command->add_flag("--quiet", arguments->quiet, "Say nothing but errors");
  add_data_set_commands(*command, session);
  command->callback([arguments, command, &session] {
    if (command->get_subcommands().empty()) run(*arguments, session);
  });
}

}  // namespace fovea::app
