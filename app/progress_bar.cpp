#include "app/progress_bar.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <string>

#include "fovea/core/process_memory.h"

namespace fovea::app {
namespace {

/// Between two lines where there is no terminal: a log of hours stays readable.
constexpr double kLineInterval = 30;  // s

int terminal_columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

}  // namespace

ProgressBar::ProgressBar(bool quiet, std::string_view unit)
    : quiet_(quiet), on_terminal_(isatty(STDERR_FILENO) != 0), unit_(unit) {}

ProgressBar::~ProgressBar() {
  if (drawn_) fmt::print(stderr, "\n");
}

void ProgressBar::operator()(const RunProgress& progress) {
  draw(progress.done, progress.total,
       fmt::format("{:.2f} M points, {} MB", double(progress.points) * 1e-6,
                   resident_memory() >> 20));
}

void ProgressBar::draw(int done, int total, std::string_view detail) {
  if (quiet_) return;
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const ProgressRate::Reading reading = rate_.at(done, total, seconds);
  const std::string text = progress_text(reading, unit_, detail);
  if (on_terminal_) {
    constexpr const char* kClearRest = "\x1b[K";
    fmt::print(stderr, "\r{}{}", progress_bar(reading, text, terminal_columns()), kClearRest);
    std::fflush(stderr);
    drawn_ = true;
  } else if (seconds - last_line_ >= kLineInterval) {
    fmt::print(stderr, "{}\n", text);
    last_line_ = seconds;
  }
}

}  // namespace fovea::app
