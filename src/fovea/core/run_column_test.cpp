#include "fovea/core/run_column.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fovea/core/random.h"

namespace fovea::run_column_test {

using Values = std::vector<std::int32_t>;
using Column = RunColumn<std::int32_t>;

Values all_of(const Column& runs) {
  Values values(runs.size());
  runs.copy_to(values);
  return values;
}

/// Runs of 1 to 5 equal values, of few, in any order.
Values random_values(std::size_t count, Random& random) {
  Values values;
  while (values.size() < count) {
    const auto value = static_cast<std::int32_t>(random.next() % 4) - 1;
    for (std::uint64_t n = 1 + random.next() % 5; n > 0; --n) values.push_back(value);
  }
  return values;
}

TEST(RunColumn, TellsEachValue) {
  Random random(1);
  const Values values = random_values(300, random);
  const Column runs(values);
  ASSERT_EQ(runs.size(), values.size());
  EXPECT_EQ(all_of(runs), values);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(runs[i], values[i]);
  EXPECT_EQ(runs.back(), values.back());
}

TEST(RunColumn, EqualNeighboursAreOneRun) {
  Column runs;
  EXPECT_EQ(runs.size(), 0u);
  for (const std::int32_t value : {7, 7, 7, 9, 7}) runs.push_back(value);
  EXPECT_EQ(runs.runs(), (std::vector<Column::Run>{{7, 3}, {9, 4}, {7, 5}}));
  runs.push_back(7, 3);
  EXPECT_EQ(runs.runs().back(), (Column::Run{7, 8}));
  runs.keep(std::vector<std::uint32_t>{1, 2, 4});
  EXPECT_EQ(runs.runs(), (std::vector<Column::Run>{{7, 3}}));
  runs.keep({});
  EXPECT_EQ(runs, Column());
}

TEST(RunColumn, KeepsWhatIsAskedFor) {
  Random random(2);
  const Values values = random_values(300, random);
  std::vector<std::uint32_t> indices;
  Values kept;
  for (std::uint32_t i = 0; i < values.size(); ++i) {
    if (random.uniform() < 0.6) continue;
    indices.push_back(i);
    kept.push_back(values[i]);
  }
  Column runs(values);
  runs.keep(indices);
  EXPECT_EQ(runs, Column(kept));
}

TEST(RunColumn, PutsAValueInThePlaceOfSome) {
  Random random(3);
  for (const double share : {0.0, 0.1, 0.6, 1.0}) {
    Values values = random_values(300, random);
    Column runs(values);
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < values.size(); ++i) {
      if (random.uniform() >= share) continue;
      indices.push_back(i);
      values[i] = 1;
    }
    runs.put(indices, 1);
    EXPECT_EQ(runs, Column(values));
  }
}

TEST(RunColumn, ANanIsARunOfItsOwn) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  RunColumn<float> runs(std::vector<float>{1, nan, nan, 2});
  EXPECT_EQ(runs.size(), 4u);
  runs.keep(std::vector<std::uint32_t>{0, 2, 3});
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_TRUE(std::isnan(runs[1]));
  EXPECT_EQ(runs[2], 2);
}

TEST(RunColumn, GoesThroughRunsFromAnyPlaceOn) {
  using Seen = std::vector<std::array<std::int64_t, 3>>;
  const Column runs(Values{4, 4, 5, 5, 5, 8});
  const Seen all{{0, 2, 4}, {2, 5, 5}, {5, 6, 8}};
  Seen seen;
  runs.for_each_run(
      [&](auto begin, auto end, std::int32_t value) { seen.push_back({begin, end, value}); });
  EXPECT_EQ(seen, all);
  for (std::uint32_t first = 0; first <= runs.size(); ++first) {
    Seen expected;
    for (const auto& [begin, end, value] : all) {
      if (end > first && value <= 5)
        expected.push_back({std::max<std::int64_t>(begin, first), end, value});
    }
    seen.clear();
    runs.for_each_run_from(first, [&](auto begin, auto end, std::int32_t value) {
      if (value > 5) return false;
      seen.push_back({begin, end, value});
      return true;
    });
    EXPECT_EQ(seen, expected) << first;
  }
  Column().for_each_run([](auto, auto, auto) { FAIL(); });
}

}  // namespace fovea::run_column_test
