// Named threads.
#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <thread>

#include "fovea/core/wall_clock.h"

namespace fovea {

enum class ThreadPriority {
  kNormal,
  kBackground,  ///< nice 15: work that is not urgent gets about 3 % of a busy processor
};

/// Starts a thread. Its destructor requests a stop and joins the thread.
/// @param name  at most 15 characters, for debuggers and profilers
/// @param body  must not throw
[[nodiscard]] std::jthread start_thread(const std::string& name,
                                        std::function<void(const std::stop_token&)> body,
                                        ThreadPriority priority = ThreadPriority::kNormal);

/// Waits until a time.
/// @return false if `stop` ended the wait
bool wait_until(WallClock::time_point time, const std::stop_token& stop);

}  // namespace fovea
