#include "fovea/map/tile_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "../../../tests/sample_map.h"
#include "fovea/core/random.h"
#include "fovea/map/tile_points.h"

namespace fovea::tile_map_test {

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
  for (const auto& [key, stored] : map.submaps()[0].tiles) {
    const PointCloud tile = stored.points->cloud();
    EXPECT_EQ(tile.origin, Eigen::Vector3d(key.x * 4.0, key.y * 4.0, key.z * 4.0));
    std::vector<std::uint32_t> chosen(tile.frame.begin(), tile.frame.end());
    PointCloud expected = points.select(chosen);
    for (std::size_t i = 0; i < tile.size(); ++i) {
      ++seen[chosen[i]];
      const Eigen::Vector3d p_local = points.origin + expected.position[i].cast<double>();
      EXPECT_LT((stored_local(map.submaps()[0], tile, i) - p_local).cwiseAbs().maxCoeff(),
                0.5e-3 * std::sqrt(3.0) + 1e-6);
      EXPECT_GE(tile.position[i].minCoeff(), 0.f);
      EXPECT_LE(tile.position[i].maxCoeff(), 4.f);
    }
    expected.origin = tile.origin;
    expected.position = tile.position;
    expect_same_columns(tile, TilePoints::of(expected).cloud());
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ptrdiff_t(points.size()));
}

std::vector<TileId> ids_of(const std::vector<TileChanges::Changed>& changed) {
  std::vector<TileId> ids;
  for (const TileChanges::Changed& tile : changed) ids.push_back(tile.id);
  return ids;
}

TEST(TileMap, TellsOfTheTilesThatChanged) {
  TileMap map(1.0);
  map.add_submap(RigidMotion::Identity());
  map.add(one_point_each({{0.5f, 0.5f, 0.5f}, {-0.5f, 0.5f, 0.5f}, {0.6f, 0.f, 0.f}}));
  const std::vector<TileId> both = {{0, {-1, 0, 0}}, {0, {0, 0, 0}}};
  EXPECT_EQ(ids_of(map.take_changes().changed), both);
  EXPECT_TRUE(map.take_changes().changed.empty());
  map.add(one_point_each({{1.5f, 0.f, 0.f}}));
  EXPECT_EQ(ids_of(map.take_changes().changed), (std::vector<TileId>{{0, {1, 0, 0}}}));
  map.add(PointCloud());
  map.colors(both[1]);
  EXPECT_EQ(ids_of(map.take_changes().changed), (std::vector<TileId>{both[1]}));
  map.keep_points(both[1], {1});
  map.keep_points(both[0], {});
  TileChanges changes = map.take_changes();
  EXPECT_EQ(ids_of(changes.changed), (std::vector<TileId>{both[1]}));
  EXPECT_EQ(changes.removed, (std::vector<TileId>{both[0]}));
  // One that goes and comes again is changed, not removed.
  map.keep_points(both[1], {});
  map.add(one_point_each({{0.5f, 0.5f, 0.5f}}));
  changes = map.take_changes();
  EXPECT_EQ(ids_of(changes.changed), (std::vector<TileId>{both[1]}));
  EXPECT_TRUE(changes.removed.empty());
}

TEST(TileMap, SnapshotsNeverChange) {
  TileMap map(1.0);
  map.add_submap(RigidMotion::Identity());
  map.add(one_point_each({{0.5f, 0.5f, 0.5f}}));
  const TileChanges changes = map.take_changes();
  map.colors({0, {0, 0, 0}})[0].views = 99;
  map.add(one_point_each({{0.25f, 0.5f, 0.5f}}));
  EXPECT_EQ(changes.changed[0].points->size(), 1u);
  EXPECT_NE(changes.changed[0].points->colors[0].views, 99);
  EXPECT_EQ(map.submaps()[0].tiles.at({0, 0, 0}).points->colors[0].views, 99);
}

