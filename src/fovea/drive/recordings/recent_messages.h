// The latest messages, in the order in which they came.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>

#include "fovea/drive/recordings/bag_sink.h"

namespace fovea {

class RecentMessages {
 public:
  struct Message {
    BagTopic topic;
    std::string bytes;
  };

  /// @param max_bytes  of all messages
  explicit RecentMessages(std::size_t max_bytes) : max_bytes_(max_bytes) {}

  /// @return whether there were too many: then the older half is dropped
  bool add(const BagTopic& topic, std::string_view bytes);

  const std::deque<Message>& messages() const { return messages_; }
  void clear();

 private:
  static constexpr std::size_t kMaxMessages = 100'000;

  std::size_t max_bytes_, bytes_ = 0;
  std::deque<Message> messages_;
};

}  // namespace fovea
