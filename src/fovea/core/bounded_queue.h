// Queue between two threads of a pipeline.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <stop_token>
#include <utility>

namespace fovea {

/// Passes items from one thread to another in order. A full queue makes the first thread wait, an
/// empty one the second.
///
///   BoundedQueue<Frame> frames(2);
///   const std::jthread reader = start_thread("fovea-read", [&](const std::stop_token& stop) {
///     fill(frames, stop, [&] { return read_frame(); });
///   });
///   while (std::optional<Frame> frame = frames.pop()) use(*frame);
template <class T>
class BoundedQueue {
 public:
  /// @param capacity  items in the queue, at most
  explicit BoundedQueue(std::size_t capacity) : capacity_(capacity) {}
  BoundedQueue(const BoundedQueue&) = delete;
  BoundedQueue& operator=(const BoundedQueue&) = delete;

  /// Waits for room and appends the item.
  /// @return false if `stop` ended the wait, or the queue is closed; the item is dropped
  [[nodiscard]] bool push(T item, const std::stop_token& stop = {}) {
    std::unique_lock lock(guard_);
    changed_.wait(lock, stop, [&] { return items_.size() < capacity_ || closed_; });
    if (items_.size() >= capacity_ || closed_) return false;
    items_.push_back(std::move(item));
    changed_.notify_all();
    return true;
  }

  /// Puts an item before all items that are not urgent, also into a full queue.
  /// @return false if the queue is closed; the item is dropped
  [[nodiscard]] bool push_urgent(T item) {
    const std::lock_guard lock(guard_);
    if (closed_) return false;
    items_.insert(items_.begin() + urgent_++, std::move(item));
    changed_.notify_all();
    return true;
  }

  /// Waits for the next item.
  /// @return nothing if the queue is closed and empty, or if `stop` is requested
  /// Throws the error of close() after the last item.
  std::optional<T> pop(const std::stop_token& stop = {}) {
    std::unique_lock lock(guard_);
    changed_.wait(lock, stop, [&] { return !items_.empty() || closed_; });
    if (stop.stop_requested()) return std::nullopt;
    if (items_.empty()) {
      if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
      return std::nullopt;
    }
    std::optional<T> item(std::move(items_.front()));
    items_.pop_front();
    if (urgent_ > 0) --urgent_;
    changed_.notify_all();
    return item;
  }

  bool empty() const {
    const std::lock_guard lock(guard_);
    return items_.empty();
  }

  /// Closes the queue and returns the items that pop() has not returned.
  std::deque<T> close_and_take() {
    const std::lock_guard lock(guard_);
    closed_ = true;
    urgent_ = 0;
    changed_.notify_all();
    return std::exchange(items_, {});
  }

  /// No item follows.
  /// @param error  why, if an error ended the items
  void close(std::exception_ptr error = nullptr) {
    const std::lock_guard lock(guard_);
    closed_ = true;
    error_ = std::move(error);
    changed_.notify_all();
  }

 private:
  const std::size_t capacity_;
  mutable std::mutex guard_;  // of all below
  std::condition_variable_any changed_;
  std::deque<T> items_;
  std::ptrdiff_t urgent_ = 0;  // of the items: the first ones
  bool closed_ = false;
  std::exception_ptr error_;
};

/// Pushes the items that `next` returns, until it returns nothing, throws, or `stop` is requested.
/// Then closes the queue. pop() throws the error of `next` after the items before it.
/// @param next  returns std::optional<T>
template <class T, class Next>
void fill(BoundedQueue<T>& queue, const std::stop_token& stop, Next&& next) {
  try {
    while (!stop.stop_requested()) {
      std::optional<T> item = next();
      if (!item || !queue.push(std::move(*item), stop)) break;
    }
    queue.close();
  } catch (...) {
    queue.close(std::current_exception());
  }
}

}  // namespace fovea
