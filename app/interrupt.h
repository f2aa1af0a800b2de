// Ctrl-C, SIGTERM and SIGHUP end every command: nothing half-written stays.
#pragma once

#include <atomic>
#include <csignal>
#include <stop_token>
#include <thread>

namespace fovea::app {

/// While it lives, SIGINT, SIGTERM or SIGHUP removes unfinished outputs, reports this and ends the
/// program with 128 + signal. To be made before other threads start, which inherit its signal mask.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// From now on the first signal only requests a stop, for a command that then ends by itself. A
  /// second signal ends the program.
  std::stop_token stop_gently();
  /// Ends that: the next signal ends the program.
  void stop_at_once() { gently_ = false; }

  /// What the program exits with: `code`, or 128 + signal after a gentle stop.
  int exit_code(int code) const;

 private:
  void wait_for_signals(const std::stop_token& done);

  sigset_t signals_{}, mask_before_{};
  std::atomic<bool> gently_ = false;
  std::atomic<int> signal_ = 0;  ///< that requested a stop
  std::stop_source stop_;
  std::jthread waiter_;
};

/// Returns when a stop has been requested.
void wait_for(const std::stop_token& stop);

}  // namespace fovea::app
