#include "fovea/map/tile_map.h"

#include <gtest/gtest.h>

#include <set>
#include <stdexcept>

#include "../../../tests/sample_map.h"
#include "fovea/base/random.h"

namespace fovea {
namespace {

Eigen::Vector3d stored_local(const Submap& submap, const PointCloud& tile, std::size_t i) {
  return submap.T_local_submap * (tile.origin + tile.position[i].cast<double>());
}

TEST(TileMap, PointsComeBackWithTheirColumns) {
  // 20 km from the origin, where a float in the local frame would be 1 mm off.
  Random random(1);
  PointCloud points = random_map_points(20'000, random, 60.0);
  points.origin = {20'000.25, -15'000.5, 100.125};
  TileMap map(4.0);
  const RigidMotion T_local_submap =
      exp_se3((Twist() << 0.1, -0.2, 2.5, 19'990, -15'010, 98).finished());
  map.add_submap(T_local_submap);
  map.add(points);
  ASSERT_EQ(map.size(), points.size());

  // `frame` numbers the points of random_map_points().
  std::vector<int> seen(points.size(), 0);
  for (const auto& [key, tile] : map.submaps()[0].tiles) {
    EXPECT_EQ(tile.origin, Eigen::Vector3d(key.x * 4.0, key.y * 4.0, key.z * 4.0));
    std::vector<std::uint32_t> chosen(tile.frame.begin(), tile.frame.end());
    PointCloud expected = points.select(chosen);
    for (std::size_t i = 0; i < tile.size(); ++i) {
      ++seen[chosen[i]];
      const Eigen::Vector3d p_local = points.origin + expected.position[i].cast<double>();
      EXPECT_LT((stored_local(map.submaps()[0], tile, i) - p_local).norm(), 1e-6);
      EXPECT_GE(tile.position[i].minCoeff(), 0.f);
      EXPECT_LE(tile.position[i].maxCoeff(), 4.f);
    }
    expected.origin = tile.origin;
    expected.position = tile.position;
    expect_same_columns(tile, expected);
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(points.size()));
}

TEST(TileMap, AddReportsTheTilesThatGrew) {
  PointCloud points = one_point_each({{0.5f, 0.5f, 0.5f}, {-0.5f, 0.5f, 0.5f}, {0.6f, 0.f, 0.f}});
  TileMap map(1.0);
  map.add_submap(RigidMotion::Identity());
  const std::vector<TileKey> expected = {{-1, 0, 0}, {0, 0, 0}};
  EXPECT_EQ(map.add(points), expected);
  EXPECT_EQ(map.add(one_point_each({{1.5f, 0.f, 0.f}})), (std::vector<TileKey>{{1, 0, 0}}));
  EXPECT_TRUE(map.add(PointCloud()).empty());
  const PointCloud& tile = map.submaps()[0].tiles.at({0, 0, 0});
  ASSERT_EQ(tile.size(), 2u);
  EXPECT_EQ(tile.frame[0], 0);  // in the order of adding
  EXPECT_EQ(tile.frame[1], 2);
}

TEST(TileMap, PointsGoToTheLastSubmap) {
  TileMap map;
  RigidMotion T = RigidMotion::Identity();
  map.add_submap(T);
  map.add(one_point_each({{1.f, 1.f, 1.f}}));
  T.translation().x() = 100;
  map.add_submap(T);
  map.add(one_point_each({{101.f, 1.f, 1.f}, {102.f, 1.f, 1.f}}));
  EXPECT_EQ(map.submaps()[0].tiles.at({0, 0, 0}).size(), 1u);
  EXPECT_EQ(map.submaps()[1].tiles.at({0, 0, 0}).size(), 2u);
  EXPECT_EQ(map.size(), 3u);
}

TEST(TileMap, TilesNearCoverEveryPointInTheBallAndNoTileBeyondIt) {
  for (const double tile_size : {0.3, 1.0, 4.0}) {
    Random random(7);
    TileMap map(tile_size);
    for (int submap = 0; submap < 3; ++submap) {
      Twist twist;
      for (double& value : twist) value = random.uniform(-3, 3);
      map.add_submap(exp_se3(twist));
      map.add(random_map_points(1500, random, 15.0));
    }
    std::size_t visited = 0, all = 0;
    for (int trial = 0; trial < 200; ++trial) {
      const Eigen::Vector3d center(random.uniform(-20, 20), random.uniform(-20, 20),
                                   random.uniform(-20, 20));
      const double radius = trial == 0 ? 0 : random.uniform(0, 8);
      std::set<const PointCloud*> near;
      map.for_each_tile_near(center, radius, [&](const TileId&, const PointCloud& tile) {
        EXPECT_TRUE(near.insert(&tile).second) << "a tile came twice";
      });
      visited += near.size();
      for (const Submap& submap : map.submaps()) {
        const double half = tile_size / 2;
        for (const auto& [key, tile] : submap.tiles) {
          ++all;
          if (near.contains(&tile)) {
            // Distance from the box by way of its centre: another formula than the code's.
            const Eigen::Vector3d box =
                Eigen::Vector3d(key.x, key.y, key.z) * tile_size + Eigen::Vector3d::Constant(half);
            const Eigen::Array3d offset =
                (submap.T_local_submap.inverse() * center - box).array().abs() - half;
            EXPECT_LE(offset.max(0.0).matrix().norm(), radius + 1e-5);
            continue;
          }
          for (std::size_t i = 0; i < tile.size(); ++i) {
            EXPECT_GT((stored_local(submap, tile, i) - center).norm(), radius);
          }
        }
      }
    }
    EXPECT_GT(visited, 0u);
    EXPECT_LT(visited, all / 2);
  }
}

TEST(TileMap, TilesNearComeInTheOrderOfSubmapsAndKeys) {
  Random random(3);
  TileMap map(1.0);
  for (int submap = 0; submap < 2; ++submap) {
    map.add_submap(RigidMotion(Eigen::Translation3d(submap, 0, 0)));
    map.add(random_map_points(500, random, 5.0));
  }
  std::vector<std::pair<double, TileKey>> order;
  map.for_each_tile_near({0, 0, 0}, 100, [&](const TileId& id, const PointCloud& tile) {
    EXPECT_EQ(id.key, (TileKey{int(tile.origin.x()), int(tile.origin.y()), int(tile.origin.z())}));
    order.push_back(
        {double(id.submap), {int(tile.origin.x()), int(tile.origin.y()), int(tile.origin.z())}});
  });
  EXPECT_EQ(order.size(), map.submaps()[0].tiles.size() + map.submaps()[1].tiles.size());
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(TileMap, KeptPointsStayAndEmptyTilesGo) {
  Random random(7);
  TileMap map(2.0);
  map.add_submap(RigidMotion::Identity());
  map.add(random_map_points(20000, random, 3.0));
  const auto [key, before] = *map.submaps()[0].tiles.begin();
  ASSERT_GT(before.size(), 3u);
  const std::size_t size = map.size(), tiles = map.submaps()[0].tiles.size();
  map.keep_points({0, key}, {0, 2});
  expect_same_columns(map.submaps()[0].tiles.at(key), before.select({0, 2}));
  EXPECT_EQ(map.size(), size - before.size() + 2);
  map.keep_points({0, key}, {});
  EXPECT_FALSE(map.submaps()[0].tiles.contains(key));
  EXPECT_EQ(map.submaps()[0].tiles.size(), tiles - 1);
  EXPECT_EQ(map.size(), size - before.size());
  EXPECT_THROW(map.keep_points({0, key}, {}), std::logic_error);
  EXPECT_THROW(map.keep_points({1, key}, {}), std::logic_error);
}

TEST(TileMap, RestoredTilesEqualTheKeptOnes) {
  Random random(5);
  TileMap map(2.0);
  map.add_submap(RigidMotion::Identity());
  map.add(random_map_points(1000, random, 10.0));
  TileMap restored(2.0);
  restored.add_submap(RigidMotion::Identity());
  for (const auto& [key, tile] : map.submaps()[0].tiles) restored.restore_tile(0, key, tile);
  EXPECT_EQ(restored.size(), map.size());
  for (const auto& [key, tile] : map.submaps()[0].tiles) {
    expect_same_columns(restored.submaps()[0].tiles.at(key), tile);
  }
  const auto& [key, tile] = *map.submaps()[0].tiles.begin();
  EXPECT_THROW(restored.restore_tile(0, key, tile), std::logic_error);
  EXPECT_THROW(restored.restore_tile(1, key, tile), std::logic_error);
  EXPECT_THROW(restored.restore_tile(0, {99, 0, 0}, tile), std::logic_error);  // its origin differs
}

TEST(TileMap, RefusesWhatATileCannotHold) {
  EXPECT_THROW(TileMap(0), std::invalid_argument);
  EXPECT_THROW(TileMap(-1), std::invalid_argument);
  EXPECT_THROW(TileMap(std::nan("")), std::invalid_argument);
  TileMap map;
  const PointCloud point = one_point_each({{1.f, 2.f, 3.f}});
  EXPECT_THROW(map.add(point), std::logic_error);  // no submap
  map.add_submap(RigidMotion::Identity());
  PointCloud bad = point;
  bad.camera.clear();
  EXPECT_THROW(map.add(bad), std::logic_error);
  bad = point;
  bad.position[0].y() = std::nanf("");
  EXPECT_THROW(map.add(bad), std::logic_error);
  bad.position[0].y() = 1e30f;
  EXPECT_THROW(map.add(bad), std::logic_error);
  EXPECT_EQ(map.size(), 0u);
  EXPECT_TRUE(map.submaps()[0].tiles.empty());
  map.add(point);
  bad = point;
  bad.intensity = {0.5f};
  EXPECT_THROW(map.add(bad), std::logic_error);
}

TEST(TileMap, ColoursAreChangedInPlaceAndNothingElse) {
  Random random(21);
  TileMap map(1.0);
  map.add_submap(exp_se3((Twist() << 0.1, 0.2, 0.3, 4, 5, 6).finished()));
  map.add_submap(RigidMotion::Identity());
  map.add(random_map_points(300, random, 1.5));
  const TileId id{1, {-1, 0, -1}};
  const PointCloud before = map.submaps()[1].tiles.at(id.key);
  const PointCloud other = map.submaps()[1].tiles.at({0, 0, 0});
  const TileColors colors = map.colors(id);
  ASSERT_GT(before.size(), 5u);
  ASSERT_EQ(colors.color.size(), before.size());
  ASSERT_EQ(colors.views.size(), before.size());
  ASSERT_EQ(colors.spread.size(), before.size());
  ASSERT_EQ(colors.weight.size(), before.size());
  PointCloud expected = before;
  expected.color[4] = colors.color[4] = {9, 8, 7};
  expected.views[3] = colors.views[3] = 77;
  expected.spread[2] = colors.spread[2] = 66;
  expected.weight[1] = colors.weight[1] = 55'555;
  expect_same_columns(map.submaps()[1].tiles.at(id.key), expected);
  expect_same_columns(map.submaps()[1].tiles.at({0, 0, 0}), other);
  EXPECT_EQ(map.size(), 300u);
  EXPECT_THROW(map.colors({0, id.key}), std::logic_error);
  EXPECT_THROW(map.colors({1, {50, 0, 0}}), std::logic_error);
  EXPECT_THROW(map.colors({2, id.key}), std::logic_error);
}

}  // namespace
}  // namespace fovea
