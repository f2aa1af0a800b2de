#include "fovea/core/bounded_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <vector>

#include "fovea/core/thread.h"
#include "fovea/errors.h"

namespace fovea::bounded_queue_test {

using namespace std::chrono_literals;

/// Returns 0, 1, ... count - 1; `made` counts them.
auto counting(int count, std::atomic<int>& made) {
  return [count, &made]() -> std::optional<int> {
    return made < count ? std::optional(made++) : std::nullopt;
  };
}

TEST(BoundedQueue, PassesItemsInOrderBetweenThreads) {
  for (const std::size_t capacity : {1, 2, 100}) {
    BoundedQueue<std::unique_ptr<int>> queue(capacity);
    const std::jthread producer = start_thread("numbers", [&](const std::stop_token& stop) {
      for (int i = 0; i < 1000; ++i) ASSERT_TRUE(queue.push(std::make_unique<int>(i), stop));
      queue.close();
    });
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(**queue.pop(), i);
    EXPECT_FALSE(queue.pop());
    EXPECT_FALSE(queue.pop());
  }
}

TEST(BoundedQueue, HoldsNoMoreThanItsCapacity) {
  BoundedQueue<int> queue(2);
  std::atomic<int> made{0};
  const std::jthread producer = start_thread(
      "numbers", [&](const std::stop_token& stop) { fill(queue, stop, counting(100, made)); });
  for (int taken = 0; taken < 20; ++taken) {
    while (made < taken + 3) std::this_thread::yield();  // two in the queue, one waits for room
    std::this_thread::sleep_for(1ms);                    // time for one too many
    ASSERT_EQ(made, taken + 3);
    ASSERT_EQ(queue.pop(), taken);
  }
}

TEST(BoundedQueue, UrgentItemsGoFirstInTheirOrderEvenIfTheQueueIsFull) {
  BoundedQueue<int> queue(2);
  EXPECT_TRUE(queue.push(3));
  EXPECT_TRUE(queue.push(4));
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(queue.push_urgent(i));
  EXPECT_EQ(queue.pop(), 0);
  queue.close();
  for (int i = 1; i < 5; ++i) EXPECT_EQ(queue.pop(), i);
  EXPECT_FALSE(queue.pop());
}

TEST(BoundedQueue, AClosedQueueTakesNothingAndGivesTheRest) {
  BoundedQueue<int> queue(5);
  EXPECT_TRUE(queue.push(7));
  queue.close();
  EXPECT_FALSE(queue.push(8));
  EXPECT_FALSE(queue.push_urgent(9));
  EXPECT_EQ(queue.pop(), 7);
  EXPECT_FALSE(queue.pop());
}

TEST(BoundedQueue, TheRestCanBeTakenAtOnce) {
  BoundedQueue<int> queue(5);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(queue.push(i));
  EXPECT_EQ(queue.pop(), 0);
  EXPECT_EQ(queue.close_and_take(), (std::deque<int>{1, 2}));
  EXPECT_FALSE(queue.pop());
  EXPECT_FALSE(queue.push(3));
}

TEST(BoundedQueue, AnErrorComesAfterTheItemsBeforeIt) {
  BoundedQueue<int> queue(8);
  int made = 0;
  fill(queue, {}, [&]() -> std::optional<int> {
    if (made == 5) throw InputError("no more", "item 5", "give more");
    return made++;
  });
  for (int i = 0; i < 5; ++i) ASSERT_EQ(queue.pop(), i);
  EXPECT_THROW(queue.pop(), InputError);
  EXPECT_FALSE(queue.pop());
}

TEST(BoundedQueue, AStopEndsTheWaitOfEitherSide) {
  BoundedQueue<int> full(1), empty(1);
  EXPECT_TRUE(full.push(1));
  std::atomic<bool> pushed{true}, popped{true};
  {
    const std::jthread pushing =
        start_thread("push", [&](const std::stop_token& stop) { pushed = full.push(2, stop); });
    const std::jthread popping = start_thread(
        "pop", [&](const std::stop_token& stop) { popped = empty.pop(stop).has_value(); });
    std::this_thread::sleep_for(5ms);  // time to begin to wait
  }
  EXPECT_FALSE(pushed);
  EXPECT_FALSE(popped);
}

TEST(BoundedQueue, ClosingEndsTheWaitOfAFullQueue) {
  BoundedQueue<int> queue(1);
  std::atomic<int> made{0};
  const std::jthread producer = start_thread(
      "numbers", [&](const std::stop_token& stop) { fill(queue, stop, counting(100, made)); });
  while (made < 2) std::this_thread::yield();
  queue.close();
}

}  // namespace fovea::bounded_queue_test
