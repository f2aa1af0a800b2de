#include "fovea/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace fovea {

void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t chunks = (count + grain - 1) / grain;
  const auto run = [&](std::size_t chunk) {
    body(chunk * grain, std::min(count, (chunk + 1) * grain));
  };
  if (chunks == 1) {
    run(0);
  } else {
    tbb::parallel_for(std::size_t{0}, chunks, run);
  }
}

struct ThreadLimit::Control {
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0) {
    control_ = std::make_unique<Control>(Control{tbb::global_control(
        tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads))});
  }
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace fovea
