#include "fovea/drive/recordings/missing_messages.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fovea::missing_messages_test {

constexpr TimeNs kPeriod = 100'000'000;

/// Stamps at 10 Hz with the jitter of a driver, without those of `lost`.
std::vector<TimeNs> stamps(int count, const std::vector<int>& lost = {}) {
  std::vector<TimeNs> result;
  for (int i = 0; i < count; ++i) {
    if (std::find(lost.begin(), lost.end(), i) != lost.end()) continue;
    result.push_back(1'700'000'000'000'000'000 + i * kPeriod + (i * 7919 % 13) * 1'000'000);
  }
  return result;
}

TEST(MissingMessages, NoneOfASteadySensor) {
  EXPECT_EQ(missing_messages(stamps(50)), 0u);
  EXPECT_EQ(missing_messages({}), 0u);
}

TEST(MissingMessages, GapsAreCounted) {
  EXPECT_EQ(missing_messages(stamps(50, {20})), 1u);
  EXPECT_EQ(missing_messages(stamps(50, {5, 20, 21, 22, 40})), 5u);
}

TEST(MissingMessages, ManyMayBeLost) {
  std::vector<int> lost;
  for (int i = 1; i < 200; i += 7) lost.push_back(i);
  EXPECT_EQ(missing_messages(stamps(201, lost)), lost.size());
}

TEST(MissingMessages, NoneOfASensorWithoutARate) {
  std::vector<TimeNs> triggered;
  for (int i = 0; i < 50; ++i) triggered.push_back(TimeNs{i} * i * kPeriod + 1);
  EXPECT_EQ(missing_messages(triggered), 0u);
}

}  // namespace fovea::missing_messages_test
