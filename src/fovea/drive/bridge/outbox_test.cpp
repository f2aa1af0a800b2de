#include "fovea/drive/bridge/outbox.h"

#include <gtest/gtest.h>

#include <thread>

namespace fovea::outbox_test {
namespace {

using fovea::bridge::Outbox;

TEST(BridgeOutbox, DropsTheOldestItem) {
  Outbox<int> outbox(2);
  for (const int item : {1, 2, 3, 4}) outbox.post(item);
  EXPECT_EQ(outbox.take(), 3);
  EXPECT_EQ(outbox.take(), 4);
  EXPECT_EQ(outbox.take(), std::nullopt);
  EXPECT_EQ(outbox.counts().posted, 4u);
  EXPECT_EQ(outbox.counts().dropped, 2u);
}

TEST(BridgeOutbox, WakesOnceForAllItemsThatAreNotTakenYet) {
  Outbox<int> outbox(2);
  int woken = 0;
  outbox.on_post([&] { ++woken; });
  for (const int item : {1, 2, 3}) outbox.post(item);
  EXPECT_EQ(woken, 1);
  while (outbox.take()) {
  }
  outbox.post(4);
  EXPECT_EQ(woken, 2);
  outbox.take();
  outbox.on_post({});
  outbox.post(5);
  EXPECT_EQ(woken, 2);
}

TEST(BridgeOutbox, LosesNoItemOfSeveralThreads) {
  constexpr int kItems = 10'000;
  Outbox<int> outbox(2 * kItems);
  {
    const auto post = [&] {
      for (int item = 1; item <= kItems; ++item) outbox.post(item);
    };
    const std::jthread first(post), second(post);
  }
  int sum = 0;
  while (const std::optional<int> item = outbox.take()) sum += *item;
  EXPECT_EQ(sum, kItems * (kItems + 1));
  EXPECT_EQ(outbox.counts().dropped, 0u);
}

}  // namespace
}  // namespace fovea::outbox_test
