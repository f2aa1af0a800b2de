// A WebSocket to a bridge.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "fovea/drive/bridge/bridge_address.h"
#include "fovea/errors.h"

namespace fovea::bridge {

/// There is no connection to the bridge, or it is lost.
class ConnectionError : public InputError {
 public:
  using InputError::InputError;
};

struct ConnectionOptions {
  /// Of the whole connection and of each reply. A bridge that sends nothing replies to pings.
  std::chrono::milliseconds timeout{10'000};
  std::size_t max_message = std::size_t{256} << 20;  ///< bytes
  std::size_t max_unsent = std::size_t{4} << 20;     ///< bytes of messages to the bridge
};

struct WireMessage {
  bool is_binary = false;
  std::string bytes;
};

///   Connection connection(parse_address("ws://robot:8765"));
///   while (const auto message = connection.receive(stop)) use(*message);
///
/// One thread uses it, except for wake(). While that thread does not call receive(), the bridge
/// waits, and then drops what it cannot send: memory does not grow.
class Connection {
 public:
  /// Connects. ConnectionError if no bridge of a known protocol replies in time, or at a stop.
  /// A host's name is looked up first, for as long as the system takes.
  explicit Connection(const Address& address, const ConnectionOptions& options = {},
                      const std::stop_token& stop = {});
  ~Connection();

  /// The next message. Nothing if the bridge has closed the connection or if `stop` is requested,
  /// or after `wait` without a message.
  /// ConnectionError if the connection is lost. InputError if a message is too long.
  std::optional<WireMessage> receive(const std::stop_token& stop,
                                     std::optional<std::chrono::milliseconds> wait = {});
  /// Whether the bridge has closed the connection.
  bool is_closed() const;

  /// Appends a message to those that receive() sends.
  /// @return false if the bridge does not take the earlier ones: the message is dropped
  bool send(WireMessage message);

  using Source = std::function<std::optional<WireMessage>()>;
  /// receive() calls the source each time it has sent all messages, and sends what it returns: the
  /// bridge sets the pace. After the source has returned nothing, wake() calls it again.
  void send_from(Source source);
  /// From any thread: makes receive() call the source, also while it waits for a message.
  void wake();

 private:
  class Socket;
  std::unique_ptr<Socket> socket_;
};

}  // namespace fovea::bridge
