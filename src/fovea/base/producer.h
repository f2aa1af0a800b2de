// A stage of a pipeline that has to wait, as for a clock: items made one after the other on a
// thread of its own, a few ahead of the one who takes them.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

namespace fovea {

/// Items come in the order in which they were made, so that the result does not depend on who waits
/// for whom.
template <class T>
class Producer {
 public:
  /// Makes the next item, or nothing at the end. `stop` asks it not to wait any longer.
  using Make = std::function<std::optional<T>(const std::stop_token& stop)>;

  /// @param ahead  items made that nobody has taken, at most, the one being made included; with 0
  ///        there is no thread: next() makes each item when it is asked for
  Producer(std::size_t ahead, Make make) : ahead_(ahead), make_(std::move(make)) {
    if (ahead_ > 0) thread_ = std::thread([this] { run(); });
  }
  ~Producer() {
    stop();
    if (thread_.joinable()) thread_.join();
  }
  Producer(const Producer&) = delete;
  Producer& operator=(const Producer&) = delete;

  /// The next item; nothing after the last one, or after stop() once those made are taken. What
  /// `make` throws is thrown here, after the items made before it.
  std::optional<T> next() {
    if (ahead_ == 0) return made_on_demand();
    std::unique_lock lock(guard_);
    changed_.wait(lock, [&] { return !items_.empty() || ended_; });
    if (items_.empty()) {
      if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
      return std::nullopt;
    }
    std::optional<T> item(std::move(items_.front()));
    items_.pop_front();
    lock.unlock();
    changed_.notify_all();
    return item;
  }

  /// Ends early, in any thread: no item is begun any more, those made can still be taken.
  void stop() { stop_.request_stop(); }

 private:
  std::optional<T> made_on_demand() {
    const std::stop_token stop = stop_.get_token();
    if (stop.stop_requested()) return std::nullopt;
    return make_(stop);
  }

  void run() {
    const std::stop_token stop = stop_.get_token();
    std::exception_ptr error;
    try {
      while (has_room(stop)) {
        std::optional<T> item = make_(stop);
        if (!item) break;
        put(std::move(*item));
      }
    } catch (...) {
      error = std::current_exception();
    }
    const std::lock_guard lock(guard_);
    error_ = error;
    ended_ = true;
    changed_.notify_all();
  }

  /// Waits for the place of an item before it is begun, lest it grow old in the maker's hand.
  bool has_room(const std::stop_token& stop) {
    std::unique_lock lock(guard_);
    changed_.wait(lock, stop, [&] { return items_.size() < ahead_; });
    return !stop.stop_requested();
  }

  void put(T item) {
    const std::lock_guard lock(guard_);
    items_.push_back(std::move(item));
    changed_.notify_all();
  }

  const std::size_t ahead_;
  const Make make_;
  std::stop_source stop_;
  std::mutex guard_;
  std::condition_variable_any changed_;
  std::deque<T> items_;       // guarded, as are the two below
  bool ended_ = false;        // no item will come any more
  std::exception_ptr error_;  // why
  std::thread thread_;        // last: uses all of the above
};

}  // namespace fovea
