// Waits of the threads of a live source.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <stop_token>

#include "fovea/core/wall_clock.h"
#include "fovea/drive/live/live_source.h"

namespace fovea {

/// The senders wait for room, the mapper waits for data. All functions need the lock of the source.
class LiveWaits {
 public:
  using Lock = std::unique_lock<std::mutex>;
  using Condition = std::function<bool()>;

  explicit LiveWaits(const LiveOptions& options);

  /// Data have come.
  void notify();
  /// A frame was taken: there is room.
  void notify_room();
  void close();
  bool is_closed() const { return is_closed_; }
  /// Whether no data come before the mapper takes a frame.
  bool is_over() const { return is_closed_ || is_stuck_; }

  /// Waits for room if the options want that. Without a scan that waits for a frame it waits for a
  /// short time only: the sender may be the thread that sends the next scan.
  /// @return false if the source is closed
  bool wait_for_room(Lock& lock, const Condition& has_room, const Condition& has_scan);
  /// Waits until `is_done`, or a time.
  /// @return false if `stop` is requested
  bool wait(Lock& lock, const std::stop_token& stop, std::optional<WallClock::time_point> end,
            const Condition& is_done);
  /// Waits until no sender waits any more, after close().
  void wait_for_senders(Lock& lock);

  /// The end of a wait of `longest` seconds. Nothing: it has no end.
  std::optional<WallClock::time_point> end_of_wait(WallClock::time_point begin,
                                                   double longest) const;

 private:
  bool senders_wait_, has_one_sender_;
  double max_wait_;  // s
  std::condition_variable_any changed_;
  std::size_t version_ = 0;  // of the data
  std::size_t senders_ = 0;  // that wait for room
  bool is_stuck_ = false;    // the only sender waits, and no frame was taken since
  bool is_closed_ = false;
};

}  // namespace fovea
