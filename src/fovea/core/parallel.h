// Parallel loops whose result does not depend on the number of threads.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace fovea {

/// Calls `body(begin, end)` for consecutive chunks of at most `grain` items of [0, count), in
/// parallel. Chunk bounds are multiples of `grain` at any number of threads.
void parallel_chunks(std::size_t count, std::size_t grain,
                     const std::function<void(std::size_t, std::size_t)>& body);

/// Calls `body(i)` for each i of [0, count), in parallel.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, Body&& body) {
  parallel_chunks(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) body(i);
  });
}

/// Calls `make(i)` for each i of [0, count), in parallel. After each of them, calls `take(i)` in
/// order and one at a time, while later items are made.
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

/// Runs two functions, in parallel if there are two threads.
void run_both(const std::function<void()>& a, const std::function<void()>& b);

/// Number of threads that the loops above may use.
int available_threads();

/// Limits each of the loops above to `threads` threads during its lifetime (0: no limit).
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
