#include "fovea/base/prefetch.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace fovea::prefetch_test {

/// 0, 1, 2 and so on up to before `count`.
Prefetch<int>::Make counting(int count, std::atomic<int>& made) {
  return [count, &made]() -> std::optional<int> {
    return made < count ? std::optional<int>(made++) : std::nullopt;
  };
}

std::vector<int> all_of(Prefetch<int>& stage) {
  std::vector<int> items;
  while (const auto item = stage.next()) items.push_back(*item);
  return items;
}

TEST(Prefetch, ChainedStagesKeepTheOrder) {
  std::vector<int> squares(500);
  for (int i = 0; i < 500; ++i) squares[std::size_t(i)] = i * i;
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    for (const bool ahead : {false, true}) {
      std::atomic<int> made{0};
      Prefetch<int> first(ahead, counting(500, made));
      Prefetch<int> second(ahead, [&]() -> std::optional<int> {
        const auto item = first.next();
        return item ? std::optional<int>(*item * *item) : std::nullopt;
      });
      EXPECT_EQ(all_of(second), squares);
      EXPECT_EQ(second.next(), std::nullopt);
    }
  }
}

TEST(Prefetch, OneItemIsMadeWhileAnotherIsUsed) {
  if (available_threads() < 2) GTEST_SKIP() << "one processor";
  std::latch begun(1), used(1);
  int made = 0;
  Prefetch<int> stage(true, [&]() -> std::optional<int> {
    if (made == 1) {
      begun.count_down();
      used.wait();
    }
    return made < 2 ? std::optional<int>(made++) : std::nullopt;
  });
  EXPECT_EQ(stage.next(), 0);
  begun.wait();  // though nobody has asked for the second
  used.count_down();
  EXPECT_EQ(stage.next(), 1);
  EXPECT_EQ(stage.next(), std::nullopt);
}

TEST(Prefetch, NoMoreThanOneIsMadeAhead) {
  std::atomic<int> made{0};
  Prefetch<int> stage(true, counting(100, made));
  for (int taken = 0; taken < 100; ++taken) {
    ASSERT_LE(made, taken + 1);
    ASSERT_EQ(stage.next(), taken);
  }
  const Prefetch<int> on_demand(false, counting(200, made));
  EXPECT_EQ(made, 100);
}

TEST(Prefetch, StagesMayUseLoops) {
  Prefetch<std::size_t> stage(
      true, [count = std::size_t{0}]() mutable -> std::optional<std::size_t> {
        if (count == 20) return std::nullopt;
        const std::size_t size = 1000 * ++count;
        return parallel_sum(size, 100, std::size_t{0},
                            [](std::size_t begin, std::size_t end) { return end - begin; });
      });
  for (std::size_t i = 1; i <= 20; ++i) {
    std::atomic<std::size_t> items{0};
    parallel_for(5000, 10, [&](std::size_t) { ++items; });
    EXPECT_EQ(items, 5000u);
    EXPECT_EQ(stage.next(), 1000 * i);
  }
}

TEST(Prefetch, AnErrorComesAfterTheItemsBeforeIt) {
  for (const bool ahead : {false, true}) {
    int made = 0;
    Prefetch<int> first(ahead, [&]() -> std::optional<int> {
      if (made == 3) throw std::out_of_range("three");
      return made++;
    });
    Prefetch<int> second(ahead, [&] { return first.next(); });
    for (int i = 0; i < 3; ++i) ASSERT_EQ(second.next(), i);
    EXPECT_THROW(second.next(), std::out_of_range);
    if (ahead) {
      EXPECT_EQ(second.next(), std::nullopt);
    }
  }
}

// Whoever is given up early leaves nothing behind that still runs.
TEST(Prefetch, GivenUpItWaitsForWhatItBegan) {
  std::atomic<int> made{0};
  for (int i = 0; i < 100; ++i) {
    Prefetch<std::unique_ptr<int>> stage(true, [&]() -> std::optional<std::unique_ptr<int>> {
      ++made;
      if (made % 3 == 0) throw std::out_of_range("nobody asks");
      return std::make_unique<int>(i);
    });
  }
  EXPECT_EQ(made, 100);
}

}  // namespace fovea::prefetch_test
