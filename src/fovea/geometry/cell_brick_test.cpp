#include "fovea/geometry/cell_brick.h"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "fovea/core/random.h"

namespace fovea::cell_brick_test {

using Key = std::array<int, 3>;

Key key_of(const Eigen::Array3i& cell) { return {cell.x(), cell.y(), cell.z()}; }

TEST(CellBrick, EachCellHasABitOfItsOwn) {
  for (int marked = 0; marked < 512; ++marked) {
    CellBrick brick;
    const Eigen::Array3i cell(marked & 7, marked >> 3 & 7, marked >> 6);
    EXPECT_FALSE(brick.test(cell));
    EXPECT_TRUE(brick.mark(cell));
    EXPECT_FALSE(brick.mark(cell));
    int found = 0;
    for (int i = 0; i < 512; ++i) found += brick.test({i & 7, i >> 3 & 7, i >> 6});
    EXPECT_EQ(found, 1);
    EXPECT_TRUE(brick.test(cell));
  }
}

TEST(CellBrick, MarksAddUp) {
  CellBrick brick;
  for (int i = 0; i < 512; ++i) {
    ASSERT_TRUE(brick.mark({i * 5 & 7, (i * 5 >> 3) & 7, (i * 5 >> 6) & 7}));
  }
  for (int i = 0; i < 512; ++i) ASSERT_TRUE(brick.test({i & 7, i >> 3 & 7, i >> 6}));
}

TEST(CellBrick, ACubeIsMarkedIfOneOfItsCellsIs) {
  for (int marked = 0; marked < 512; ++marked) {
    CellBrick brick;
    const Eigen::Array3i cell(marked & 7, marked >> 3 & 7, marked >> 6);
    brick.mark(cell);
    for (const int edge : {1, 2, 4, 8}) {
      for (int i = 0; i < 512; ++i) {
        const Eigen::Array3i low = Eigen::Array3i(i & 7, i >> 3 & 7, i >> 6) / edge * edge;
        const bool holds = (cell >= low).all() && (cell < low + edge).all();
        ASSERT_EQ(brick.test_cube(low, edge), holds);
      }
    }
  }
}

TEST(CellSet, CellsOnBothSidesOfBordersAreTheirOwn) {
  CellSet cells;
  std::set<Key> expected;
  for (const int border : {0, 8, -8, -16, 1 << 20, -(1 << 20)}) {
    for (int x = -2; x < 2; ++x) {
      for (int y = -2; y < 2; ++y) {
        for (int z = -2; z < 2; ++z) {
          const Eigen::Array3i cell = border + Eigen::Array3i(x, y, z);
          ASSERT_EQ(cells.mark(cell), expected.insert(key_of(cell)).second);
          ASSERT_FALSE(cells.mark(cell));
        }
      }
    }
  }
}

// Coordinates must not run into each other in the key of a brick.
TEST(CellSet, CellsFarApartAreTheirOwn) {
  constexpr int kFar = 1 << 23;
  const int values[] = {-kFar, -kFar + 1, -kFar / 2, -9, -8, -1, 0, 1, 7, 8, kFar / 2, kFar - 1};
  CellSet cells;
  for (const int x : values) {
    for (const int y : values) {
      for (const int z : values) ASSERT_TRUE(cells.mark({x, y, z})) << x << " " << y << " " << z;
    }
  }
  for (const int x : values) {
    for (const int y : values) {
      for (const int z : values) ASSERT_FALSE(cells.mark({x, y, z})) << x << " " << y << " " << z;
    }
  }
}

TEST(CellSet, EqualsASetOfCells) {
  for (const int reach : {3, 20, 1000, 8'000'000}) {
    Random random(std::uint64_t(reach) + 1);
    CellSet cells;
    std::set<Key> expected;
    Eigen::Array3i cell(0, 0, 0);
    const auto bound = static_cast<std::uint64_t>(2 * reach + 1);
    for (int i = 0; i < 20'000; ++i) {
      if (i % 3 == 0) {  // near the one before, and anywhere
        cell += static_cast<int>(random.below(3)) - 1;
        cell = cell.max(-reach).min(reach).eval();
      } else {
        for (int& coordinate : cell) coordinate = static_cast<int>(random.below(bound)) - reach;
      }
      ASSERT_EQ(cells.mark(cell), expected.insert(key_of(cell)).second);
    }
  }
}

}  // namespace fovea::cell_brick_test
