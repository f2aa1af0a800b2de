#include "fovea/core/flat_map.h"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "fovea/core/random.h"

namespace fovea::flat_map_test {

/// Keys that are near each other, far apart, and such whose low bits are all alike.
std::vector<std::uint64_t> some_keys() {
  std::vector<std::uint64_t> keys;
  for (std::uint64_t i = 0; i < 3000; ++i) {
    keys.push_back(i);
    keys.push_back(i << 42);
    keys.push_back((std::uint64_t{1} << 63) - 1 - 3 * i);
  }
  return keys;
}

TEST(FlatMap, KeepsTheFirstValueOfAKey) {
  FlatMap<int> map;
  EXPECT_EQ(map.find(7), nullptr);
  const auto [value, is_new] = map.try_emplace(7, 70);
  EXPECT_TRUE(is_new);
  EXPECT_EQ(*value, 70);
  const auto [again, is_new_again] = map.try_emplace(7, 71);
  EXPECT_FALSE(is_new_again);
  EXPECT_EQ(*again, 70);
  EXPECT_EQ(map.size(), 1u);
  map.clear();
  EXPECT_EQ(map.size(), 0u);
  EXPECT_EQ(map.find(7), nullptr);
}

TEST(FlatMap, FindsAllThatWasPutIn) {
  FlatMap<std::uint64_t> map;
  std::map<std::uint64_t, std::uint64_t> expected;
  for (const std::uint64_t key : some_keys()) {
    ASSERT_EQ(map.try_emplace(key, key ^ 5).second, expected.try_emplace(key, key ^ 5).second);
  }
  ASSERT_EQ(map.size(), expected.size());
  for (const auto& [key, value] : expected) {
    ASSERT_NE(map.find(key), nullptr);
    ASSERT_EQ(*map.find(key), value);
  }
  EXPECT_EQ(map.find(std::uint64_t{1} << 41), nullptr);
}

// Like std::map after any sequence of insertions and removals.
TEST(FlatMap, ForgetsWhatIsErasedAndNothingElse) {
  const std::vector<std::uint64_t> keys = some_keys();
  FlatMap<int> map;
  std::map<std::uint64_t, int> expected;
  Random random(3);
  for (int step = 0; step < 60'000; ++step) {
    const std::uint64_t key = keys[random.below(keys.size())];
    if (expected.contains(key)) {
      expected.erase(key);
      map.erase(key);
    } else {
      expected[key] = step;
      ASSERT_TRUE(map.try_emplace(key, step).second);
    }
    ASSERT_EQ(map.size(), expected.size());
  }
  for (const std::uint64_t key : keys) {
    const auto found = expected.find(key);
    ASSERT_EQ(map.find(key) != nullptr, found != expected.end());
    if (found != expected.end()) {
      ASSERT_EQ(*map.find(key), found->second);
    }
  }
}

}  // namespace fovea::flat_map_test
