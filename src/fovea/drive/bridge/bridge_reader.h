// Reads the topics of a running robot as a recording is read.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <stop_token>
#include <string>

#include "fovea/core/messages.h"
#include "fovea/drive/bridge/connection.h"
#include "fovea/drive/bridge/pose_publisher.h"
#include "fovea/drive/recordings/bag_sink.h"

namespace fovea::bridge {

struct BridgeOptions {
  Address address;
  ConnectionOptions connection;
  /// How long a lost connection is tried again, with growing pauses, until a message comes.
  std::chrono::milliseconds reconnect{30'000};
  PosePublisher* poses = nullptr;  ///< publishes over the same connection; may be none
};

/// Its warnings count what was lost, and name the first case of each kind.
struct BridgeFigures : Messages {
  std::size_t messages = 0;  ///< of topics
  std::size_t damaged = 0;   ///< messages of the bridge that cannot be read
  std::size_t losses = 0;    ///< of the connection
  bool ended_lost = false;   ///< the connection could not be made again
};

/// Passes the messages of the topics that the sink requests on, until the bridge closes the
/// connection, `stop` is requested, or the connection is lost and cannot be made again.
/// is_requested() is called again for a topic that comes back. Of two channels of one topic one is
/// read at a time. Topics of Fovea's own poses are not read.
/// @param idle     called about once a second, and after each message
/// @param figures  gets what was read, also if it throws
/// @throws ConnectionError  if there is no connection to begin with
/// @throws InputError       if a message is too long
void read_bridge(const BridgeOptions& options, BagSink& sink, const std::stop_token& stop,
                 const std::function<void(bool is_connected)>& idle, BridgeFigures& figures);

}  // namespace fovea::bridge
