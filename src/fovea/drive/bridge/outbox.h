// What other threads hand to the thread that reads the bridge.
#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <utility>

namespace fovea::bridge {

/// Passes items from any thread to one that takes them, and never waits. A full outbox drops its
/// oldest item. BoundedQueue is for items that must not get lost.
template <class T>
class Outbox {
 public:
  /// @param capacity  items in the outbox, at most; at least 1
  explicit Outbox(std::size_t capacity) : capacity_(capacity) {}
  Outbox(const Outbox&) = delete;
  Outbox& operator=(const Outbox&) = delete;

  void post(T item) {
    const std::lock_guard lock(guard_);
    ++posted_;
    if (items_.size() == capacity_) {
      items_.pop_front();
      ++dropped_;
    }
    items_.push_back(std::move(item));
    if (items_.size() == 1 && wake_) wake_();
  }

  /// The oldest item; nothing if there is none.
  std::optional<T> take() {
    const std::lock_guard lock(guard_);
    if (items_.empty()) return std::nullopt;
    std::optional<T> item(std::move(items_.front()));
    items_.pop_front();
    return item;
  }

  /// Sets what post() calls if the outbox was empty. It must not call the outbox. After this call
  /// no thread runs the earlier one.
  /// @param wake  may be empty
  void on_post(std::function<void()> wake) {
    const std::lock_guard lock(guard_);
    wake_ = std::move(wake);
  }

  struct Counts {
    std::size_t posted = 0, dropped = 0;
  };
  Counts counts() const {
    const std::lock_guard lock(guard_);
    return {posted_, dropped_};
  }

 private:
  const std::size_t capacity_;
  mutable std::mutex guard_;  // of all below
  std::deque<T> items_;
  std::function<void()> wake_;
  std::size_t posted_ = 0, dropped_ = 0;
};

}  // namespace fovea::bridge
