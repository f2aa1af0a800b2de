// What commands that read a running robot do alike.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "app/drive_arguments.h"
#include "app/live_arguments.h"
#include "app/robot_reader.h"
#include "fovea/drive/command_files.h"

namespace fovea::app {

/// @param poses  publishes over the connection
bridge::BridgeOptions bridge_options(const std::string& address, const LiveArguments& live,
                                     bridge::PosePublisher& poses);

LiveTopicsOptions topics_options(const DriveArguments& drive, const LiveArguments& live);

/// Checks the files of a command and its recording.
/// @throws OutputError  if there is something at the place of the recording, or as check_files()
void check_files_of_robot(CommandFiles files, const LiveArguments& live);

/// Throws what ended a reader that has no source.
[[noreturn]] void throw_missing(RobotReader& reader, const std::string& address);

/// The object `live` of a report.
nlohmann::ordered_json live_json(const RobotReader& reader, const LiveTopics& topics,
                                 const LiveFigures& figures, const bridge::PosePublisher& poses);

}  // namespace fovea::app
