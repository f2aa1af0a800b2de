// Work that can wait, and what it waits for.
#pragma once

#include <condition_variable>
#include <mutex>
#include <stop_token>

#include "fovea/base/wall_clock.h"

namespace fovea {

/// Keeps work that can wait from taking the processor from work that cannot: the one waits here
/// while any of the other is under way. Thread-safe.
class IdleGate {
 public:
  /// Something that cannot wait begins, or has ended.
  void begin() { count(1); }
  void end() { count(-1); }

  /// Waits until nothing is under way, but not beyond `latest`, nor once `stop` is asked for.
  void wait(WallClock::time_point latest, const std::stop_token& stop) {
    std::unique_lock lock(guard_);
    changed_.wait_until(lock, stop, latest, [&] { return under_way_ == 0; });
  }

 private:
  void count(int more) {
    const std::lock_guard lock(guard_);
    under_way_ += more;
    changed_.notify_all();
  }

  std::mutex guard_;
  std::condition_variable_any changed_;
  int under_way_ = 0;  // guarded
};

}  // namespace fovea
