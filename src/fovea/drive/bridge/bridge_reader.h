// Reads the topics of a running robot as a recording is read.
#pragma once

#include <chrono>
#include <functional>
#include <stop_token>
#include <string>

#include "fovea/core/messages.h"
#include "fovea/drive/bridge/connection.h"
#include "fovea/drive/recordings/bag_sink.h"

namespace fovea::bridge {

struct BridgeOptions {
  Address address;
  ConnectionOptions connection;
  /// How long a lost connection is tried again, with growing pauses.
  std::chrono::milliseconds reconnect{30'000};
};

/// Its warnings are remarks of the bridge, lost connections, and topics that two channels have.
struct BridgeFigures : Messages {
  std::size_t connections = 0;
  std::size_t messages = 0;  ///< of topics
  std::size_t damaged = 0;   ///< messages of the bridge that cannot be read
  bool lost = false;         ///< the connection could not be made again
};

/// Passes the messages of the topics that the sink requests on, until the bridge closes the
/// connection, `stop` is requested, or the connection is lost and cannot be made again.
/// is_requested() is called again for a topic that comes back.
/// ConnectionError if there is no connection to begin with.
/// @param idle  called about once a second, and after each message
BridgeFigures read_bridge(const BridgeOptions& options, BagSink& sink, const std::stop_token& stop,
                          const std::function<void()>& idle);

}  // namespace fovea::bridge
