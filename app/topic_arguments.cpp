#include "app/topic_arguments.h"

#include <CLI/CLI.hpp>
#include <set>

#include "fovea/core/plain_name.h"
#include "fovea/errors.h"

namespace fovea::app {

ConvertOptions TopicArguments::options() const {
  ConvertOptions options = chosen;
  std::set<std::string> names, topics;
  for (const std::string& text : cameras) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    if (equals == std::string::npos || !is_plain_name(name) || !names.insert(name).second ||
        !topics.insert(text.substr(equals + 1)).second) {
      throw ConfigError("this names no camera, or one or its topic twice", "--camera " + text,
                        "give NAME=TOPIC, the name of letters, digits, '_' and '-'");
    }
    options.cameras.push_back({name, text.substr(equals + 1)});
  }
  return options;
}

void add_topic_options(CLI::App& command, TopicArguments& arguments, const std::string& group) {
  ConvertOptions& options = arguments.chosen;
  std::vector<CLI::Option*> added;
  const auto add = [&](const char* name, auto& value, const char* type, const char* help) {
    added.push_back(command.add_option(name, value, help)->type_name(type));
    return added.back();
  };
  add("--lidar", options.lidars, "TOPIC",
      "The scans (default: the only topic of scans); repeated for further LiDARs of the vehicle")
      ->allow_extra_args(false);
  add("--camera", arguments.cameras, "NAME=TOPIC",
      "A camera's images, may be repeated (default: all with calibration and place)")
      ->allow_extra_args(false);
  add("--fix", options.fix, "TOPIC", "NavSatFix, where there are several");
  add("--imu", options.imu, "TOPIC", "Imu, where there are several, or none");
  add("--odometry", options.odometry, "TOPIC", "Odometry, where there are several");
  add("--body", options.body, "FRAME", "Frame of the vehicle (default: base_link)");
  add("--world", options.world, "FRAME", "Frame that poses of tf are in (default: outermost)");
  added.push_back(command.add_flag("--compensated", options.sweep_compensated,
                                   "The scans' motion was undone when they were recorded"));
  if (group.empty()) return;
  for (CLI::Option* option : added) option->group(group);
}

}  // namespace fovea::app
