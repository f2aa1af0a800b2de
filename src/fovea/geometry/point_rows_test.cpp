#include "fovea/geometry/point_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "fovea/core/random.h"

namespace fovea::point_rows_test {

std::vector<Eigen::Vector3f> points(std::size_t count, float extent, std::uint64_t seed) {
  Random random(seed);
  const auto any = [&] { return static_cast<float>(random.uniform(-extent, extent)); };
  std::vector<Eigen::Vector3f> result(count);
  for (Eigen::Vector3f& p : result) p = {any(), any(), any()};
  return result;
}

Eigen::Array3i cell_of(const Eigen::Vector3f& p, float edge) {
  return (p.array() / edge).floor().cast<int>();
}

TEST(PointRows, HaveEveryPointInItsCell) {
  // Keys of 32 bits, and of more.
  for (const float extent : {3.f, 20000.f}) {
    const auto cloud = points(500, extent, 1);
    const PointRows sorted(cloud, 0.5f);
    std::set<std::uint32_t> met;
    for (std::size_t row = 0; row < sorted.size(); ++row) {
      const auto [y, z, first_cell] = sorted.rows()[row];
      for (std::uint32_t c = first_cell; c < sorted.rows()[row + 1].first_cell; ++c) {
        if (c > first_cell) {
          EXPECT_LT(sorted.cells()[c - 1].x, sorted.cells()[c].x);
        }
        const std::uint32_t begin = sorted.cells()[c].first_point,
                            end = sorted.cells()[c + 1].first_point;
        EXPECT_LT(begin, end);
        for (std::uint32_t place = begin; place < end; ++place) {
          const std::uint32_t i = sorted.order()[place];
          EXPECT_TRUE(met.insert(i).second);
          EXPECT_TRUE((cell_of(cloud[i], 0.5f) == Eigen::Array3i(sorted.cells()[c].x, y, z)).all());
          for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(sorted.coordinates(axis)[place], cloud[i][Eigen::Index(axis)]);
          }
        }
      }
    }
    EXPECT_EQ(met.size(), cloud.size());
  }
}

TEST(PointRows, SurroundingsAreThePointsOfTheCellsAround) {
  const auto cloud = points(400, 3, 2);
  const float edge = 0.7f;
  const PointRows sorted(cloud, edge);
  for (const int reach : {1, 3}) {
    // As by chunks, and with rows and cells left out.
    for (const std::size_t first_row : {std::size_t{0}, sorted.size() / 3}) {
      RowSurroundings around(sorted, reach, first_row);
      for (std::size_t row = first_row; row < sorted.size(); row += 1 + row % 3) {
        around.begin_row(row);
        const auto [y, z, first_cell] = sorted.rows()[row];
        for (auto c = first_cell; c < sorted.rows()[row + 1].first_cell; c += 1 + c % 2) {
          const Eigen::Array3i center(sorted.cells()[c].x, y, z);
          around.move_to(center.x());
          std::set<std::uint32_t> found;
          for (const auto& [begin, end] : around.ranges()) {
            EXPECT_LT(begin, end);
            for (std::uint32_t i = begin; i < end; ++i) found.insert(sorted.order()[i]);
          }
          EXPECT_EQ(found.size(), around.size());
          std::set<std::uint32_t> truth;
          for (std::uint32_t i = 0; i < cloud.size(); ++i) {
            if (((cell_of(cloud[i], edge) - center).abs() <= reach).all()) truth.insert(i);
          }
          ASSERT_EQ(found, truth);
        }
      }
    }
  }
}

TEST(PointRows, OfNothingAndOfWhatIsFarOff) {
  const PointRows none({}, 1.f);
  EXPECT_EQ(none.size(), 0u);
  EXPECT_EQ(none.cells().size(), 1u);
  const std::vector<Eigen::Vector3f> far{{3e30f, 0, 0}, {-3e30f, 1e12f, 5}, {0, 0, 0}};
  const PointRows sorted(far, 1.f);
  EXPECT_EQ(sorted.size(), 2u);
  EXPECT_EQ(sorted.cells().size(), 3u + 1);
  EXPECT_EQ(sorted.order().size(), 3u);
  EXPECT_THROW(PointRows(far, 0.f), std::invalid_argument);
}

}  // namespace fovea::point_rows_test
