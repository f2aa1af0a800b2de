#include "fovea/map/tile_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "../../../tests/sample_map.h"
#include "fovea/core/random.h"

namespace fovea::tile_points_test {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

PointCloud random_tile(std::size_t count) {
  Random random(11);
  PointCloud tile = random_map_points(count, random, 4.0);
  for (Eigen::Vector3f& p : tile.position) p = p.cwiseAbs();
  return tile;
}

TEST(TilePoints, NumbersAreWithinHalfAStep) {
  const PointCloud tile = random_tile(3000);
  const TilePoints points = TilePoints::of(tile);
  ASSERT_EQ(points.size(), tile.size());
  for (std::size_t i = 0; i < tile.size(); ++i) {
    EXPECT_LE((points.position_at(i) - tile.position[i]).cwiseAbs().maxCoeff(), 0.5005e-3f);
    EXPECT_NEAR(points.range_at(i), tile.range[i], 0.00501);
    if (std::isnan(tile.incidence[i])) {
      EXPECT_TRUE(std::isnan(points.incidence_at(i)));
    } else {
      EXPECT_NEAR(points.incidence_at(i), tile.incidence[i], 0.00437);
    }
  }
}

TEST(TilePoints, ACloudThatWasRoundedComesBackAsItWas) {
  const PointCloud rounded = TilePoints::of(random_tile(3000)).cloud();
  expect_same_columns(TilePoints::of(rounded).cloud(), rounded);
}

TEST(TilePoints, WhatIsOutOfRangeBecomesTheNearestThatCanBeKept) {
  PointCloud tile = one_point_each({{-1, 70, kNan}, {65.535f, 0, 1e30f}});
  tile.range = {1e9f, -3};
  tile.incidence = {kNan, 1e9f};
  const TilePoints points = TilePoints::of(tile);
  EXPECT_EQ(points.position[0], (std::vector<std::uint16_t>{0, 65535}));
  EXPECT_EQ(points.position[1], (std::vector<std::uint16_t>{65535, 0}));
  EXPECT_EQ(points.position[2], (std::vector<std::uint16_t>{0, 65535}));
  EXPECT_EQ(points.range, (std::vector<std::uint16_t>{65535, 0}));
  EXPECT_EQ(points.incidence, (std::vector<std::uint8_t>{TilePoints::kUnknownIncidence, 254}));
}

TEST(TilePoints, AppendedAndKeptPointsAreThoseOfTheCloud) {
  const PointCloud cloud = random_tile(100);
  const TilePlaces places = TilePoints::of(cloud).position;
  TilePoints points;
  points.origin = {4, -8, 12};
  using Ranges = std::vector<TilePoints::Range>;
  const Ranges first{{3, 5}, {50, 51}, {7, 8}}, then{{99, 100}, {0, 1}};
  points.append(cloud, places, first);
  points.append(cloud, places, then);
  PointCloud expected = cloud.select({3, 4, 50, 7, 99, 0});
  expected.origin = points.origin;
  expected.normal.clear();
  expect_same_columns(points.cloud(), TilePoints::of(expected).cloud());
  points.keep(std::vector<std::uint32_t>{1, 4});
  expect_same_columns(points.cloud(), TilePoints::of(expected.select({1, 4})).cloud());
}

TEST(TilePoints, KeepsTheLidarsOfPointsFromSeveral) {
  PointCloud one = random_tile(5), two = random_tile(3);
  two.sensor = {1, 0, 2};
  const auto append = [](TilePoints& points, const PointCloud& cloud) {
    TilePlaces places;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (const Eigen::Vector3f& p : cloud.position) {
        places[axis].push_back(position_steps(p[Eigen::Index(axis)]));
      }
    }
    const TilePoints::Range all{0, std::uint32_t(cloud.size())};
    points.append(cloud, places, std::span(&all, 1));
  };
  TilePoints points;
  append(points, one);
  EXPECT_TRUE(points.cloud().sensor.empty());
  append(points, two);
  append(points, one);
  EXPECT_EQ(points.cloud().sensor,
            (std::vector<std::uint16_t>{0, 0, 0, 0, 0, 1, 0, 2, 0, 0, 0, 0, 0}));
  EXPECT_EQ(TilePoints::of(two).cloud().sensor, two.sensor);
}

TEST(TilePoints, BoxesEndAtThePoints) {
  TilePoints points = TilePoints::of(one_point_each({{1, 2, 0.5f}, {0.25f, 3, 4}}));
  EXPECT_EQ(points.box.low, (TilePoints::Steps{250, 2000, 500}));
  EXPECT_EQ(points.box.high, (TilePoints::Steps{1000, 3000, 4000}));
  const PointCloud cloud = one_point_each({{0, 0, 0}, {2, 2.5f, 1}});
  points.append(cloud, TilePoints::of(cloud).position, std::vector<TilePoints::Range>{{1, 2}});
  EXPECT_EQ(points.box.low, (TilePoints::Steps{250, 2000, 500}));
  EXPECT_EQ(points.box.high, (TilePoints::Steps{2000, 3000, 4000}));
}

TEST(TilePoints, EachBoxHoldsItsPointsWhateverComesAndGoes) {
  const PointCloud cloud = random_tile(1000);
  const auto expect_boxes = [](const TilePoints& points) {
    constexpr std::size_t kBoxed = TilePoints::kBoxed;
    ASSERT_EQ(points.boxes.size(), (points.size() + kBoxed - 1) / kBoxed);
    for (std::size_t k = 0; k < points.boxes.size(); ++k) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto column = points.position[axis].begin();
        const auto [low, high] =
            std::minmax_element(column + std::ptrdiff_t(k * kBoxed),
                                column + std::ptrdiff_t(std::min(points.size(), (k + 1) * kBoxed)));
        EXPECT_EQ(points.boxes[k].low[axis], *low) << k;
        EXPECT_EQ(points.boxes[k].high[axis], *high) << k;
      }
    }
  };
  TilePoints points = TilePoints::of(cloud.select({5, 6, 7}));
  const TilePlaces places = TilePoints::of(cloud).position;
  for (const auto& [begin, end] :
       std::vector<TilePoints::Range>{{0, 100}, {100, 700}, {700, 701}}) {
    points.append(cloud, places, std::vector<TilePoints::Range>{{begin, end}});
    expect_boxes(points);
  }
  std::vector<std::uint32_t> odd;
  for (std::uint32_t i = 1; i < points.size(); i += 2) odd.push_back(i);
  points.keep(odd);
  expect_boxes(points);
  points.keep(std::vector<std::uint32_t>{3});
  expect_boxes(points);
  EXPECT_EQ(points.box.low, points.box.high);
}

TEST(TilePoints, ColumnsOfDifferentLengthsAreRefused) {
  const TilePoints whole = TilePoints::of(one_point_each({{1, 2, 3}, {3, 2, 1}}));
  EXPECT_NO_THROW(whole.check());  // it has no intensities
  TilePoints points = whole;
  points.colors.pop_back();
  EXPECT_THROW(points.check(), std::logic_error);
  points = whole;
  points.position[2].pop_back();
  EXPECT_THROW(points.check(), std::logic_error);
  points = whole;
  points.intensity.push_back(1);
  EXPECT_THROW(points.check(), std::logic_error);
}

TEST(TilePoints, NamesAColumnThatIsMissing) {
  PointCloud tile = one_point_each({{1, 1, 1}});
  tile.views.clear();
  EXPECT_THROW(TilePoints::of(tile), std::logic_error);
}

}  // namespace fovea::tile_points_test
