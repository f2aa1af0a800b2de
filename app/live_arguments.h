// Options of commands that read a running robot.
#pragma once

#include <CLI/App.hpp>
#include <limits>
#include <string>

#include "app/topic_arguments.h"

namespace fovea::app {

/// Options of commands with ws://HOST:PORT in place of a drive, as typed.
struct LiveArguments {
  TopicArguments topics;
  double reconnect = 30;                                      ///< s
  double max_wait = 0.3;                                      ///< s
  double duration = std::numeric_limits<double>::infinity();  ///< s
  bool every_frame = false;
  std::string record;
  bool pose_stream = false;
};

/// Adds the options, under a heading of their own.
void add_live_arguments(CLI::App& command, LiveArguments& arguments);

/// CLI::ValidationError if an option was given that makes sense only for the other kind of drive.
/// @param is_live  whether the drive is a running robot
void check_kind_of_options(const CLI::App& command, bool is_live);

}  // namespace fovea::app
