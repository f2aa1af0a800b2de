#include "fovea/drive/bridge/bridge_messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "fovea/core/nesting.h"

namespace fovea::bridge {
namespace {

using Json = nlohmann::json;

static_assert(std::endian::native == std::endian::little, "the protocol has little-endian numbers");

constexpr std::uint8_t kMessageData = 1;  // opcode

[[noreturn]] void throw_damaged(const std::string& problem) {
  throw DamagedMessage(fmt::format("a message of the bridge is damaged ({})", problem),
                       "the bridge", "check that the address is that of a Foxglove bridge");
}

std::uint32_t id_of(const Json& json) {
  if (!json.is_number_unsigned() ||
      json.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument("an id is no number of 32 bits");
  }
  return json.get<std::uint32_t>();
}

Advertised advertised_of(const Json& json) {
  Advertised advertised;
  for (const Json& channel : json.at("channels")) {
    advertised.channels.push_back({id_of(channel.at("id")), channel.at("topic").get<std::string>(),
                                   channel.at("encoding").get<std::string>(),
                                   channel.value("schemaName", "")});
  }
  return advertised;
}

Unadvertised unadvertised_of(const Json& json) {
  Unadvertised unadvertised;
  for (const Json& id : json.at("channelIds")) unadvertised.channel_ids.push_back(id_of(id));
  return unadvertised;
}

Status status_of(const Json& json) {
  const int level = std::clamp(json.at("level").get<int>(), 0, 2);
  return {static_cast<Status::Level>(level), json.at("message").get<std::string>()};
}

ServerMessage message_of(const Json& json) {
  const auto op = json.at("op").get<std::string>();
  if (op == "advertise") return advertised_of(json);
  if (op == "unadvertise") return unadvertised_of(json);
  if (op == "status") return status_of(json);
  return Unused{};
}

template <class T>
T take(std::string_view& bytes) {
  if (bytes.size() < sizeof(T)) throw_damaged("it ends early");
  std::array<char, sizeof(T)> raw;
  bytes.copy(raw.data(), raw.size());
  bytes.remove_prefix(sizeof(T));
  return std::bit_cast<T>(raw);
}

}  // namespace

ServerMessage parse_text(std::string_view message) {
  if (nesting_depth(message) > kMaxNesting) throw_damaged("it is nested too deep");
  try {
    return message_of(Json::parse(message));
  } catch (const std::exception& error) {
    throw_damaged(error.what());
  }
}

ServerMessage parse_binary(std::string_view message) {
  if (take<std::uint8_t>(message) != kMessageData) return Unused{};
  MessageData data;
  data.subscription = take<std::uint32_t>(message);
  data.sent = static_cast<TimeNs>(take<std::uint64_t>(message));
  data.payload = message;
  return data;
}

std::string subscribe_message(std::span<const Subscription> subscriptions) {
  Json list = Json::array();
  for (const Subscription& subscription : subscriptions) {
    list.push_back({{"id", subscription.id}, {"channelId", subscription.channel_id}});
  }
  return Json{{"op", "subscribe"}, {"subscriptions", list}}.dump();
}

}  // namespace fovea::bridge
