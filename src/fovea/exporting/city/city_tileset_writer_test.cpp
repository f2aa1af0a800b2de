#include "fovea/exporting/city/city_tileset_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "../../../../tests/file_content.h"
#include "../../../../tests/sample_city.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/exporting/city/city_description.h"
#include "fovea/exporting/city/tile_overview.h"
#include "fovea/exporting/tileset/glb_reader.h"
#include "fovea/exporting/tileset/tileset_writer.h"

namespace fovea::city_tileset_writer_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;
namespace fs = std::filesystem;

class CityRoot : public testing::Test {
 protected:
  CityRoot() {
    write_sample_city(folder_ / "city", {{0, 0}, {1, 0}, {-1, 2}});
    city_ = open_city(folder_ / "city");
    fs::create_directories(out_);
  }
  void write_parts() const {
    for (const CityTileFile& tile : city_.tiles) {
      write_tileset(MapReader(tile.map), out_ / city_part_name(tile.tile),
                    {.points = {.include_uncolored = true, .exposure = kCityExposure}});
    }
  }
  /// The file with the points of the root.
  fs::path root_points() const {
    const auto json = nlohmann::json::parse(content(out_ / "tileset.json"));
    return out_ / json.at("root").at("content").at("uri").get<std::string>();
  }
  std::string error_of_root() const {
    try {
      write_city_root(city_, out_, {.force = true});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
  fs::path out_ = folder_ / "out";
  City city_;
};

TEST_F(CityRoot, LiesAboveThePartsOnEarth) {
  write_parts();
  const CityRootFigures figures = write_city_root(city_, out_);
  EXPECT_EQ(figures.nodes, 1u);
  const auto json = nlohmann::json::parse(content(out_ / "tileset.json"));
  const auto& root = json.at("root");
  EXPECT_EQ(root.at("transform").size(), 16u);
  EXPECT_TRUE(fs::exists(out_ / root.at("content").at("uri")));
  // The accumulated transform of a part's entry is none: its own root places it on earth.
  const auto matrix = [](const nlohmann::json& tile) {
    const auto numbers = tile.at("transform").get<std::vector<double>>();
    return Eigen::Matrix4d(Eigen::Map<const Eigen::Matrix4d>(numbers.data()));
  };
  std::vector<std::string> parts;
  const std::function<void(const nlohmann::json&)> visit = [&](const nlohmann::json& node) {
    const std::string uri = node.at("content").at("uri");
    EXPECT_TRUE(fs::exists(out_ / uri)) << uri;
    if (uri.ends_with(".json")) {
      parts.push_back(uri);
      EXPECT_LT((matrix(root) * matrix(node) - Eigen::Matrix4d::Identity()).norm(), 1e-6);
      const auto part = nlohmann::json::parse(content(out_ / uri)).at("root");
      const Eigen::Vector3d origin = matrix(part).topRightCorner<3, 1>();
      const auto box = node.at("boundingVolume").at("box").get<std::vector<double>>();
      EXPECT_LT((origin - Eigen::Vector3d(box[0], box[1], box[2])).norm(), 10);
    }
    if (!node.contains("children")) return;
    for (const auto& child : node.at("children")) visit(child);
  };
  visit(root);
  EXPECT_THAT(parts,
              UnorderedElementsAre("0_0/tileset.json", "1_0/tileset.json", "-1_2/tileset.json"));
}

/// The addresses in a tileset and in those it refers to, but not in the parts.
void expect_files_of(const fs::path& tileset, std::size_t& parts) {
  const auto json = nlohmann::json::parse(content(tileset));
  const std::function<void(const nlohmann::json&)> visit = [&](const nlohmann::json& node) {
    if (node.contains("content")) {
      const std::string uri = node.at("content").at("uri");
      EXPECT_TRUE(fs::exists(tileset.parent_path() / uri)) << tileset << " " << uri;
      const bool is_part = uri.ends_with("/tileset.json");
      parts += is_part;
      if (uri.ends_with(".json") && !is_part) expect_files_of(tileset.parent_path() / uri, parts);
    }
    if (!node.contains("children")) return;
    for (const auto& child : node.at("children")) visit(child);
  };
  visit(json.at("root"));
}

TEST_F(CityRoot, EveryAddressOfALargeCityIsAFile) {
  write_parts();
  const CityTileFile sample = city_.tiles.front();
  const fs::path part = out_ / city_part_name(sample.tile);
  city_.tiles.clear();
  for (int x = 10; x < 27; ++x) {
    for (int y = 10; y < 27; ++y) {
      city_.tiles.push_back(sample);
      city_.tiles.back().tile = {x, y};
      fs::copy(part, out_ / city_part_name({x, y}), fs::copy_options::recursive);
    }
  }
  write_city_root(city_, out_);
  std::size_t parts = 0;
  expect_files_of(out_ / "tileset.json", parts);
  EXPECT_EQ(parts, 17u * 17u);
}

TEST_F(CityRoot, ItsPointsAreThoseOfTheParts) {
  write_parts();
  write_city_root(city_, out_);
  const auto points = read_glb(content(root_points()), "q.glb");
  EXPECT_GT(points.size(), 300u);
  Eigen::AlignedBox3d box;
  for (const ExportPoint& point : points) box.extend(point.position);
  EXPECT_NEAR(box.min().x(), -32 - 24, 3);
  EXPECT_NEAR(box.max().x(), 96 + 24, 3);
  EXPECT_NEAR(box.max().y(), 160 + 24, 3);
}

TEST_F(CityRoot, TheSamePartsGiveTheSameBytesAndForceReplaces) {
  write_parts();
  write_city_root(city_, out_);
  const std::string json = content(out_ / "tileset.json"), points = content(root_points());
  EXPECT_THROW(write_city_root(city_, out_), OutputError);
  write_city_root(city_, out_, {.force = true});
  EXPECT_EQ(content(out_ / "tileset.json"), json);
  EXPECT_EQ(content(root_points()), points);
  const fs::path notes = root_points().parent_path() / "notes.txt";
  std::ofstream(notes) << "mine";
  EXPECT_NE(error_of_root(), "");
  EXPECT_EQ(content(notes), "mine");
}

TEST_F(CityRoot, AnEndBeforeTheTilesetLeavesTheEarlierRoot) {
  write_parts();
  write_city_root(city_, out_);
  const fs::path earlier = root_points();
  const std::string json = content(out_ / "tileset.json"), points = content(earlier);
  city_.tiles.pop_back();
  // A file that cannot be written ends the writer between the nodes and the tileset.
  std::ofstream(out_ / "file") << "no folder";
  EXPECT_THROW(write_city_root(city_, out_, {.beside = {{"file/a.js", ""}}, .force = true}), Error);
  EXPECT_EQ(content(out_ / "tileset.json"), json);
  ASSERT_TRUE(fs::exists(earlier));
  EXPECT_EQ(content(earlier), points);
  // The next one removes what is no longer needed, but no files of something else.
  std::ofstream(earlier.parent_path() / "notes.txt") << "mine";
  write_city_root(city_, out_, {.force = true});
  EXPECT_NE(root_points(), earlier);
  EXPECT_NE(content(root_points()), points);
  EXPECT_FALSE(fs::exists(earlier));
  EXPECT_EQ(content(earlier.parent_path() / "notes.txt"), "mine");
}

TEST_F(CityRoot, ReplacesTheNodesOfEarlierVersions) {
  write_parts();
  fs::create_directory(out_ / "q");
  std::ofstream(out_ / "q/q.glb") << "points";
  std::ofstream(out_ / "tileset.json") << "{}";
  write_city_root(city_, out_, {.force = true});
  EXPECT_FALSE(fs::exists(out_ / "q/q.glb"));
  EXPECT_TRUE(fs::exists(root_points()));
}

TEST_F(CityRoot, NamesPartsThatAreMissingOrDamaged) {
  write_parts();
  const std::string whole = content(out_ / "1_0/tileset.json");
  for (const std::string& text : {std::string("{"), std::string("{}"), whole.substr(0, 200)}) {
    std::ofstream(out_ / "1_0/tileset.json") << text;
    EXPECT_THAT(error_of_root(), HasSubstr("the part of tile 1,0 is damaged"));
  }
  fs::remove_all(out_ / "1_0");
  EXPECT_THAT(error_of_root(), HasSubstr("the part of tile 1,0 is missing"));
  EXPECT_FALSE(fs::exists(out_ / "tileset.json"));
}

TEST_F(CityRoot, OfACityWithoutTilesHasNoContent) {
  city_.tiles.clear();
  EXPECT_EQ(write_city_root(city_, out_).nodes, 0u);
  EXPECT_EQ(content(out_ / "tileset.json").find("content"), std::string::npos);
}

TEST_F(CityRoot, OverviewsThinTheMap) {
  const fs::path map = city_.tiles[0].map, overview = overview_of_tile(map);
  write_tile_overview(map, overview, 640);
  const auto points = read_glb(content(overview), "overview");
  EXPECT_GT(points.size(), 500u);
  EXPECT_LT(points.size(), 2000u);
  EXPECT_EQ(overview_points(MapReader(map), 5, kCityExposure).size(), points.size());
  write_tile_overview(map, overview, 64);  // over the older one
  EXPECT_GT(content(overview).size(), 28 * 2000u);
}

TEST_F(CityRoot, FramesOfAllTilesByDrive) {
  damage_sample_tile(city_.tiles[0].map);  // points do not count
  std::ofstream(city_.tiles[2].map) << "no map";
  const auto json = city_frames_json(city_);
  ASSERT_EQ(json.at("index").size(), 4u);
  EXPECT_EQ(json.at("drive"), nlohmann::json({0, 0, 0, 0}));
  const auto x = [&](std::size_t row) {
    return json.at("T_local_lidar").at(row).at(3).get<double>();
  };
  EXPECT_NEAR(x(0), -32, 0.1);
  EXPECT_NEAR(x(1), -22, 0.1);
  EXPECT_NEAR(x(2), 32, 0.1);
  ASSERT_EQ(json.at("failures").size(), 1u);
  EXPECT_THAT(std::string(json.at("failures").at(0)), HasSubstr("tile 1,0: "));
  const auto map = nlohmann::json::parse(to_json(describe_city(city_)));
  EXPECT_EQ(map.at("points"), 9000);
  EXPECT_EQ(map.at("city").at("extent_m"), nlohmann::json({192, 192}));
  EXPECT_EQ(map.at("city").at("drives").at(0).at("name"), "a");
}

}  // namespace fovea::city_tileset_writer_test
