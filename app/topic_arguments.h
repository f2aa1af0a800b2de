// Options that choose the topics of a recording or of a running robot.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "fovea/drive/recordings/convert_options.h"

namespace fovea::app {

/// The choice as typed. Its texts are resolved by options().
struct TopicArguments {
  ConvertOptions chosen;             ///< without cameras
  std::vector<std::string> cameras;  ///< "NAME=TOPIC"

  /// ConfigError for a camera without a name, and for one that is named twice.
  ConvertOptions options() const;
};

/// Adds --lidar, --camera, --fix, --imu, --odometry, --body, --world and --compensated.
/// @param group  heading of these options in --help; empty: that of all others
void add_topic_options(CLI::App& command, TopicArguments& arguments, const std::string& group = "");

}  // namespace fovea::app
