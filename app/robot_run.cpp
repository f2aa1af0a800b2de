#include "app/robot_run.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "fovea/errors.h"
#include "fovea/pipeline/summary_json.h"

namespace fovea::app {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

bridge::BridgeOptions bridge_options(const std::string& address, const LiveArguments& live,
                                     bridge::PosePublisher& poses) {
  bridge::BridgeOptions options;
  options.address = bridge::parse_address(address);
  options.reconnect = std::chrono::milliseconds(std::int64_t(1000 * live.reconnect));
  options.poses = &poses;
  return options;
}

LiveTopicsOptions topics_options(const DriveArguments& drive, const LiveArguments& live) {
  LiveTopicsOptions options;
  options.topics = live.topics.options();
  options.topics.duration = live.duration;
  options.live.name = drive.drive;
  options.live.drive = drive.options();
  options.live.max_wait = live.max_wait;
  options.live.waits = options.live.has_one_sender = live.every_frame;
  options.live.record = live.record;
  return options;
}

void check_files_of_robot(CommandFiles files, const LiveArguments& live) {
  files.folder = {live.record, FolderUse::kReplace};
  check_files(files);
  std::error_code ignored;
  if (live.record.empty() || !fs::exists(fs::symlink_status(live.record, ignored))) return;
  throw OutputError("the folder exists already", live.record, "remove it, or choose another name");
}

void throw_missing(RobotReader& reader, const std::string& address) {
  reader.join();
  try {
    reader.rethrow();
  } catch (const bridge::ConnectionError&) {
    throw;
  } catch (const InputError& error) {
    throw InputError(error.problem(), error.where() + " of " + address, error.remedy());
  }
  throw InputError("the robot has sent no drive", address, "see docs/live.md");
}

ordered_json live_json(const RobotReader& reader, const LiveTopics& topics,
                       const LiveFigures& figures, const bridge::PosePublisher& poses) {
  const bridge::BridgeFigures& of_bridge = reader.figures();
  ordered_json json = {{"messages", of_bridge.messages},
                       {"messages_damaged", of_bridge.damaged},
                       {"messages_unusable", topics.unusable_counts()},
                       {"connection_losses", of_bridge.losses}};
  json.update(to_json(figures));
  json["poses_published"] = poses.sent();
  return json;
}

}  // namespace fovea::app
