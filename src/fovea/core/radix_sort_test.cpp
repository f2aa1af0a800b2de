#include "fovea/core/radix_sort.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fovea/core/random.h"

namespace fovea::radix_sort_test {

struct Item {
  std::uint64_t key;
  std::uint32_t index;
  friend bool operator==(const Item&, const Item&) = default;
};

TEST(RadixSort, SortsAsStdStableSort) {
  Random random(1);
  for (const int bits : {1, 5, 11, 12, 32, 63}) {
    for (const std::uint32_t count : {0u, 1u, 2u, 5000u}) {
      std::vector<Item> items;
      for (std::uint32_t i = 0; i < count; ++i) items.push_back({random.next() >> (64 - bits), i});
      std::vector<Item> sorted = items;
      std::ranges::stable_sort(sorted, {}, &Item::key);
      radix_sort(items, bits);
      EXPECT_EQ(items, sorted) << bits << " bits, " << count << " items";
    }
  }
}

}  // namespace fovea::radix_sort_test
