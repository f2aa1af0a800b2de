#include "fovea/base/producer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <vector>

#include "fovea/base/errors.h"

namespace fovea::producer_test {

using Stop = std::stop_token;

/// 0, 1, ... up to `count`; `made` counts them.
Producer<int>::Make counting(int count, std::atomic<int>& made) {
  return [count, &made](const Stop&) -> std::optional<int> {
    return made < count ? std::optional(made++) : std::nullopt;
  };
}

std::vector<int> all_of(Producer<int>& producer) {
  std::vector<int> items;
  while (const auto item = producer.next()) items.push_back(*item);
  return items;
}

TEST(Producer, ItemsComeInOrder) {
  for (const std::size_t ahead : {0, 1, 3}) {
    std::atomic<int> made{0};
    Producer<int> producer(ahead, counting(500, made));
    const std::vector<int> items = all_of(producer);
    ASSERT_EQ(items.size(), 500u) << ahead;
    for (int i = 0; i < 500; ++i) ASSERT_EQ(items[std::size_t(i)], i);
    EXPECT_FALSE(producer.next());
  }
}

TEST(Producer, KeepsFewItemsAhead) {
  std::atomic<int> made{0};
  Producer<int> producer(2, counting(100, made));
  for (int taken = 0; taken < 20; ++taken) {
    while (made < taken + 2) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // so that it could go on
    ASSERT_EQ(made, taken + 2);
    ASSERT_EQ(producer.next(), taken);
  }
}

TEST(Producer, WithNothingAheadItMakesItemsInTheThreadThatAsks) {
  std::atomic<int> made{0};
  const auto here = std::this_thread::get_id();
  Producer<int> producer(0, [&](const Stop&) -> std::optional<int> {
    EXPECT_EQ(std::this_thread::get_id(), here);
    return made++;
  });
  EXPECT_EQ(made, 0);
  EXPECT_EQ(producer.next(), 0);
  EXPECT_EQ(made, 1);
  producer.stop();
  EXPECT_FALSE(producer.next());
}

// As if one thread did it all: what was made before the error is not lost.
TEST(Producer, AnErrorComesAfterTheItemsBeforeIt) {
  for (const std::size_t ahead : {0, 1, 8}) {
    std::atomic<int> made{0};
    Producer<int> producer(ahead, [&](const Stop&) -> std::optional<int> {
      if (made == 5) throw InputError("no more", "item 5", "give more");
      return made++;
    });
    for (int i = 0; i < 5; ++i) ASSERT_EQ(producer.next(), i);
    EXPECT_THROW(producer.next(), InputError) << ahead;
  }
}

TEST(Producer, WhoeverWaitsCanBeStopped) {
  std::atomic<int> made{0};
  Producer<int> waiting(1, [](const Stop& stop) -> std::optional<int> {
    while (!stop.stop_requested()) std::this_thread::yield();
    return std::nullopt;
  });
  {
    Producer<int> full(1, counting(100, made));  // is given up while it waits for room
    std::thread other([&] { waiting.stop(); });
    EXPECT_FALSE(waiting.next());  // nor does who waits for an item that does not come
    other.join();
  }
  EXPECT_LE(made, 1);
}

TEST(Producer, WhatWasMadeBeforeAStopCanStillBeTaken) {
  std::atomic<int> made{0};
  Producer<int> producer(3, counting(100, made));
  while (made < 3) std::this_thread::yield();
  producer.stop();
  EXPECT_EQ(all_of(producer), (std::vector<int>{0, 1, 2}));
}

}  // namespace fovea::producer_test
