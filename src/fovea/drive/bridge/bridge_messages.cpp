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

constexpr std::uint8_t kMessageData = 1;  // opcode of the server, and of the client

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

std::vector<std::string> texts_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found == json.end() ? std::vector<std::string>() : found->get<std::vector<std::string>>();
}

ServerInfo server_info_of(const Json& json) {
  const std::vector<std::string> capabilities = texts_at(json, "capabilities");
  return {
      std::find(capabilities.begin(), capabilities.end(), "clientPublish") != capabilities.end(),
      texts_at(json, "supportedEncodings")};
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
  if (op == "serverInfo") return server_info_of(json);
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

std::string advertise_message(std::span<const ClientChannel> channels) {
  Json list = Json::array();
  for (const ClientChannel& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", channel.encoding},
                    {"schemaName", channel.schema_name},
                    {"schema", channel.schema},
                    {"schemaEncoding", channel.schema_encoding}});
  }
  return Json{{"op", "advertise"}, {"channels", list}}.dump();
}

std::string unadvertise_message(std::span<const ClientChannel> channels) {
  Json ids = Json::array();
  for (const ClientChannel& channel : channels) ids.push_back(channel.id);
  return Json{{"op", "unadvertise"}, {"channelIds", ids}}.dump();
}

std::string client_message_data(std::uint32_t channel_id, std::string_view payload) {
  const auto id = std::bit_cast<std::array<char, sizeof(channel_id)>>(channel_id);
  std::string message(1, char{kMessageData});
  message.append(id.data(), id.size());
  message += payload;
  return message;
}

}  // namespace fovea::bridge
