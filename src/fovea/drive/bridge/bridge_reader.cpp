#include "fovea/drive/bridge/bridge_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <condition_variable>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <vector>

#include "fovea/core/printable.h"
#include "fovea/drive/bridge/bridge_messages.h"

namespace fovea::bridge {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kIdle{1000};
constexpr milliseconds kFirstPause{250}, kLongestPause{5000};  // between connections
constexpr std::size_t kMostRemarks = 20;                       // of the bridge, that are kept

/// @return false if `stop` ended the pause
bool pause(milliseconds duration, const std::stop_token& stop) {
  std::mutex guard;
  std::unique_lock lock(guard);
  std::condition_variable_any stopped;
  stopped.wait_for(lock, stop, duration, [] { return false; });
  return !stop.stop_requested();
}

class BridgeReader {
 public:
  BridgeReader(const BridgeOptions& options, BagSink& sink, const std::stop_token& stop,
               const std::function<void()>& idle)
      : options_(options), sink_(sink), stop_(stop), idle_(idle) {}

  BridgeFigures run() {
    std::optional<Connection> connection(std::in_place, options_.address, options_.connection,
                                         stop_);
    while (connection) {
      ++figures_.connections;
      subscribed_.clear();
      topic_of_channel_.clear();
      try {
        read(*connection);
        break;
      } catch (const ConnectionError& error) {
        figures_.warn(error.what());
      }
      connection.reset();
      connect_again(connection);
    }
    return std::move(figures_);
  }

 private:
  /// Until the bridge closes the connection, or a stop. ConnectionError if the connection is lost.
  void read(Connection& connection) {
    while (!stop_.stop_requested()) {
      const std::optional<WireMessage> message = connection.receive(stop_, kIdle);
      if (message) {
        take(*message, connection);
      } else if (connection.is_closed()) {
        return;
      }
      if (idle_) idle_();
    }
  }

  void take(const WireMessage& message, Connection& connection) {
    try {
      const ServerMessage parsed =
          message.is_binary ? parse_binary(message.bytes) : parse_text(message.bytes);
      std::visit([&](const auto& content) { take(content, connection); }, parsed);
    } catch (const DamagedMessage& error) {
      if (figures_.damaged++ == 0) figures_.warn(error.what());
    }
  }

  void connect_again(std::optional<Connection>& connection) {
    const auto until = Clock::now() + options_.reconnect;
    milliseconds wait = kFirstPause;
    while (Clock::now() < until && pause(wait, stop_)) {
      if (idle_) idle_();
      try {
        connection.emplace(options_.address, options_.connection, stop_);
        return;
      } catch (const ConnectionError&) {
        wait = std::min(2 * wait, kLongestPause);
      }
    }
    figures_.lost = !stop_.stop_requested();
  }

  void take(const ServerInfo& /*info*/, Connection& /*connection*/) {}
  void take(const Unused& /*message*/, Connection& /*connection*/) {}

  void take(const Status& status, Connection& /*connection*/) {
    if (status.level == Status::Level::kInfo || figures_.warnings.size() >= kMostRemarks) return;
    figures_.warn(fmt::format("the bridge reports: {}", printable(status.text)));
  }

  void take(const Advertised& advertised, Connection& connection) {
    std::vector<Subscription> subscriptions;
    for (const Channel& channel : advertised.channels) {
      if (is_known_topic(channel)) continue;
      BagTopic topic{channel.topic, ros2_type(channel.type), channel.encoding};
      if (!sink_.is_requested(topic) || !topic.is_readable()) continue;
      topic_of_channel_[channel.id] = channel.topic;
      subscribed_[next_subscription_] = {channel.id, std::move(topic)};
      subscriptions.push_back({next_subscription_++, channel.id});
    }
    if (subscriptions.empty()) return;
    static_cast<void>(connection.send({false, subscribe_message(subscriptions)}));
  }

  /// Two channels of one topic would be counted twice.
  bool is_known_topic(const Channel& channel) {
    for (const auto& [id, topic] : topic_of_channel_) {
      if (topic != channel.topic) continue;
      if (id != channel.id && twice_.insert(topic).second) {
        figures_.warn(
            fmt::format("two channels have the topic {}: the second one is left out", topic));
      }
      return true;
    }
    return false;
  }

  void take(const Unadvertised& unadvertised, Connection& /*connection*/) {
    for (const std::uint32_t id : unadvertised.channel_ids) {
      topic_of_channel_.erase(id);
      std::erase_if(subscribed_, [&](const auto& entry) { return entry.second.channel == id; });
    }
  }

  void take(const MessageData& data, Connection& /*connection*/) {
    const auto subscription = subscribed_.find(data.subscription);
    if (subscription == subscribed_.end()) return;  // of a channel that has gone
    ++figures_.messages;
    sink_.add(subscription->second.topic, data.payload);
  }

  struct Subscribed {
    std::uint32_t channel = 0;
    BagTopic topic;
  };

  const BridgeOptions& options_;
  BagSink& sink_;
  const std::stop_token& stop_;
  const std::function<void()>& idle_;
  BridgeFigures figures_;
  std::map<std::uint32_t, Subscribed> subscribed_;         // by subscription
  std::map<std::uint32_t, std::string> topic_of_channel_;  // of channels that are subscribed
  std::set<std::string> twice_;                            // topics with a warning
  std::uint32_t next_subscription_ = 0;
};

}  // namespace

BridgeFigures read_bridge(const BridgeOptions& options, BagSink& sink, const std::stop_token& stop,
                          const std::function<void()>& idle) {
  return BridgeReader(options, sink, stop, idle).run();
}

}  // namespace fovea::bridge
