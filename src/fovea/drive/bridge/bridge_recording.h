// Records what a running robot sends.
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "fovea/drive/bridge/bridge_reader.h"
#include "fovea/drive/recordings/convert_options.h"

namespace fovea::bridge {

struct RecordingJob {
  BridgeOptions bridge;
  ConvertOptions options;        ///< of the conversion that follows: what it needs is waited for
  std::filesystem::path output;  ///< an MCAP file that does not exist yet
};

struct RecordingProgress {
  std::size_t scans = 0, images = 0;  ///< so far
  /// What a drive lacks so far, in one line; empty if it lacks nothing. Only in the first minute.
  std::string missing;
  bool is_connected = true;
};

/// Records the topics that a drive can be made of, until the bridge closes the connection, `stop`
/// is requested, the connection stays lost, or `options.start` and `options.duration` have passed
/// since the first scan. What came until then is in the file, also after an error.
/// @param progress  called about once a second, and after each message
/// @throws ConnectionError  if there is no connection to begin with; there is no file then
/// @throws ConfigError      if the options contradict each other
/// @throws OutputError      as McapWriter
BridgeFigures record_bridge(const RecordingJob& job, const std::stop_token& stop,
                            const std::function<void(const RecordingProgress&)>& progress);

/// The topics that a bridge offers, by name.
/// @param wait  how long they are waited for
/// ConnectionError if there is no connection.
std::vector<BagTopic> list_topics(const BridgeOptions& options, std::chrono::milliseconds wait);

}  // namespace fovea::bridge
