#include "fovea/exporting/city/city_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "fovea/exporting/city/city_tileset_json.h"

namespace fovea::city_tree_test {

using testing::HasSubstr;

/// A square of tiles, without files.
City square(int edge, int west = -3, int south = 5) {
  City city;
  city.origin = {49, 8.4, 100};
  city.tile_size = 64;
  for (int x = 0; x < edge; ++x) {
    for (int y = 0; y < edge; ++y) city.tiles.push_back({{west + x, south + y}, {}, 1, 1});
  }
  return city;
}

CityTileShape box_of_30_m(std::size_t) {
  const Eigen::Vector3d half(30, 30, 10);
  return {{-half, half}, 0.5};
}

std::vector<ExportPoint> points_at(const std::vector<Eigen::Vector3d>& places) {
  std::vector<ExportPoint> points(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) points[i].position = places[i];
  return points;
}

TEST(CityTree, EachTileIsOnceInATreeOfFourChildrenAtMost) {
  const City city = square(21);
  const CityNode root = make_city_tree(city, box_of_30_m);
  EXPECT_EQ(root.tiles, 441u);
  std::set<std::size_t> tiles;
  std::set<std::string> names;
  const std::function<void(const CityNode&)> visit = [&](const CityNode& node) {
    EXPECT_TRUE(names.insert(node.name).second);
    EXPECT_LE(node.children.size(), 4u);
    if (node.tile) {
      EXPECT_TRUE(tiles.insert(*node.tile).second);
      EXPECT_TRUE(node.children.empty());
      return;
    }
    EXPECT_GE(node.children.size(), 2u);
    std::size_t below = 0;
    for (const CityNode& child : node.children) {
      EXPECT_GE(node.spacing, 2 * child.spacing);
      EXPECT_TRUE(node.box.contains(child.box));
      below += child.tiles;
      visit(child);
    }
    EXPECT_EQ(below, node.tiles);
  };
  visit(root);
  EXPECT_EQ(tiles.size(), 441u);
}

TEST(CityTree, OfOneTileAndOfNone) {
  const CityNode one = make_city_tree(square(1), box_of_30_m);
  EXPECT_FALSE(one.tile);
  ASSERT_EQ(one.children.size(), 1u);
  EXPECT_EQ(one.children[0].tile, 0u);
  EXPECT_NEAR(one.box.center().x(), -3 * 64 + 32, 0.1);
  const CityNode none = make_city_tree(square(0), box_of_30_m);
  EXPECT_FALSE(none.tile);
  EXPECT_TRUE(none.box.isEmpty());
}

TEST(CityTree, NodesThinThePointsOfTheirChildren) {
  const City city = square(2, 0, 0);
  const CityNode root = make_city_tree(city, box_of_30_m);
  ASSERT_EQ(root.children.size(), 4u);
  EXPECT_EQ(root.spacing, 1);
  const auto known = [](const CityNode& node) -> std::optional<std::vector<ExportPoint>> {
    if (!node.tile) return std::nullopt;
    if (*node.tile > 0) return std::vector<ExportPoint>();
    return points_at({{5.5, 5.5, 0.5}, {5.1, 5.5, 0.5}, {8, 8, 8}});
  };
  std::vector<std::string> made;
  const auto points = for_each_city_node(
      root, known,
      [&](const CityNode& node, const std::vector<ExportPoint>&) { made.push_back(node.name); });
  EXPECT_THAT(made, testing::ElementsAre("q"));
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].position.x(), 5.5) << "the one nearest to the cell's middle";
}

TEST(CityTree, ANodeHasABoundedNumberOfPoints) {
  const CityNode root = make_city_tree(square(2, 0, 0), box_of_30_m);
  std::vector<ExportPoint> points;
  for (int x = 0; x < 50; ++x) {
    for (int y = 0; y < 50; ++y) {
      for (int z = 0; z < 50; ++z) {
        points.emplace_back().position = Eigen::Vector3d(x, y, z) + Eigen::Vector3d::Constant(0.5);
      }
    }
  }
  ASSERT_EQ(root.spacing, 1);
  EXPECT_EQ(thinned_to_node(points, root).size(), 25u * 25u * 25u);
}

