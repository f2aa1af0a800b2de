#include "app/interrupt.h"

#include <cstdlib>
#include <ctime>
#include <future>

namespace fovea::app {

InterruptGuard::InterruptGuard() {
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  // Blocked everywhere and waited for in one thread: a handler could not safely request a stop.
  pthread_sigmask(SIG_BLOCK, &signals_, &mask_before_);
  waiter_ = std::jthread([this](const std::stop_token& done) {
    constexpr timespec kPatience{0, 100'000'000};
    while (!done.stop_requested()) {
      const int signal = sigtimedwait(&signals_, nullptr, &kPatience);
      if (signal <= 0) continue;
      if (interrupted_.stop_requested()) std::_Exit(128 + signal);
      interrupted_.request_stop();
    }
  });
}

InterruptGuard::~InterruptGuard() {
  waiter_.request_stop();
  waiter_.join();
  pthread_sigmask(SIG_SETMASK, &mask_before_, nullptr);
}

void wait_for(const std::stop_token& stop) {
  std::promise<void> stopped;
  const std::stop_callback tell(stop, [&] { stopped.set_value(); });
  stopped.get_future().wait();
}

}  // namespace fovea::app
