// Messages of the Foxglove bridge, which sends the topics of a running robot over a WebSocket:
// github.com/foxglove/ws-protocol, docs/spec.md. Its successor foxglove.sdk.v1 has the same ones.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "fovea/errors.h"
#include "fovea/time.h"

namespace fovea::bridge {

/// Names of the protocol, for the handshake.
inline constexpr std::array<std::string_view, 2> kProtocols = {"foxglove.sdk.v1",
                                                               "foxglove.websocket.v1"};

/// What the server can do. Its first message.
struct ServerInfo {
  bool accepts_messages = false;       ///< clients may publish ("clientPublish")
  std::vector<std::string> encodings;  ///< of the messages that clients may publish
};

/// A topic that the server can send.
struct Channel {
  std::uint32_t id = 0;
  std::string topic;
  std::string encoding;  ///< of its messages: "cdr", "ros1", "json"
  std::string type;      ///< "sensor_msgs/msg/PointCloud2"
};

struct Advertised {
  std::vector<Channel> channels;
};
struct Unadvertised {
  std::vector<std::uint32_t> channel_ids;
};

/// A remark of the server for its user.
struct Status {
  enum class Level { kInfo, kWarning, kError };
  Level level = Level::kInfo;
  std::string text;
};

/// A message of a topic.
struct MessageData {
  std::uint32_t subscription = 0;
  TimeNs sent = 0;           ///< by the server's clock
  std::string_view payload;  ///< points into the message that it was read from
};

/// A message that no part of Fovea uses: parameters, services, assets, time.
struct Unused {};

using ServerMessage =
    std::variant<ServerInfo, Advertised, Unadvertised, Status, MessageData, Unused>;

class DamagedMessage : public InputError {
 public:
  using InputError::InputError;
};

/// DamagedMessage if it is none of the protocol.
ServerMessage parse_text(std::string_view message);
ServerMessage parse_binary(std::string_view message);

struct Subscription {
  std::uint32_t id = 0, channel_id = 0;
};
/// The request to send the messages of some channels.
std::string subscribe_message(std::span<const Subscription> subscriptions);

/// A topic that this client publishes.
struct ClientChannel {
  std::uint32_t id = 0;
  std::string topic;
  std::string encoding;     ///< of its messages: "cdr", "ros1", "json"
  std::string schema_name;  ///< "nav_msgs/msg/Odometry"
  std::string schema;       ///< the definition of that type
  std::string schema_encoding;
};
/// Offers the topics. Only for a server that accepts messages.
std::string advertise_message(std::span<const ClientChannel> channels);
/// Withdraws the offer.
std::string unadvertise_message(std::span<const ClientChannel> channels);
/// A message of an offered topic, for a binary frame.
std::string client_message_data(std::uint32_t channel_id, std::string_view payload);

}  // namespace fovea::bridge
