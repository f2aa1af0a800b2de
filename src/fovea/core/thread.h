// Named threads.
#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <thread>

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

}  // namespace fovea
