#include "fovea/base/copy_on_write.h"

#include <gtest/gtest.h>

#include <numeric>
#include <thread>
#include <vector>

namespace fovea::copy_on_write_test {

TEST(CopyOnWrite, IsSharedUntilOneChangesIt) {
  CopyOnWrite<std::vector<int>> a(std::vector<int>{1, 2, 3});
  const CopyOnWrite<std::vector<int>> b = a;
  EXPECT_EQ(&*a, &*b);
  a.write()[0] = 9;
  EXPECT_EQ(*a, (std::vector<int>{9, 2, 3}));
  EXPECT_EQ(*b, (std::vector<int>{1, 2, 3}));
  const auto* own = &*a;
  a.write()[1] = 9;  // nobody else holds it any more
  EXPECT_EQ(&*a, own);
}

TEST(CopyOnWrite, HandlesMoveAndReplaceEachOther) {
  CopyOnWrite<std::vector<int>> a(std::vector<int>{1});
  CopyOnWrite<std::vector<int>> b(std::vector<int>{2});
  const auto* first = &*a;
  b = std::move(a);
  EXPECT_EQ(&*b, first);
  b = CopyOnWrite<std::vector<int>>(b);  // itself
  EXPECT_EQ(b->size(), 1u);
  EXPECT_TRUE(CopyOnWrite<std::vector<int>>()->empty());
}

// What a snapshot holds stays as it was, however its reader and the one who goes on interleave; the
// thread sanitizer sees to the rest.
TEST(CopyOnWrite, ASnapshotIsReadWhileTheOriginalGoesOn) {
  CopyOnWrite<std::vector<int>> value(std::vector<int>(100, 0));
  for (int round = 1; round <= 200; ++round) {
    std::thread reader([snapshot = value, round] {
      EXPECT_EQ(std::accumulate(snapshot->begin(), snapshot->end(), 0), 100 * (round - 1));
    });
    for (int& number : value.write()) ++number;
    reader.join();
  }
}

}  // namespace fovea::copy_on_write_test
