#include "fovea/exporting/tileset/octree_builder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include "../../../../tests/temporary_folder.h"
#include "fovea/base/random.h"
#include "fovea/exporting/tileset/morton_sort.h"

namespace fovea {
namespace {

using Cells = std::vector<CubePoint>;

/// A wavy ground of 200 m with a dense spot, and a few points far off.
std::vector<Eigen::Vector3d> ground(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double size = i % 3 == 0 ? 5 : 200;
    const double x = random.uniform(0, size), y = random.uniform(0, size);
    points.emplace_back(x, y, std::sin(0.1 * x));
  }
  points.emplace_back(1500, -700, 40);
  return points;
}

struct Sample {
  explicit Sample(const std::vector<Eigen::Vector3d>& positions) : grid(box_of(positions)) {
    for (const Eigen::Vector3d& p : positions) {
      const auto shade = static_cast<std::uint8_t>(points.size());
      points.push_back({grid.cell(p), {shade, 1, 2}});
    }
    std::sort(points.begin(), points.end(), morton_less);
  }
  static Eigen::AlignedBox3d box_of(const std::vector<Eigen::Vector3d>& positions) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : positions) box.extend(p);
    return box;
  }

  void build(const OctreeOptions& options) {
    std::size_t i = 0;
    roots = build_octree(
        grid,
        [&](CubePoint& point) {
          if (i == points.size()) return false;
          point = points[i++];
          return true;
        },
        [&](const std::string& name, const Cells& tile) {
          EXPECT_TRUE(tiles.emplace(name, tile).second) << name;
          return 0.001;
        },
        options);
  }
  void visit(const std::function<void(const OctreeTile&)>& f) const {
    const std::function<void(const OctreeTile&)> walk = [&](const OctreeTile& tile) {
      f(tile);
      for (const OctreeTile& child : tile.children) walk(child);
    };
    for (const OctreeTile& root : roots) walk(root);
  }

  CubeGrid grid;
  Cells points;
  std::vector<OctreeTile> roots;
  std::map<std::string, Cells> tiles;
};

TEST(CubeGrid, CellsAreFine) {
  const CubeGrid grid(Eigen::AlignedBox3d(Eigen::Vector3d(-500, 2, 0), Eigen::Vector3d(500, 3, 9)));
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d p(random.uniform(-500, 500), random.uniform(2, 3), random.uniform(0, 9));
    EXPECT_LT((grid.position(grid.cell(p)) - p).cwiseAbs().maxCoeff(), 2e-7);
  }
}

// Every node's points stand together, whatever the level.
TEST(CubeGrid, MortonOrderKeepsNodesTogether) {
  const Sample sample(ground(5000, 1));
  for (const int level : {0, 1, 3, 7, 12, 25, 32}) {
    std::vector<std::array<std::uint32_t, 3>> seen;
    for (const CubePoint& point : sample.points) {
      const auto node = CubeNode::prefix(point.cell, level);
      if (!seen.empty() && seen.back() == node) continue;
      ASSERT_EQ(std::count(seen.begin(), seen.end(), node), 0) << level;
      seen.push_back(node);
    }
  }
}

