#include "app/live_arguments.h"

#include <CLI/CLI.hpp>
#include <array>

#include "app/number_checks.h"

namespace fovea::app {
namespace {

constexpr const char* kGroup = "Running robot (ws://HOST:PORT)";
constexpr double kLongest = 1e6;  // s

constexpr std::array kOfRobots = {"--lidar",       "--camera",   "--fix",      "--imu",
                                  "--odometry",    "--body",     "--world",    "--compensated",
                                  "--reconnect",   "--max-wait", "--duration", "--every-frame",
                                  "--pose-stream", "--record"};
constexpr std::array kOfDrives = {"--frames",  "--rate", "--calibrate", "--if-missing",
                                  "--scratch", "--only", "--truth"};

}  // namespace

void add_live_arguments(CLI::App& command, LiveArguments& arguments) {
  add_topic_options(command, arguments.topics, kGroup);
  command
      .add_option("--reconnect", arguments.reconnect,
                  "How long a lost connection is tried again, s")
      ->capture_default_str()
      ->check(finite_range(0.0, 86'400.0))
      ->group(kGroup);
  command
      .add_option("--max-wait", arguments.max_wait,
                  "How long a scan waits for its images and positions, s")
      ->capture_default_str()
      ->check(finite_range(0.0, 60.0))
      ->group(kGroup);
  command
      .add_option("--duration", arguments.duration,
                  "End so long after the first scan, s (default: when the robot ends)")
      ->check(finite_range(1e-3, kLongest))
      ->group(kGroup);
  command
      .add_flag("--every-frame", arguments.every_frame,
                "The robot waits for each frame, for a bridge that plays a recording")
      ->group(kGroup);
  command
      .add_option("--record", arguments.record,
                  "Write the frames that are used as a drive, too (docs/drives.md)")
      ->type_name("DIR")
      ->group(kGroup);
  command
      .add_flag("--pose-stream", arguments.pose_stream,
                "Print the pose of each frame on standard output, and nothing else")
      ->group(kGroup);
}

void check_kind_of_options(const CLI::App& command, bool is_live) {
  const auto refuse = [&](const auto& options, const char* kind) {
    for (const char* option : options) {
      const CLI::Option* const given = command.get_option_no_throw(option);
      if (given != nullptr && given->count() > 0) throw CLI::ValidationError(option, kind);
    }
  };
  if (is_live) {
    refuse(kOfDrives, "not with a running robot");
  } else {
    refuse(kOfRobots, "only with a running robot (ws://HOST:PORT)");
  }
}

}  // namespace fovea::app
