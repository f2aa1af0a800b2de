#include "app/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace fovea::app {

ProgressBar::ProgressBar(bool quiet, std::string_view unit)
    : enabled_(!quiet && isatty(STDERR_FILENO) != 0), unit_(unit) {}

ProgressBar::~ProgressBar() {
  if (drawn_) fmt::print(stderr, "\n");
}

void ProgressBar::operator()(const MapProgress& progress) {
  draw(progress.done, progress.total,
       fmt::format("{:.2f} M points  ", double(progress.points) * 1e-6));
}

void ProgressBar::draw(int done, int total, std::string_view detail) {
  if (!enabled_) return;
  drawn_ = true;
  constexpr int kWidth = 30;
  const int filled = total > 0 ? kWidth * done / total : kWidth;
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double rate = done / std::max(elapsed, 1e-3);
  fmt::print(stderr, "\r[{:<{}}] {}/{} {}  {:.1f}/s  {}{:.0f} s left ",
             std::string(std::size_t(filled), '#'), kWidth, done, total, unit_, rate, detail,
             (total - done) / std::max(rate, 1e-3));
  std::fflush(stderr);
}

}  // namespace fovea::app
