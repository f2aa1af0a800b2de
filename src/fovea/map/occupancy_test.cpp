#include "fovea/map/occupancy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "../../../tests/sample_map.h"

namespace fovea::occupancy_test {

constexpr double kTile = 2.0, kSpacing = 0.125;  // exact in binary: borders of cells are, too
constexpr double kAll = 1e4;

Eigen::Vector3d random_place(Random& random, double half_size) {
  return {random.uniform(-half_size, half_size), random.uniform(-half_size, half_size),
          random.uniform(-half_size, half_size)};
}

RigidMotion random_pose(Random& random, double reach) {
  Twist twist;
  for (int i = 0; i < 3; ++i) twist[i] = random.uniform(-3, 3);
  for (int i = 3; i < 6; ++i) twist[i] = random.uniform(-reach, reach);
  return exp_se3(twist);
}

/// By definition: whether a point of the map lies in the cell of `p_last` in its own submap.
bool taken_by_search(const TileMap& map, double cell, const Eigen::Vector3d& p_last) {
  for (const Submap& submap : map.submaps()) {
    const Eigen::Vector3d p =
        submap.T_local_submap.inverse() * (map.submaps().back().T_local_submap * p_last);
    const Eigen::Array3d wanted = (p.array() / cell).floor();
    for (const auto& [key, stored] : submap.tiles) {
      const PointCloud tile = stored.points->cloud();
      for (const Eigen::Vector3f& position : tile.position) {
        const Eigen::Array3d found =
            ((tile.origin + position.cast<double>()).array() / cell).floor();
        if ((found == wanted).all()) return true;
      }
    }
  }
  return false;
}

bool taken(const Occupancy& occupancy, const Eigen::Vector3d& p_last) {
  return occupancy.holds_point(p_last, 0, 0);
}

TEST(Occupancy, ATileHasAMultipleOfSixteenCellsAnEdge) {
  EXPECT_EQ(Occupancy(4.0, 0.02).cell(), 4.0 / 192);   // 200: the coarser of two
  EXPECT_EQ(Occupancy(4.0, 0.019).cell(), 4.0 / 208);  // 210.5
  EXPECT_EQ(Occupancy(1.0, 0.0625).cell(), 1.0 / 16);
  EXPECT_EQ(Occupancy(0.05, 0.02).cell(), 0.05 / 16);  // at least sixteen
}

TEST(Occupancy, ACellIsTakenFromBorderToBorderAndThoseBesideItAreFree) {
  TileMap map(kTile);
  map.add_submap(RigidMotion::Identity());
  const Eigen::Vector3f places[] = {{0.3f, 0.7f, 0.1f},    {-0.3f, -0.01f, -2.9f},
                                    {-0.125f, 1.0f, 2.0f}, {0.99f, 0.99f, 0.99f},
                                    {-7.6f, 0.51f, 0.49f}, {100.2f, -200.3f, 50.1f}};
  for (const Eigen::Vector3f& place : places) map.add(one_point_each({place}));
  Occupancy occupancy(kTile, kSpacing);
  occupancy.follow(map, {0, 0, 0}, kAll);
  for (const Eigen::Vector3f& place : places) {
    const Eigen::Vector3d low = (place.cast<double>().array() / kSpacing).floor() * kSpacing;
    for (const double x : {0.0, 0.06, 0.1249}) {
      for (const double y : {0.0, 0.06, 0.1249}) {
        for (const double z : {0.0, 0.06, 0.1249}) {
          EXPECT_TRUE(taken(occupancy, low + Eigen::Vector3d(x, y, z))) << place.transpose();
        }
      }
    }
    const Eigen::Vector3d center = low + Eigen::Vector3d::Constant(kSpacing / 2);
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-kSpacing, kSpacing}) {
        EXPECT_FALSE(taken(occupancy, center + side * Eigen::Vector3d::Unit(axis)));
      }
    }
  }
  EXPECT_FALSE(taken(occupancy, {1e6, -1e6, 0}));
}

TEST(Occupancy, NothingIsTakenInAnEmptyMap) {
  TileMap map(kTile);
  Occupancy occupancy(kTile, kSpacing);
  EXPECT_FALSE(taken(occupancy, {0, 0, 0}));
  occupancy.follow(map, {0, 0, 0}, kAll);
  map.add_submap(RigidMotion::Identity());
  occupancy.follow(map, {0, 0, 0}, kAll);
  EXPECT_FALSE(taken(occupancy, {0, 0, 0}));
}

/// Tile whose cells have their borders between whole millimetres, where points are.
constexpr double kOdd = 1.4061;