TEST(MortonSort, SortsByRunsAsInMemory) {
  const Sample sample(ground(20'000, 2));
  for (const std::size_t run : {100u, 999u, 20'001u, 1'000'000u}) {
    const TemporaryFolder folder;
    MortonSort sort(folder.path(), run);
    Cells shuffled = sample.points;
    std::reverse(shuffled.begin(), shuffled.end());
    for (const CubePoint& point : shuffled) sort.add(point);
    sort.finish();
    EXPECT_TRUE(folder.names().empty());
    Cells sorted;
    for (CubePoint point; sort.next(point);) sorted.push_back(point);
    EXPECT_EQ(sorted, sample.points);
  }
}

TEST(MortonSort, NoPoints) {
  const TemporaryFolder folder;
  MortonSort sort(folder.path(), 10);
  sort.finish();
  CubePoint point;
  EXPECT_FALSE(sort.next(point));
}

TEST(Octree, LeavesHaveEveryPointOnce) {
  Sample sample(ground(30'000, 4));
  sample.build({.leaf_points = 500});
  Cells all;
  std::size_t tiles = 0;
  sample.visit([&](const OctreeTile& tile) {
    ++tiles;
    const Cells& points = sample.tiles.at(tile.name);
    if (!tile.children.empty()) return;
    EXPECT_EQ(tile.spacing, 0);
    EXPECT_LE(points.size(), 500u);
    all.insert(all.end(), points.begin(), points.end());
  });
  EXPECT_EQ(tiles, sample.tiles.size());
  EXPECT_EQ(all, sample.points);  // in the very order
}

TEST(Octree, ParentsAreCoarserPicturesOfTheirChildren) {
  Sample sample(ground(30'000, 5));
  sample.build({.leaf_points = 500});
  ASSERT_EQ(sample.roots.size(), 1u);
  std::size_t inner = 0;
  sample.visit([&](const OctreeTile& tile) {
    if (tile.children.empty()) return;
    ++inner;
    EXPECT_GT(tile.children.size(), 1u);
    std::set<std::array<std::uint32_t, 3>> below;
    for (const OctreeTile& child : tile.children) {
      EXPECT_LE(child.spacing, tile.spacing / 2);
      EXPECT_TRUE(tile.box.contains(child.box));
      for (const CubePoint& point : sample.tiles.at(child.name)) {
        below.insert(point.cell);
      }
    }
    // Its points are its children's, and each of theirs lies within a cell's diagonal of one.
    std::vector<Eigen::Vector3d> own;
    for (const CubePoint& point : sample.tiles.at(tile.name)) {
      EXPECT_EQ(below.count(point.cell), 1u);
      own.push_back(sample.grid.position(point.cell));
      EXPECT_TRUE(tile.box.contains(own.back()));
    }
    EXPECT_LE(own.size(), below.size());
    if (inner % 5 != 0) return;
    for (const auto& cell : below) {
      const Eigen::Vector3d p = sample.grid.position(cell);
      double nearest = 1e9;
      for (const Eigen::Vector3d& q : own) nearest = std::min(nearest, (p - q).norm());
      EXPECT_LE(nearest, std::sqrt(3.0) * tile.spacing * (1 + 1e-9));
    }
  });
  EXPECT_GT(inner, 10u);
}

TEST(Octree, LargeLeavesAreSplitForTheirPrecision) {
  Sample sample(ground(300, 6));
  sample.build({.leaf_points = 5000, .max_leaf_edge = 32});
  sample.visit([](const OctreeTile& tile) {
    if (!tile.children.empty()) return;
    EXPECT_LE(tile.box.sizes().maxCoeff(), 32.01);
  });
}

TEST(Octree, ManyPointsInOnePlaceEndSomewhere) {
  std::vector<Eigen::Vector3d> same(5000, Eigen::Vector3d(1, 2, 3));
  same.emplace_back(100, 2, 3);
  Sample sample(same);
  sample.build({.leaf_points = 1000});
  std::size_t points = 0, leaves = 0;
  sample.visit([&](const OctreeTile& tile) {
    if (!tile.children.empty()) return;
    points += sample.tiles.at(tile.name).size();
    ++leaves;
  });
  EXPECT_EQ(points, 5001u);
  EXPECT_EQ(leaves, 6u);

  Sample one(std::vector<Eigen::Vector3d>(2500, Eigen::Vector3d(1, 2, 3)));
  one.build({.leaf_points = 1000});
  EXPECT_EQ(one.roots.size(), 3u);
}

TEST(Octree, NoPointsNoTiles) {
  Sample sample({Eigen::Vector3d::Zero()});
  sample.points.clear();
  sample.build({});
  EXPECT_TRUE(sample.roots.empty());
}

}  // namespace
}  // namespace fovea
