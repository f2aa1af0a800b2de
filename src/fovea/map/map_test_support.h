// Maps of random points, for tests of the map's file.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>

#include "../../../tests/sample_map.h"
#include "fovea/map/checkpointer.h"

namespace fovea {

inline PointCloud points_at(double x, Random& random) {
  PointCloud points = random_map_points(500, random, 3.0);
  points.origin = {x, 0, 0};
  return points;
}

inline MapRows rows_of(const TileMap& map) {
  MapRows rows;
  for (std::size_t id = 0; id < map.submaps().size(); ++id) {
    rows.submaps.emplace_back(id, map.submaps()[id].T_local_submap);
  }
  return rows;
}

/// Tiles that are in memory must be as in the file. Others are not compared.
inline void expect_stored(const std::filesystem::path& path, const TileMap& map) {
  std::size_t tiles = 0, expected = 0;
  MapReader(path).for_each_tile(
      [&](std::size_t submap, const TileKey& key, const PointCloud& tile) {
        ++tiles;
        const Submap& of = map.submaps()[submap];
        if (of.stored.contains(key)) return;
        ASSERT_TRUE(of.tiles.contains(key));
        expect_same_columns(tile, of.tiles.at(key).points->cloud());
      });
  for (const Submap& submap : map.submaps()) {
    expected += submap.tiles.size() + submap.stored.size();
  }
  EXPECT_EQ(tiles, expected);
}

}  // namespace fovea