// Random maps of turned and moved submaps, with points that come and go between the calls.
TEST(Occupancy, EqualsASearchThroughAllPoints) {
  for (std::uint64_t trial = 0; trial < 6; ++trial) {
    Random random(trial + 1);
    TileMap map(kOdd);
    Occupancy occupancy(kOdd, 0.09);
    for (int step = 0; step < 8; ++step) {
      if (step % 3 == 0) map.add_submap(random_pose(random, 3));
      if (step % 2 == 0)
        map.move_submap(random.below(map.submaps().size()), random_pose(random, 3));
      map.add(random_map_points(200, random, 1.2));
      occupancy.follow(map, {0, 0, 0}, kAll);
      if (step % 4 == 3) {
        std::vector<TileId> ids;
        map.for_each_tile_near({0, 0, 0}, kAll,
                               [&](const TileId& id, const TilePoints&) { ids.push_back(id); });
        for (const TileId& id : ids) {
          const PointCloud tile = map.submaps()[id.submap].tiles.at(id.key).points->cloud();
          std::vector<std::uint32_t> kept;
          for (std::uint32_t i = 0; i < tile.size(); ++i) {
            if (random.below(2) == 0) kept.push_back(i);
          }
          map.keep_points(id, kept);
        }
        occupancy.follow(map, {0, 0, 0}, kAll);
      }
      const RigidMotion T_last_local = map.submaps().back().T_local_submap.inverse();
      std::size_t found = 0, free = 0;
      const auto compare = [&](const Eigen::Vector3d& p_last) {
        const bool expected = taken_by_search(map, occupancy.cell(), p_last);
        ASSERT_EQ(taken(occupancy, p_last), expected) << p_last.transpose();
        (expected ? found : free) += 1;
      };
      for (const Submap& submap : map.submaps()) {
        for (const auto& [key, stored] : submap.tiles) {
          const PointCloud tile = stored.points->cloud();
          // On the tile's border rounding decides.
          if (tile.position[0].minCoeff() == 0 || tile.position[0].maxCoeff() >= kOdd) continue;
          const Eigen::Vector3d p = tile.origin + tile.position[0].cast<double>();
          compare(T_last_local * submap.T_local_submap * p);
        }
      }
      for (int i = 0; i < 100; ++i) compare(T_last_local * random_place(random, 1.5));
      EXPECT_GT(found, 10u);
      EXPECT_GT(free, 20u);
    }
  }
}

TEST(Occupancy, CellsOfPointsThatGoAreFreeAgain) {
  TileMap map(kTile);
  map.add_submap(RigidMotion::Identity());
  map.add(one_point_each({{0.1f, 0.1f, 0.1f}, {0.5f, 0.5f, 0.5f}, {0.9f, 0.9f, 0.9f}}));
  Occupancy occupancy(kTile, kSpacing);
  occupancy.follow(map, {0, 0, 0}, kAll);
  map.keep_points({0, {0, 0, 0}}, {0, 2});
  occupancy.follow(map, {0, 0, 0}, kAll);
  EXPECT_TRUE(taken(occupancy, {0.1, 0.1, 0.1}));
  EXPECT_FALSE(taken(occupancy, {0.5, 0.5, 0.5}));
  EXPECT_TRUE(taken(occupancy, {0.9, 0.9, 0.9}));
  map.keep_points({0, {0, 0, 0}}, {});
  occupancy.follow(map, {0, 0, 0}, kAll);
  EXPECT_FALSE(taken(occupancy, {0.1, 0.1, 0.1}));
  map.add(one_point_each({{0.5f, 0.5f, 0.5f}}));
  occupancy.follow(map, {0, 0, 0}, kAll);
  EXPECT_TRUE(taken(occupancy, {0.5, 0.5, 0.5}));
  EXPECT_FALSE(taken(occupancy, {0.9, 0.9, 0.9}));
}

TEST(Occupancy, ForgetsTilesBeyondTheRadiusAndTakesThemInAgain) {
  TileMap map(kTile);
  map.add_submap(RigidMotion::Identity());
  map.add(one_point_each({{0.5f, 0.5f, 0.5f}, {20.5f, 0.5f, 0.5f}}));
  Occupancy occupancy(kTile, kSpacing);
  occupancy.follow(map, {0, 0, 0}, 10);
  EXPECT_TRUE(taken(occupancy, {0.5, 0.5, 0.5}));
  EXPECT_FALSE(taken(occupancy, {20.5, 0.5, 0.5}));
  occupancy.follow(map, {20, 0, 0}, 10);
  EXPECT_FALSE(taken(occupancy, {0.5, 0.5, 0.5}));
  EXPECT_TRUE(taken(occupancy, {20.5, 0.5, 0.5}));
  // What changed in the meantime is not missed.
  map.keep_points({0, {0, 0, 0}}, {});
  map.add(one_point_each({{0.1f, 0.1f, 0.1f}}));
  occupancy.follow(map, {10, 0, 0}, 20);
  EXPECT_FALSE(taken(occupancy, {0.5, 0.5, 0.5}));
  EXPECT_TRUE(taken(occupancy, {0.1, 0.1, 0.1}));
  EXPECT_TRUE(taken(occupancy, {20.5, 0.5, 0.5}));
}

/// One point of a level.
PointCloud point_of_level(const Eigen::Vector3f& p, int level) {
  PointCloud point = one_point_each({p});
  point.sampling_level.assign(1, static_cast<std::uint8_t>(level));
  return point;
}

// A cell of level n around p holds points of up to level n, wherever in the cell.
TEST(Occupancy, ACoarseCellHoldsTheFinerPointsInIt) {
  for (int of_point = 0; of_point < kSamplingLevels; ++of_point) {
    TileMap map(kTile);
    map.add_submap(RigidMotion::Identity());
    map.add(point_of_level({1.3f, 0.4f, 0.9f}, of_point));
    Occupancy occupancy(kTile, kSpacing);
    occupancy.follow(map, {0, 0, 0}, kAll);
    for (int level = 0; level < kSamplingLevels; ++level) {
      const double edge = kSpacing * (1 << level);
      const Eigen::Vector3d low = (Eigen::Array3d(1.3, 0.4, 0.9) / edge).floor() * edge;
      const Eigen::Vector3d inside = low.array() + edge * 0.01, beside = low.array() - edge * 0.01;
      for (int most = 0; most <= level; ++most) {
        EXPECT_EQ(occupancy.holds_point(inside, level, most), most >= of_point)
            << of_point << level << most;
        EXPECT_FALSE(occupancy.holds_point(beside, level, most));
      }
    }
  }
}

}  // namespace fovea::occupancy_test
