// Ctrl-C ends a run cleanly: the frame at hand is finished and what was mapped is committed.
#pragma once

#include <csignal>
#include <stop_token>
#include <thread>

namespace fovea::app {

/// Turns SIGINT and SIGTERM into a stop request for as long as it lives; a second one ends the
/// program at once. To be made before other threads start, which inherit its signal mask.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  std::stop_token token() const { return interrupted_.get_token(); }

 private:
  sigset_t signals_{}, mask_before_{};
  std::stop_source interrupted_;
  std::jthread waiter_;
};

/// Returns when a stop has been requested.
void wait_for(const std::stop_token& stop);

}  // namespace fovea::app
