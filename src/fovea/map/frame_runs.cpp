#include "fovea/map/frame_runs.h"

#include <algorithm>

namespace fovea {

std::size_t FrameRuns::run_of(std::size_t i) const {
  const auto after = std::upper_bound(runs_.begin(), runs_.end(), i,
                                      [](std::size_t at, const Run& run) { return at < run.end; });
  return static_cast<std::size_t>(after - runs_.begin());
}

void FrameRuns::keep(std::span<const std::uint32_t> indices) {
  FrameRuns kept;
  auto run = runs_.begin();
  for (const std::uint32_t i : indices) {
    while (i >= run->end) ++run;
    kept.push_back(run->frame);
  }
  *this = std::move(kept);
}

void FrameRuns::copy_to(std::span<std::int32_t> frames) const {
  auto to = frames.begin();
  for (const Run& run : runs_) {
    const auto end = frames.begin() + run.end;
    std::fill(to, end, run.frame);
    to = end;
  }
}

}  // namespace fovea
