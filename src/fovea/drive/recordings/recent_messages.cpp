#include "fovea/drive/recordings/recent_messages.h"

namespace fovea {

bool RecentMessages::add(const BagTopic& topic, std::string_view bytes) {
  messages_.push_back({topic, std::string(bytes)});
  bytes_ += bytes.size();
  if (bytes_ <= max_bytes_ && messages_.size() <= kMaxMessages) return false;
  while (bytes_ > max_bytes_ / 2 || messages_.size() > kMaxMessages / 2) {
    bytes_ -= messages_.front().bytes.size();
    messages_.pop_front();
  }
  return true;
}

void RecentMessages::clear() {
  messages_.clear();
  bytes_ = 0;
}

}  // namespace fovea
