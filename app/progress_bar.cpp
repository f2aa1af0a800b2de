#include "app/progress_bar.h"

#include <fmt/core.h>
#include <unistd.h>

#include <cstdio>
#include <string>

namespace fovea::app {

ProgressBar::ProgressBar(bool quiet) : enabled_(!quiet && isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (drawn_) fmt::print(stderr, "\n");
}

void ProgressBar::operator()(const MapProgress& progress) {
  if (!enabled_) return;
  drawn_ = true;
  constexpr int kWidth = 30;
  const int filled = progress.total > 0 ? kWidth * progress.done / progress.total : kWidth;
  const double elapsed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double rate = progress.done / std::max(elapsed, 1e-3);
  fmt::print(stderr, "\r[{:<{}}] {}/{} frames  {:.1f}/s  {:.2f} M points  {:.0f} s left ",
             std::string(std::size_t(filled), '#'), kWidth, progress.done, progress.total, rate,
             double(progress.points) * 1e-6,
             (progress.total - progress.done) / std::max(rate, 1e-3));
  std::fflush(stderr);
}

}  // namespace fovea::app
