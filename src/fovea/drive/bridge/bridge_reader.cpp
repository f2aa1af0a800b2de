#include "fovea/drive/bridge/bridge_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "fovea/core/printable.h"
#include "fovea/core/thread.h"
#include "fovea/drive/bridge/bridge_messages.h"
#include "fovea/drive/bridge/pose_messages.h"

namespace fovea::bridge {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kIdle{1000};
constexpr milliseconds kFirstPause{250}, kLongestPause{5000};  // between connections
constexpr std::size_t kMostRemarks = 20;                       // of the bridge, that are kept

/// Publishes over a connection while it lives.
class Publishing {
 public:
  Publishing(PosePublisher* poses, Connection& connection) : poses_(poses) {
    if (poses_ != nullptr) poses_->begin(connection);
  }
  ~Publishing() {
    if (poses_ != nullptr) poses_->end();
  }
  Publishing(const Publishing&) = delete;
  Publishing& operator=(const Publishing&) = delete;

 private:
  PosePublisher* poses_;
};

class BridgeReader {
 public:
  BridgeReader(const BridgeOptions& options, BagSink& sink, const std::stop_token& stop,
               const std::function<void(bool)>& idle, BridgeFigures& figures)
      : options_(options), sink_(sink), stop_(stop), idle_(idle), figures_(figures) {}

  void run() {
    std::optional<Connection> connection(std::in_place, options_.address, options_.connection,
                                         stop_);
    while (connection) {
      offered_.clear();
      subscribed_.clear();
      try {
        read(*connection);
        break;
      } catch (const ConnectionError& error) {
        if (figures_.losses++ == 0) first_loss_ = error.what();
      }
      connection.reset();
      connect_again(connection);
    }
  }

  /// At the end: appends the warnings that count.
  void warn() {
    if (figures_.losses > 0) {
      figures_.warn(fmt::format("the connection was lost {} time{}: {}", figures_.losses,
                                figures_.losses == 1 ? "" : "s", first_loss_));
    }
    if (figures_.ended_lost) figures_.warn("the lost connection could not be made again");
    if (figures_.damaged > 0) {
      figures_.warn(fmt::format("{} messages of the bridge cannot be read (the first: {})",
                                figures_.damaged, first_damage_));
    }
    if (options_.poses == nullptr) return;
    for (std::string& warning : options_.poses->warnings()) figures_.warn(std::move(warning));
  }

 private:
  struct Subscribed {
    std::uint32_t channel = 0;
    BagTopic topic;
  };

  /// Until the bridge closes the connection, or a stop. ConnectionError if the connection is lost.
  void read(Connection& connection) {
    const Publishing publishing(options_.poses, connection);
    while (!stop_.stop_requested()) {
      const std::optional<WireMessage> message = connection.receive(stop_, kIdle);
      if (message) {
        take(*message, connection);
      } else if (connection.is_closed()) {
        return;
      }
      idle_(/*is_connected=*/true);
    }
  }

  void connect_again(std::optional<Connection>& connection) {
    if (!lost_since_) {
      lost_since_ = WallClock::now();
      pause_ = kFirstPause;
    }
    while (WallClock::now() < *lost_since_ + options_.reconnect &&
           wait_until(WallClock::now() + pause_, stop_)) {
      pause_ = std::min(2 * pause_, kLongestPause);
      idle_(/*is_connected=*/false);
      try {
        connection.emplace(options_.address, options_.connection, stop_);
        return;
      } catch (const ConnectionError&) {  // the next pause follows
      }
    }
    figures_.ended_lost = !stop_.stop_requested();
  }

  void take(const WireMessage& message, Connection& connection) {
    try {
      const ServerMessage parsed =
          message.is_binary ? parse_binary(message.bytes) : parse_text(message.bytes);
      std::visit([&](const auto& content) { take(content, connection); }, parsed);
    } catch (const DamagedMessage& error) {
      if (figures_.damaged++ == 0) first_damage_ = error.problem();
    }
  }

  void take(const Unused& /*message*/, Connection& /*connection*/) {}

  void take(const ServerInfo& info, Connection& connection) {
    if (options_.poses != nullptr) options_.poses->take(info, connection);
  }

  void take(const Status& status, Connection& /*connection*/) {
    if (status.level == Status::Level::kInfo || figures_.warnings.size() >= kMostRemarks) return;
    figures_.warn(fmt::format("the bridge reports: {}", printable(status.text)));
  }

  void take(const Advertised& advertised, Connection& connection) {
    for (const Channel& channel : advertised.channels) {
      if (channel.topic == kOdometryTopic || channel.topic == kStateTopic) continue;
      BagTopic topic{channel.topic, ros2_type(channel.type), channel.encoding};
      if (!sink_.is_requested(topic) || !topic.is_readable()) continue;
      offered_.insert_or_assign(channel.id, std::move(topic));
    }
    subscribe(connection);
  }

  void take(const Unadvertised& unadvertised, Connection& connection) {
    for (const std::uint32_t id : unadvertised.channel_ids) {
      offered_.erase(id);
      std::erase_if(subscribed_, [&](const auto& entry) { return entry.second.channel == id; });
    }
    subscribe(connection);
  }

  void take(const MessageData& data, Connection& /*connection*/) {
    const auto subscription = subscribed_.find(data.subscription);
    if (subscription == subscribed_.end()) return;  // of a channel that has gone
    ++figures_.messages;
    lost_since_.reset();
    sink_.add(subscription->second.topic, data.payload);
  }

  /// Subscribes to a channel of each offered topic that has none yet.
  void subscribe(Connection& connection) {
    std::vector<Subscription> subscriptions;
    for (const auto& [channel, topic] : offered_) {
      const auto same =
          std::find_if(subscribed_.begin(), subscribed_.end(),
                       [&](const auto& entry) { return entry.second.topic.name == topic.name; });
      if (same == subscribed_.end()) {
        subscribed_[next_subscription_] = {channel, topic};
        subscriptions.push_back({next_subscription_++, channel});
      } else if (same->second.channel != channel && twice_.insert(topic.name).second) {
        figures_.warn(fmt::format("two channels have the topic {}: one of them is left out",
                                  printable(topic.name)));
      }
    }
    if (subscriptions.empty()) return;
    static_cast<void>(connection.send({false, subscribe_message(subscriptions)}));
  }

  const BridgeOptions& options_;
  BagSink& sink_;
  const std::stop_token& stop_;
  const std::function<void(bool)>& idle_;
  BridgeFigures& figures_;
  std::string first_loss_, first_damage_;
  std::map<std::uint32_t, BagTopic> offered_;       // requested topics, by channel
  std::map<std::uint32_t, Subscribed> subscribed_;  // by subscription
  std::set<std::string> twice_;                     // topics with a warning
  std::uint32_t next_subscription_ = 0;
  std::optional<WallClock::time_point> lost_since_;  // the last message of a topic
  milliseconds pause_ = kFirstPause;
};

}  // namespace

void read_bridge(const BridgeOptions& options, BagSink& sink, const std::stop_token& stop,
                 const std::function<void(bool)>& idle, BridgeFigures& figures) {
  figures = BridgeFigures();
  BridgeReader reader(options, sink, stop, idle, figures);
  try {
    reader.run();
  } catch (...) {
    reader.warn();
    throw;
  }
  reader.warn();
}

}  // namespace fovea::bridge
