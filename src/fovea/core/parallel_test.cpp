#include "fovea/core/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>

namespace fovea::parallel_test {

TEST(ParallelInOrder, TakesInOrderWhatHasBeenMade) {
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    for (const std::size_t count : {0u, 1u, 1000u}) {
      std::vector<std::atomic<int>> made(count);
      std::vector<std::size_t> taken;
      parallel_in_order(
          count, [&](std::size_t i) { ++made[i]; },
          [&](std::size_t i) {
            EXPECT_EQ(made[i], 1);
            taken.push_back(i);
          });
      std::vector<std::size_t> all(count);
      std::iota(all.begin(), all.end(), std::size_t{0});
      EXPECT_EQ(taken, all);
    }
  }
}

TEST(ParallelInOrder, AnErrorOfEitherComesOut) {
  const auto fail = [](std::size_t i) {
    if (i == 7) throw std::out_of_range("seven");
  };
  const auto nothing = [](std::size_t) {};
  EXPECT_THROW(parallel_in_order(100, fail, nothing), std::out_of_range);
  EXPECT_THROW(parallel_in_order(100, nothing, fail), std::out_of_range);
}

}  // namespace fovea::parallel_test
