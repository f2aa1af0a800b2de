// Parallel loops whose result does not depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace fovea {

/// Calls `body(begin, end)` on consecutive chunks of at most `grain` items of [0, count), on the
/// threads there are. Chunk bounds are multiples of `grain`, whatever the number of threads.
void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body);

/// Calls `body(i)` for each i of [0, count), in parallel.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, Body&& body) {
  parallel_chunks(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// Calls `make(i)` for each i of [0, count), in parallel, and after it `take(i)`, in order and one
/// at a time: what needs the order goes on beside what does not.
void parallel_in_order(std::size_t count, const std::function<void(std::size_t)>& make,
                       const std::function<void(std::size_t)>& take);

/// Sums `map(begin, end)` of fixed chunks in the order of the chunks: floating-point results are
/// the same at any number of threads.
template <class T, class Map>
T parallel_sum(std::size_t count, std::size_t grain, T zero, Map&& map) {
  std::vector<T> partial((count + grain - 1) / grain, zero);
  parallel_chunks(count, grain, [&](std::size_t begin, std::size_t end) {
    partial[begin / grain] = map(begin, end);
  });
  for (const T& part : partial) zero += part;
  return zero;
}

/// Runs two things side by side where there are two threads.
void run_both(const std::function<void()>& a, const std::function<void()>& b);

/// How many threads the loops above may use.
int available_threads();

/// While it lives, at most `threads` threads work (0: as many as the machine has).
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace fovea
