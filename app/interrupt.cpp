#include "app/interrupt.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <future>
#include <string>
#include <vector>

#include "fovea/core/printable.h"
#include "fovea/core/thread.h"
#include "fovea/core/unfinished_output.h"

namespace fovea::app {
namespace {

constexpr int kSignalled = 128;  // a shell's exit code of a program that a signal ended

const char* name_of_signal(int signal) {
  return signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGHUP";
}

/// "a.json", or "a.json, b.json, c.json and 4 more".
std::string list_of(const std::vector<std::filesystem::path>& paths) {
  constexpr std::size_t kNamed = 3;
  std::vector<std::string> names;
  for (const auto& path : paths) {
    if (names.size() < kNamed) names.push_back(printable(path.string()));
  }
  std::string text = fmt::format("{}", fmt::join(names, ", "));
  if (paths.size() > kNamed) text += fmt::format(" and {} more", paths.size() - kNamed);
  return text;
}

std::string report_of(int signal, const OutputNames& outputs) {
  std::string kept;
  if (!outputs.finished.empty()) kept += fmt::format("kept: {}; ", list_of(outputs.finished));
  if (!outputs.discarded.empty()) {
    kept += fmt::format("not written: {}", list_of(outputs.discarded));
  } else {
    kept += "no output was left unfinished";
  }
  return fmt::format("{}fovea: error: interrupted by {}, {}, give the same command again\n",
                     ::isatty(STDERR_FILENO) != 0 ? "\n" : "", name_of_signal(signal), kept);
}

/// Ends the program from any thread, whatever the others do.
[[noreturn]] void end_program(int signal) {
  const std::string report = report_of(signal, discard_unfinished_outputs());
  // Not by stdio: another thread may wait for the terminal with its lock.
  static_cast<void>(::write(STDERR_FILENO, report.data(), report.size()));
  std::_Exit(kSignalled + signal);
}

/// nohup and other parents that ignore a hang-up mean that the program continues.
bool is_ignored(int signal) {
  struct sigaction action = {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

InterruptGuard::InterruptGuard() {
  // A shell starts background jobs with SIGINT ignored; they shall end by it all the same.
  std::signal(SIGINT, SIG_DFL);
  sigemptyset(&signals_);
  sigaddset(&signals_, SIGINT);
  sigaddset(&signals_, SIGTERM);
  if (!is_ignored(SIGHUP)) sigaddset(&signals_, SIGHUP);
  // Blocked everywhere and waited for in one thread: a handler can neither remove files nor request
  // a stop safely.
  pthread_sigmask(SIG_BLOCK, &signals_, &mask_before_);
  waiter_ = start_thread("fovea-signals",
                         [this](const std::stop_token& done) { wait_for_signals(done); });
}

InterruptGuard::~InterruptGuard() {
  waiter_.request_stop();
  waiter_.join();
  pthread_sigmask(SIG_SETMASK, &mask_before_, nullptr);
}

std::stop_token InterruptGuard::stop_gently() {
  gently_ = true;
  return stop_.get_token();
}

int InterruptGuard::exit_code(int code) const { return signal_ != 0 ? kSignalled + signal_ : code; }

void InterruptGuard::wait_for_signals(const std::stop_token& done) {
  constexpr timespec kTimeout{0, 100'000'000};
  while (!done.stop_requested()) {
    const int signal = sigtimedwait(&signals_, nullptr, &kTimeout);
    if (signal <= 0) continue;
    if (!gently_ || signal_ != 0) end_program(signal);
    signal_ = signal;
    stop_.request_stop();
  }
}

void wait_for(const std::stop_token& stop) {
  std::promise<void> stopped;
  const std::stop_callback tell(stop, [&] { stopped.set_value(); });
  stopped.get_future().wait();
}

}  // namespace fovea::app
