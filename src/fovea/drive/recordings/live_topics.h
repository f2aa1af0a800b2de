// Topics of a running robot as a LiveSource.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/core/messages.h"
#include "fovea/drive/live/live_source.h"
#include "fovea/drive/recordings/bag_indexer.h"
#include "fovea/drive/recordings/convert_options.h"
#include "fovea/drive/recordings/live_messages.h"
#include "fovea/drive/recordings/recent_messages.h"

namespace fovea {

struct LiveTopicsOptions {
  ConvertOptions topics;  ///< `start` is not used
  LiveOptions live;
  std::size_t max_waiting = std::size_t{256} << 20;  ///< bytes of messages that wait for the source
};

/// Chooses topics as a conversion does, and makes a LiveSource of their messages.
///
/// The messages wait until they have all that a drive needs: calibration, transforms and some
/// scans. Then the source begins, and gets these messages and all later ones. When it begins
/// depends on the messages alone, not on the time of their arrival.
class LiveTopics : public BagSink {
 public:
  explicit LiveTopics(LiveTopicsOptions options);

  // From one thread, the one that receives.

  bool is_requested(const BagTopic& topic) override;
  /// @throws ConfigError  if the options contradict each other, or as LiveSource
  void add(const BagTopic& topic, std::string_view message) override;
  /// Finds out what is missing.
  /// @throws ConfigError  as add()
  void update();
  /// No messages follow.
  /// @throws InputError   if those that came are no drive
  /// @throws ConfigError  as add()
  void close();
  /// Whether all messages of the duration have come.
  bool is_over() const { return messages_ && messages_->is_over(); }
  /// Warns of messages that could not be used.
  Messages unusable() const;
  /// Their number, by topic.
  std::map<std::string, std::size_t> unusable_counts() const;

  // From any thread.

  /// Nullptr if there is none after `wait`, or at the end.
  LiveSource* wait_for_source(std::chrono::milliseconds wait) const;
  bool is_closed() const;
  /// The source takes no more data, and add() no longer waits for it.
  void abandon();
  /// What was chosen and why, once there is a source.
  const std::vector<std::string>& chosen() const { return chosen_; }
  /// What a drive lacks so far, in one line; empty if it lacks nothing.
  std::string missing() const;

 private:
  bool is_chosen(const BagTopic& topic) const;
  /// A requested topic without a message; empty if there is none.
  std::string silent_topic() const;
  /// @param at_least  scans of the first LiDAR
  /// @return whether the source has begun
  bool try_to_begin(std::size_t at_least, bool waits_for_silent);
  void begin(const BagIndex& index, const ConversionPlan& plan);
  void end();
  void set_missing(std::string missing);

  LiveTopicsOptions options_;
  BagIndexer indexer_;
  RecentMessages recent_;
  std::set<std::string> requested_, heard_;  // topics
  std::size_t scans_since_plan_ = 0;         // since the messages are a drive
  std::vector<std::string> chosen_;          // notes of the plan
  std::optional<LiveMessages> messages_;     // once the source has begun

  mutable std::mutex mutex_;  // of the following
  mutable std::condition_variable changed_;
  std::unique_ptr<LiveSource> source_;
  std::string missing_;
  bool closed_ = false, abandoned_ = false;
};

}  // namespace fovea