TEST(TileMap, PointsOfATileComeInTheOrderOfAdding) {
  TileMap map(1.0);
  map.add_submap(RigidMotion::Identity());
  map.add(one_point_each({{0.5f, 0.5f, 0.5f}, {-0.5f, 0.5f, 0.5f}, {0.6f, 0.f, 0.f}}));
  const PointCloud tile = map.submaps()[0].tiles.at({0, 0, 0}).points->cloud();
  ASSERT_EQ(tile.size(), 2u);
  EXPECT_EQ(tile.frame[0], 0);
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
  EXPECT_EQ(map.submaps()[0].tiles.at({0, 0, 0}).points->size(), 1u);
  EXPECT_EQ(map.submaps()[1].tiles.at({0, 0, 0}).points->size(), 2u);
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
      std::set<const TilePoints*> near;
      map.for_each_tile_near(center, radius, [&](const TileId&, const TilePoints& tile) {
        EXPECT_TRUE(near.insert(&tile).second) << "a tile came twice";
      });
      visited += near.size();
      for (const Submap& submap : map.submaps()) {
        const double half = tile_size / 2;
        for (const auto& [key, stored] : submap.tiles) {
          const PointCloud tile = stored.points->cloud();
          ++all;
          if (near.contains(&*stored.points)) {
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
  map.for_each_tile_near({0, 0, 0}, 100, [&](const TileId& id, const TilePoints& tile) {
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
  const auto [key, first] = *map.submaps()[0].tiles.begin();
  const PointCloud before = first.points->cloud();
  ASSERT_GT(before.size(), 3u);
  const std::size_t size = map.size(), tiles = map.submaps()[0].tiles.size();
  map.keep_points({0, key}, {0, 2});
  expect_same_columns(map.submaps()[0].tiles.at(key).points->cloud(), before.select({0, 2}));
  EXPECT_EQ(map.size(), size - before.size() + 2);
  map.keep_points({0, key}, {});
  EXPECT_FALSE(map.submaps()[0].tiles.contains(key));
  EXPECT_EQ(map.submaps()[0].tiles.size(), tiles - 1);
  EXPECT_EQ(map.size(), size - before.size());
  EXPECT_THROW(map.keep_points({0, key}, {}), std::logic_error);
  EXPECT_THROW(map.keep_points({1, key}, {}), std::logic_error);
}

TEST(TileMap, FarTilesLeaveTheMemoryAndComeBack) {
  Random random(5);
  TileMap map(2.0);
  for (int submap = 0; submap < 3; ++submap) {
    map.add_submap(RigidMotion(Eigen::Translation3d(submap, 0.3, 0)));
    map.add(random_map_points(1000, random, 10.0));
  }
  const TileMap whole = map;
  std::map<TileId, std::shared_ptr<const TilePoints>> store;
  for (const TileChanges::Changed& tile : map.take_changes().changed) {
    store.emplace(tile.id, tile.points);
  }
  map.colors({0, whole.submaps()[0].tiles.begin()->first})[0].views ^= 1;  // not in the store
  const Eigen::Vector3d center(1, 2, 3);
  map.drop_beyond(center, 4);
  EXPECT_EQ(map.size(), whole.size());
  EXPECT_LT(map.size_in_memory(), whole.size() * 2 / 3);
  const auto visited = [&](const TileMap& from) {
    std::vector<TileId> ids;
    from.for_each_tile_near(center, 4,
                            [&](const TileId& id, const TilePoints&) { ids.push_back(id); });
    return ids;
  };
  EXPECT_EQ(visited(map), visited(whole));
  EXPECT_TRUE(map.stored_near(center, 4).empty());
  EXPECT_TRUE(map.submaps()[0].tiles.contains(whole.submaps()[0].tiles.begin()->first));
  EXPECT_EQ(map.submaps()[2].tiles.size(), whole.submaps()[2].tiles.size());

  const std::vector<TileId> near = map.stored_near(center, 6);
  ASSERT_GT(near.size(), 3u);
  EXPECT_TRUE(std::is_sorted(near.begin(), near.end()));
  EXPECT_THROW(map.colors(near[0]), std::logic_error);
  EXPECT_THROW(map.restore(near[0], *store.at(near[1])), std::logic_error);
  for (const TileId& id : map.stored_near(center, 100)) map.restore(id, *store.at(id));
  EXPECT_THROW(map.restore(near[0], *store.at(near[0])), std::logic_error);  // is there
  EXPECT_EQ(map.size(), whole.size());
  EXPECT_EQ(map.size_in_memory(), whole.size());
  for (const auto& [id, points] : store) {
    if (id == TileId{0, whole.submaps()[0].tiles.begin()->first}) continue;
    expect_same_columns(map.submaps()[id.submap].tiles.at(id.key).points->cloud(), points->cloud());
  }
}

TEST(TileMap, TakesUpAnEarlierRunsTiles) {
  Random random(6);
  TileMap map(2.0), resumed(2.0);
  map.add_submap(RigidMotion::Identity());
  resumed.add_submap(RigidMotion::Identity());
  map.add(random_map_points(500, random, 5.0));
  for (const auto& [key, tile] : map.submaps()[0].tiles) {
    resumed.declare_stored({0, key}, tile.points->size());
  }
  EXPECT_EQ(resumed.size(), map.size());
  EXPECT_EQ(resumed.size_in_memory(), 0u);
  const TileKey first = map.submaps()[0].tiles.begin()->first;
  EXPECT_THROW(resumed.declare_stored({0, first}, 1), std::logic_error);
  EXPECT_THROW(resumed.declare_stored({1, first}, 1), std::logic_error);
  // The last submap's are wanted wherever they are, since points are added to them.
  EXPECT_EQ(resumed.stored_near({1000, 0, 0}, 1).size(), map.submaps()[0].tiles.size());
  EXPECT_THROW(resumed.add(random_map_points(500, random, 5.0)), std::logic_error);
  for (const auto& [key, tile] : map.submaps()[0].tiles) resumed.restore({0, key}, *tile.points);
  EXPECT_TRUE(resumed.take_changes().changed.empty());
  resumed.add_submap(RigidMotion::Identity());
  EXPECT_TRUE(resumed.stored_near({1000, 0, 0}, 1).empty());
}

// What is written and read again is what was there: the mapper goes on alike.
TEST(TileMap, KeepsWhatTheFileKeeps) {
  Random random(8);
  TileMap map(2.0);
  map.add_submap(exp_se3((Twist() << 0.1, 0.2, 0.3, 4, 5, 6).finished()));
  PointCloud points = random_map_points(1000, random, 5.0);
  points.range[0] = 1e9f;
  points.range[1] = -3;
  points.incidence[2] = std::nanf("");
  map.add(points);
  std::size_t unknown = 0;
  for (const auto& [key, tile] : map.submaps()[0].tiles) {
    for (std::size_t i = 0; i < tile.points->size(); ++i) {
      const float range = tile.points->range_at(i), incidence = tile.points->incidence_at(i);
      const auto from = static_cast<std::size_t>(tile.points->frame[i]);
      if (from > 1) {
        EXPECT_NEAR(range, points.range[from], 0.00501);
      }
      unknown += std::isnan(incidence);
      if (std::isnan(incidence)) continue;
      EXPECT_NEAR(incidence, points.incidence[from], 0.00437);
    }
  }
  EXPECT_EQ(unknown, std::size_t(std::count_if(points.incidence.begin(), points.incidence.end(),
                                               [](float x) { return std::isnan(x); })));
}

TEST(TileMap, RefusesWhatATileCannotHold) {
  EXPECT_THROW(TileMap(0), std::invalid_argument);
  EXPECT_THROW(TileMap(-1), std::invalid_argument);
  EXPECT_THROW(TileMap(66), std::invalid_argument);
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
  const PointCloud before = map.submaps()[1].tiles.at(id.key).points->cloud();
  const PointCloud other = map.submaps()[1].tiles.at({0, 0, 0}).points->cloud();
  const std::span<FusedColor> colors = map.colors(id);
  ASSERT_GT(before.size(), 5u);
  ASSERT_EQ(colors.size(), before.size());
  PointCloud expected = before;
  expected.color[4] = colors[4].color = {9, 8, 7};
  expected.views[3] = colors[3].views = 77;
  expected.spread[2] = colors[2].spread = 66;
  expected.weight[1] = colors[1].weight = 55'555;
  expected.camera[0] = expected.camera[4] = 7;
  map.put_camera(id, std::vector<std::uint32_t>{0, 4}, 7);
  expect_same_columns(map.submaps()[1].tiles.at(id.key).points->cloud(), expected);
  expect_same_columns(map.submaps()[1].tiles.at({0, 0, 0}).points->cloud(), other);
  EXPECT_EQ(map.size(), 300u);
  EXPECT_THROW(map.colors({0, id.key}), std::logic_error);
  EXPECT_THROW(map.colors({1, {50, 0, 0}}), std::logic_error);
  EXPECT_THROW(map.colors({2, id.key}), std::logic_error);
  EXPECT_THROW(map.put_camera({2, id.key}, {}, 7), std::logic_error);
}

}  // namespace fovea::tile_map_test