TEST(CityTree, AFewTilesAreEnoughForACoarseNode) {
  const CityNode small = make_city_tree(square(8), box_of_30_m);
  EXPECT_EQ(tiles_that_show(small).size(), 64u);
  // 512 cells on the edge, so that a cell of the root's grid is 4 x 4 tiles.
  City city = square(20);
  city.tiles.push_back({{400, 400}, {}, 1, 1});
  const CityNode large = make_city_tree(city, box_of_30_m);
  ASSERT_EQ(large.spacing, 256);
  EXPECT_THAT(tiles_that_show(large), testing::SizeIs(5 * 5 + 1));
}

CityTilesetForm form() {
  CityTilesetForm form;
  form.content = [](const CityNode& node) { return node.name + ".glb"; };
  form.subtree = [](const CityNode&) { return std::string(); };
  form.tile = [](const CityNode& node) {
    CityTileEntry entry;
    entry.T_parent_entry.translation().x() = 7;
    entry.content = std::to_string(*node.tile) + ".glb";
    entry.below = std::to_string(*node.tile) + ".json";
    return entry;
  };
  return form;
}

TEST(CityTilesetJson, HasNodesAndTiles) {
  const CityNode root = make_city_tree(square(2), box_of_30_m);
  const auto json = nlohmann::json::parse(city_tileset_json(root, form()));
  const auto& node = json.at("root");
  EXPECT_EQ(node.at("refine"), "REPLACE");
  EXPECT_FALSE(node.contains("transform"));
  EXPECT_EQ(node.at("content").at("uri"), "q.glb");
  ASSERT_EQ(node.at("children").size(), 4u);
  const auto& tile = node.at("children").at(1);
  EXPECT_EQ(tile.at("transform").at(12), 7);
  EXPECT_EQ(tile.at("content").at("uri"), "2.glb");
  EXPECT_EQ(tile.at("boundingVolume").at("box"),
            nlohmann::json({0, 0, 0, 30, 0, 0, 0, 30, 0, 0, 0, 10}));
  EXPECT_EQ(tile.at("children").at(0).at("content").at("uri"), "2.json");
}

TEST(CityTilesetJson, BoxesTurnWithTheFrameOfATile) {
  CityTilesetForm turned = form();
  turned.tile = [](const CityNode&) {
    CityTileEntry entry;
    entry.T_entry_tile = Eigen::Translation3d(1000, 0, 0) *
                         Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitY());
    return entry;
  };
  const CityNode root = make_city_tree(square(1), box_of_30_m);
  const auto json = nlohmann::json::parse(city_tileset_json(root, turned));
  const auto box = json.at("root")
                       .at("children")
                       .at(0)
                       .at("boundingVolume")
                       .at("box")
                       .get<std::vector<double>>();
  EXPECT_EQ(box[0], 1000);
  EXPECT_NEAR(box[5], -30, 1e-9);  // the tile's x axis points down
  EXPECT_NEAR(box[9], 10, 1e-9);   // its z axis is the x axis
}

TEST(CityTilesetJson, LargeCitiesAreSplit) {
  const CityNode root = make_city_tree(square(40), box_of_30_m);
  CityTilesetForm split = form();
  split.subtree = [&](const CityNode& node) {
    return begins_tileset(node, root.tiles) ? node.name + ".json" : std::string();
  };
  const std::string json = city_tileset_json(root, split);
  EXPECT_LT(json.size(), 10'000u);
  EXPECT_THAT(json, HasSubstr("q0"));
  EXPECT_THAT(json, HasSubstr(".json"));
  EXPECT_THAT(json, testing::Not(HasSubstr("\"0.glb\"")));
}

TEST(CityTilesetJson, WithoutTilesOrPointsThereIsNoContent) {
  const auto no_points = [](std::size_t) { return CityTileShape(); };
  for (const int edge : {0, 1, 2}) {
    const CityNode root = make_city_tree(square(edge), no_points);
    const auto json = nlohmann::json::parse(city_tileset_json(root, form()));
    EXPECT_FALSE(json.at("root").contains("content")) << edge;
    EXPECT_FALSE(json.at("root").contains("children")) << edge;
  }
}

}  // namespace fovea::city_tree_test
