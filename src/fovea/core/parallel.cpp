#include "fovea/core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#if defined(FOVEA_THREAD_SANITIZER)
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#endif

namespace fovea {
namespace {

#if defined(FOVEA_THREAD_SANITIZER)
// Debian's TBB is built without the thread sanitizer, which therefore reports TBB's synchronization
// as races. A suppression that names TBB would hide our races, too: TBB is on the stack of each.
// Under the thread sanitizer, chunks therefore run on plain threads.
template <class Run>
void run_chunks(std::size_t chunks, const Run& run) {
  const std::size_t threads = std::min(
      chunks, tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  std::atomic<std::size_t> next{0};
  std::mutex error_guard;
  std::exception_ptr error;
  std::vector<std::thread> workers;
  for (std::size_t i = 0; i < threads; ++i) {
    workers.emplace_back([&] {
      try {
        for (std::size_t c; (c = next.fetch_add(1, std::memory_order_relaxed)) < chunks;) run(c);
      } catch (...) {
        const std::lock_guard lock(error_guard);
        error = std::current_exception();
        next = chunks;
      }
    });
  }
  for (std::thread& worker : workers) worker.join();
  if (error) std::rethrow_exception(error);
}

#else
template <class Run>
void run_chunks(std::size_t chunks, const Run& run) {
  // A thread that waits for the last chunk helps with this loop only: other work may take long.
  tbb::this_task_arena::isolate([&] { tbb::parallel_for(std::size_t{0}, chunks, run); });
}
#endif

}  // namespace

void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t chunks = (count + grain - 1) / grain;
  const auto run = [&](std::size_t chunk) {
    body(chunk * grain, std::min(count, (chunk + 1) * grain));
  };
  if (chunks == 1) {
    run(0);
  } else {
    run_chunks(chunks, run);
  }
}

void parallel_in_order(std::size_t count, const std::function<void(std::size_t)>& make,
                       const std::function<void(std::size_t)>& take) {
#if defined(FOVEA_THREAD_SANITIZER)
  run_chunks(count, make);
  for (std::size_t i = 0; i < count; ++i) take(i);
#else
  // Items per thread that may be made ahead of take(): one item may take long.
  constexpr std::size_t kAhead = 2;
  std::size_t next = 0;
  const auto number = [&](tbb::flow_control& flow) {
    if (next == count) flow.stop();
    return next++;
  };
  const auto made = [&](std::size_t i) {
    make(i);
    return i;
  };
  using Mode = tbb::filter_mode;
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_pipeline(kAhead * static_cast<std::size_t>(available_threads()),
                           tbb::make_filter<void, std::size_t>(Mode::serial_in_order, number) &
                               tbb::make_filter<std::size_t, std::size_t>(Mode::parallel, made) &
                               tbb::make_filter<std::size_t, void>(Mode::serial_in_order, take));
  });
#endif
}

void run_both(const std::function<void()>& a, const std::function<void()>& b) {
  parallel_chunks(2, 1, [&](std::size_t begin, std::size_t) { begin == 0 ? a() : b(); });
}

int available_threads() {
  return static_cast<int>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

// Made in place: a copy of a global_control ends with the lifetime of its source.
struct ThreadLimit::Control {
  explicit Control(std::size_t threads)
      : limit(tbb::global_control::max_allowed_parallelism, threads) {}
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads) {
  if (threads > 0) control_ = std::make_unique<Control>(static_cast<std::size_t>(threads));
}

ThreadLimit::~ThreadLimit() = default;

}  // namespace fovea
