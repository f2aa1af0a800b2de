// A program with a data race, which the thread sanitizer must find: planted_race none|loop|queue.
#include <chrono>
#include <cstdio>
#include <memory>
#include <string_view>
#include <thread>

#include "fovea/core/bounded_queue.h"
#include "fovea/core/parallel.h"
#include "fovea/core/thread.h"

namespace {

using namespace fovea;

/// Adds numbers in parallel; with a race, into one sum.
int sum_in_loop(bool race) {
  constexpr std::size_t kCount = 50;
  int racy = 0;
  const int sum = parallel_sum(kCount, 1, 0, [&](std::size_t begin, std::size_t end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // so that all threads take part
    if (race) racy += int(end - begin);
    return int(end - begin);
  });
  return race ? racy : sum;
}

/// Passes a number through a queue; with a race, changes it afterwards.
int pass_through_queue(bool race) {
  BoundedQueue<std::shared_ptr<int>> queue(1);
  const std::jthread producer = start_thread("producer", [&](const std::stop_token& stop) {
    const auto number = std::make_shared<int>(1);
    if (queue.push(number, stop) && race) *number = 2;
  });
  return **queue.pop();
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view race = argc > 1 ? argv[1] : "";
  std::printf("%d %d\n", sum_in_loop(race == "loop"), pass_through_queue(race == "queue"));
  return 0;
}
