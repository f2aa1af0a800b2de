#include "fovea/core/thread.h"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <condition_variable>
#include <mutex>
#include <utility>

namespace fovea {
namespace {

constexpr int kBackgroundNice = 15;

/// On Linux each thread has its own nice value. Without the permission to change it, nothing
/// happens.
void set_nice(int nice) {
  static_cast<void>(setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), nice));
}

}  // namespace

std::jthread start_thread(const std::string& name, std::function<void(const std::stop_token&)> body,
                          ThreadPriority priority) {
  return std::jthread([name, body = std::move(body), priority](const std::stop_token& stop) {
    pthread_setname_np(pthread_self(), name.c_str());
    if (priority == ThreadPriority::kBackground) set_nice(kBackgroundNice);
    body(stop);
  });
}

bool wait_until(WallClock::time_point time, const std::stop_token& stop) {
  std::mutex guard;
  std::unique_lock lock(guard);
  std::condition_variable_any stopped;
  stopped.wait_until(lock, stop, time, [] { return false; });
  return !stop.stop_requested();
}

}  // namespace fovea
