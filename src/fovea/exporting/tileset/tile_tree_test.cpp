#include "fovea/exporting/tileset/tile_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "../../../../tests/sample_map.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/exporting/tileset/node_points.h"

namespace fovea::tile_tree_test {

void visit(const TileNode& node, const std::function<void(const TileNode&)>& f) {
  f(node);
  for (const TileNode& child : node.children) visit(child, f);
}

/// The sample map, with a spot of many points and one point far away.
class TileTree : public testing::Test {
 protected:
  void SetUp() override {
    TileMap map = sample_tile_map();
    Random random(3);
    PointCloud dense = random_map_points(6000, random, 1.5);
    dense.origin = {16, 56, 1};
    map.add(dense);
    Random again(4);
    PointCloud far = random_map_points(1, again, 0.1);
    far.origin = {1500, -700, 40};
    map.add(far);
    const auto writer = MapWriter::create(folder_ / "a.fovea", false);
    put_sample_map(*writer, map);
    writer->commit();
    reader_.emplace(folder_ / "a.fovea");
    points_.emplace(*reader_, choice_);
  }

  std::vector<ExportPoint> points_of(const TileNode& node) {
    LeafReader reader(*points_);
    const std::function<std::vector<ExportPoint>(const TileNode&)> read = [&](const TileNode& at) {
      if (at.is_leaf()) return reader.read(at);
      std::vector<ExportPoint> below;
      for (const TileNode& child : at.children) {
        const std::vector<ExportPoint> more = read(child);
        below.insert(below.end(), more.begin(), more.end());
      }
      return thinned(below, at);
    };
    return read(node);
  }

  TemporaryFolder folder_;
  PointChoice choice_{.include_uncolored = true};
  std::optional<MapReader> reader_;
  std::optional<PointStream> points_;
};

using Place = std::array<double, 3>;
Place place(const ExportPoint& point) {
  return {point.position.x(), point.position.y(), point.position.z()};
}

TEST_F(TileTree, LeavesHaveEveryPointOnce) {
  for (const std::size_t leaf_points : {50u, 500u, 100'000u}) {
    const TileNode root = make_tile_tree(*reader_, {.leaf_points = leaf_points});
    std::multiset<Place> in_leaves, in_map;
    std::set<std::string> names;
    visit(root, [&](const TileNode& node) {
      EXPECT_TRUE(names.insert(node.name).second) << node.name;
      if (!node.is_leaf()) return;
      EXPECT_EQ(node.spacing, 0);
      for (const ExportPoint& point : points_of(node)) {
        in_leaves.insert(place(point));
        EXPECT_TRUE(node.box.contains(point.position)) << node.name;
      }
    });
    points_->for_each_block([&](std::span<const ExportPoint> block) {
      for (const ExportPoint& point : block) in_map.insert(place(point));
    });
    EXPECT_EQ(in_leaves, in_map);
  }
}

TEST_F(TileTree, ParentsAreCoarserPicturesOfTheirChildren) {
  const TileNode root = make_tile_tree(*reader_, {.leaf_points = 100});
  std::size_t inner = 0;
  visit(root, [&](const TileNode& node) {
    if (node.is_leaf()) return;
    ++inner;
    EXPECT_GT(node.children.size(), 1u);
    std::vector<ExportPoint> below;
    for (const TileNode& child : node.children) {
      EXPECT_LE(child.spacing, node.spacing / 2);
      EXPECT_TRUE(node.box.contains(child.box));
      const std::vector<ExportPoint> points = points_of(child);
      below.insert(below.end(), points.begin(), points.end());
    }
    std::set<Place> places;
    for (const ExportPoint& point : below) places.insert(place(point));
    const std::vector<ExportPoint> own = thinned(below, node);
    std::set<std::array<int, 3>> cells;
    const auto cell = [&](const ExportPoint& point) {
      const Eigen::Array3i c =
          ((point.position - node.low) / node.spacing).array().floor().cast<int>();
      return std::array{c.x(), c.y(), c.z()};
    };
    for (const ExportPoint& point : own) {
      EXPECT_TRUE(places.contains(place(point)));
      EXPECT_TRUE(cells.insert(cell(point)).second) << "two points of a cell";
    }
    for (const ExportPoint& point : below) EXPECT_TRUE(cells.contains(cell(point)));
  });
  EXPECT_GT(inner, 10u);
}

TEST_F(TileTree, DenseTilesAreSplitAndSparseOnesJoined) {
  const TileNode root = make_tile_tree(*reader_, {.leaf_points = 500});
  std::size_t parts = 0, joined = 0;
  visit(root, [&](const TileNode& node) {
    if (!node.is_leaf()) return;
    EXPECT_LE(points_of(node).size(), 2000u);  // parts are guessed to be a quarter each
    parts += std::isfinite(node.part.min().x()) || std::isfinite(node.part.max().x());
    joined += node.tiles.size() > 1;
  });
  EXPECT_GE(parts, 8u);
  EXPECT_GT(joined, 10u);
}

TEST_F(TileTree, LeavesAreSmallForTheirPrecision) {
  visit(make_tile_tree(*reader_), [](const TileNode& node) {
    if (node.is_leaf()) {
      EXPECT_LE(node.box.sizes().maxCoeff(), 32 + 2 * 4 * std::sqrt(3.0));
    }
  });
}

TEST(TileTreeOf, ManyPointsInOnePlaceEndSomewhere) {
  const std::vector<RigidMotion> poses = {RigidMotion::Identity()};
  const std::vector<std::pair<TileId, std::size_t>> tiles = {{{0, {0, 0, 0}}, 100'000'000}};
  std::size_t leaves = 0;
  visit(make_tile_tree(tiles, 4, poses, {.leaf_points = 1}), [&](const TileNode& node) {
    leaves += node.is_leaf();
    EXPECT_FALSE(node.box.isEmpty());
  });
  EXPECT_GE(leaves, 4096u);  // 0.25 m
}

TEST(TileTreeOf, NoTiles) {
  const TileNode root = make_tile_tree({}, 4, {});
  EXPECT_TRUE(root.is_leaf());
  EXPECT_TRUE(root.tiles.empty());
  EXPECT_TRUE(root.box.isEmpty());
}

TEST(TileTreeOf, RefusesWhatCannotBe) {
  std::vector<RigidMotion> poses(2, RigidMotion::Identity());
  const std::vector<std::pair<TileId, std::size_t>> tiles = {{{0, {0, 0, 0}}, 1}, {{1, {}}, 1}};
  EXPECT_THROW(make_tile_tree(tiles, 4, {}), std::invalid_argument);
  poses[1].translation().x() = 1e300;
  EXPECT_THROW(make_tile_tree(tiles, 4, poses), InputError);
  poses[1].translation().x() = std::nan("");
  EXPECT_THROW(make_tile_tree(tiles, 4, poses), InputError);
}

}  // namespace fovea::tile_tree_test
