#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "../../../tests/sample_city.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/exporting/city/city_tree.h"
#include "fovea/exporting/city/tile_overview.h"
#include "fovea/exporting/tileset/glb_reader.h"
#include "fovea/server/city_content.h"
#include "fovea/server/map_server.h"
#include "fovea/server/web_client.h"

namespace fovea::city_site_test {

using nlohmann::json;
using testing::HasSubstr;
using testing::UnorderedElementsAre;
namespace fs = std::filesystem;

constexpr std::array kPage{PageFile{"index.html", "<html>"}};

class CitySite : public testing::Test {
 protected:
  void make(const std::vector<CityTile>& tiles, bool with_overviews, std::size_t points = 3000) {
    write_sample_city(folder_ / "city", tiles, points);
    if (!with_overviews) return;
    for (const CityTileFile& tile : open_city(folder_ / "city").tiles) {
      write_tile_overview(tile.map, overview_of_tile(tile.map), 64);
    }
  }
  void show(const ExposureChoice& exposure = kCityExposure) {
    show_.emplace(make_city_content(open_city(folder_ / "city"), exposure), kPage, nullptr,
                  WebServerOptions());
    client_.emplace(std::stoi(show_->url().substr(show_->url().rfind(':') + 1)));
  }
  WebClient::Response get(const std::string& path) { return client_->get("/" + path); }
  json get_json(const std::string& path) { return json::parse(get(path).body); }

  /// Visits all contents, also those of the tilesets that a tileset refers to.
  void visit(const std::string& address,
             const std::function<void(const std::string&, const WebClient::Response&)>& f) {
    const std::string folder = address.substr(0, address.rfind('/') + 1);
    const std::function<void(const json&)> enter = [&](const json& tile) {
      if (tile.contains("content")) {
        const std::string uri =
            fs::path(folder + std::string(tile["content"]["uri"])).lexically_normal().string();
        const WebClient::Response response = get(uri);
        f(uri, response);
        if (uri.ends_with(".json") && response.status == 200) visit(uri, f);
      }
      if (!tile.contains("children")) return;
      for (const json& child : tile["children"]) enter(child);
    };
    enter(get_json(address)["root"]);
  }

  TemporaryFolder folder_;
  std::optional<MapServer> show_;
  std::optional<WebClient> client_;
};

TEST_F(CitySite, ShowsTheWholeCityAndEachTile) {
  make({{0, 0}, {1, 0}, {-1, 1}}, /*with_overviews=*/true);
  show();
  EXPECT_EQ(get("").body, "<html>");
  const json map = get_json("map.json");
  EXPECT_EQ(map["points"], 9000);
  EXPECT_EQ(map["city"]["tiles"], 3);
  EXPECT_EQ(map["tileset"], "tiles/tileset.json");
  EXPECT_EQ(get_json("status.json"), json({{"state", "ready"}, {"read", 1}}));
  EXPECT_EQ(get_json("frames.json")["index"].size(), 6u);
  EXPECT_FALSE(get_json("tiles/tileset.json")["root"].contains("transform"));
  std::size_t leaf_points = 0;
  std::vector<std::string> tilesets;
  visit("tiles/tileset.json", [&](const std::string& uri, const WebClient::Response& response) {
    EXPECT_EQ(response.status, 200) << uri;
    if (uri.ends_with(".json")) return tilesets.push_back(uri);
    EXPECT_THAT(response.body, HasSubstr("_SOURCE"));
    const bool is_below_tile = uri.find("/r") != std::string::npos;
    if (is_below_tile) leaf_points += read_glb(response.body, uri).size();
  });
  EXPECT_THAT(tilesets, UnorderedElementsAre("tiles/0_0/tileset.json", "tiles/1_0/tileset.json",
                                             "tiles/-1_1/tileset.json"));
  EXPECT_GE(leaf_points, 9000u);
  for (const char* none : {"tiles/2_2/tileset.json", "tiles/0_0/r9.glb", "tiles/q/q7.glb",
                           "tiles/0_0/tileset.xml", "tiles/q/tileset.json", "tiles/0_0"}) {
    EXPECT_EQ(get(none).status, 404) << none;
  }
}

TEST_F(CitySite, ShowsTheOverviewOfTheFile) {
  make({{0, 0}, {1, 0}}, /*with_overviews=*/true);
  const City city = open_city(folder_ / "city");
  fs::copy_file(overview_of_tile(city.tiles[1].map), overview_of_tile(city.tiles[0].map),
                fs::copy_options::overwrite_existing);
  show();
  EXPECT_EQ(get("tiles/0_0/overview.glb").body, get("tiles/1_0/overview.glb").body);
  // Of another exposure it is made of the map.
  show({ExposureChoice::Kind::kStops, 0, -1});
  EXPECT_NE(get("tiles/0_0/overview.glb").body, get("tiles/1_0/overview.glb").body);
}

TEST_F(CitySite, WithoutOverviewsItLooksTheSame) {
  make({{0, 0}, {1, 0}}, /*with_overviews=*/true);
  show();
  const std::string points = get("tiles/q/q.glb").body, tile = get("tiles/0_0/overview.glb").body;
  for (const CityTileFile& of : open_city(folder_ / "city").tiles) {
    fs::remove(overview_of_tile(of.map));
  }
  show();
  EXPECT_EQ(get("tiles/q/q.glb").body, points);
  EXPECT_EQ(get("tiles/0_0/overview.glb").body, tile);
}

TEST_F(CitySite, NamesADamagedTileAndShowsTheRest) {
  make({{0, 0}, {1, 0}, {2, 0}}, /*with_overviews=*/false);
  const City city = open_city(folder_ / "city");
  std::ofstream(city.tiles[1].map) << "no map at all";
  damage_sample_tile(city.tiles[2].map);
  show();
  std::size_t good = 0, failed = 0;
  std::string why;
  visit("tiles/tileset.json", [&](const std::string&, const WebClient::Response& response) {
    (response.status == 200 ? good : failed) += 1;
    if (response.status != 200) why += response.body;
  });
  EXPECT_GT(good, 5u);
  EXPECT_GE(failed, 2u);
  EXPECT_THAT(why, HasSubstr("tile 1,0: "));
  EXPECT_THAT(std::string(get_json("status.json")["failure"]), HasSubstr("tile 1,0: "));
  EXPECT_THAT(std::string(get_json("status.json")["failure"]), HasSubstr("tile 2,0: "));
}

TEST_F(CitySite, KeepsItsRevisionWhileABuildReplacesTiles) {
  make({{0, 0}, {1, 0}}, /*with_overviews=*/true);
  show();
  const std::string before = get("tiles/0_0/tileset.json").body;
  auto next = json::parse(std::ifstream(folder_ / "city/city.json"));
  write_sample_tile(folder_ / "city/tiles/0_0_1.fovea", {0, 0}, 64, 500);
  next["revision"] = 2;
  next["tiles"][0]["file"] = "tiles/0_0_1.fovea";
  write_sample_manifest(folder_ / "city", next);
  EXPECT_EQ(get("tiles/0_0/tileset.json").body, before);
  EXPECT_EQ(get_json("map.json")["city"]["revision"], 1);
}

TEST_F(CitySite, ACityWithoutTilesAndOneOfASingleTile) {
  make({}, false);
  show();
  EXPECT_EQ(get_json("map.json")["points"], 0);
  EXPECT_FALSE(get_json("tiles/tileset.json")["root"].contains("content"));
  EXPECT_EQ(get_json("frames.json")["index"], json::array());
  make({{5, -7}}, true);
  show();
  std::size_t contents = 0;
  visit("tiles/tileset.json", [&](const std::string& uri, const WebClient::Response& response) {
    EXPECT_EQ(response.status, 200) << uri;
    ++contents;
  });
  EXPECT_GT(contents, 2u);
}

TEST_F(CitySite, LargeCitiesAreReadPartByPart) {
  std::vector<CityTile> tiles;
  for (int x = 0; x < 17; ++x) {
    for (int y = 0; y < 17; ++y) tiles.push_back({x, y});
  }
  make(tiles, /*with_overviews=*/true, /*points=*/3);
  show();
  std::size_t points = 0, overviews = 0;
  visit("tiles/tileset.json", [&](const std::string& uri, const WebClient::Response& response) {
    EXPECT_EQ(response.status, 200) << uri;
    if (!uri.ends_with("overview.glb")) return;
    ++overviews;
    points += read_glb(response.body, uri).size();
  });
  EXPECT_EQ(overviews, 289u);
  EXPECT_EQ(points, 3 * 289u);
}

class LargeCitySite : public CitySite {
 protected:
  /// A square of tiles.
  void make_large(int edge) {
    std::vector<CityTile> tiles;
    for (int x = 0; x < edge; ++x) {
      for (int y = 0; y < edge; ++y) tiles.push_back({x, y});
    }
    write_repeated_city(folder_ / "city", tiles, 3000);
    const fs::path map = map_of_all();
    write_tile_overview(map, overview_of_tile(map), 64);
  }
  fs::path map_of_all() const { return open_city(folder_ / "city").tiles.front().map; }

  /// The addresses of the nodes above the tiles.
  std::vector<std::string> nodes() {
    std::vector<std::string> addresses;
    const std::function<void(const std::string&)> enter = [&](const std::string& tileset) {
      const std::function<void(const json&)> visit_tile = [&](const json& tile) {
        const std::string uri = tile.contains("content") ? tile["content"]["uri"] : json("");
        const std::string address = "tiles/q/" + uri.substr(uri.rfind('/') + 1);
        const bool is_of_tile = uri.ends_with("overview.glb");
        if (uri.ends_with(".json")) return enter(address);
        if (!uri.empty() && !is_of_tile) addresses.push_back(address);
        if (is_of_tile || !tile.contains("children")) return;
        for (const json& child : tile["children"]) visit_tile(child);
      };
      visit_tile(get_json(tileset)["root"]);
    };
    enter("tiles/tileset.json");
    return addresses;
  }
};

TEST_F(LargeCitySite, TheRootShowsTheWholeCity) {
  make_large(50);
  show();
  const json root = get_json("tiles/tileset.json")["root"];
  ASSERT_TRUE(root.contains("content"));
  const auto points = read_glb(get("tiles/q/q.glb").body, "q.glb");
  EXPECT_LE(points.size(), kMostPointsOfNode);
  std::set<std::array<int, 2>> squares;  // of 4 x 4 tiles
  for (const ExportPoint& point : points) {
    squares.insert({int(point.position.x() / 256), int(point.position.y() / 256)});
  }
  EXPECT_EQ(squares.size(), 13u * 13u);
  EXPECT_EQ(get_json("status.json"), json({{"state", "ready"}, {"read", 1}}));
}

TEST_F(LargeCitySite, EveryNodeHasPointsThatDoNotDependOnTheOrderOfRequests) {
  make_large(17);
  show();
  std::vector<std::string> addresses = nodes();
  EXPECT_GT(addresses.size(), 289u / 4);
  std::map<std::string, std::string> first;
  for (const std::string& address : addresses) {
    first[address] = get(address).body;
    EXPECT_GT(read_glb(first[address], address).size(), 100u) << address;
  }
  show();
  std::reverse(addresses.begin(), addresses.end());
  for (const std::string& address : addresses) EXPECT_EQ(get(address).body, first[address]);
}

TEST_F(LargeCitySite, WithoutOverviewsItIsShownPartByPart) {
  make_large(17);
  fs::remove(overview_of_tile(map_of_all()));
  show();
  EXPECT_TRUE(read_glb(get("tiles/q/q.glb").body, "q.glb").empty());
  EXPECT_EQ(get_json("status.json"), json({{"state", "ready"}, {"read", 1}}));
  // Of another exposure there are no files.
  show({ExposureChoice::Kind::kStops, 0, -1});
  EXPECT_FALSE(get_json("tiles/tileset.json")["root"].contains("content"));
}

TEST_F(LargeCitySite, ADamagedOverviewIsNamed) {
  make_large(17);
  std::ofstream(overview_of_tile(map_of_all())) << "no glTF";
  show();
  EXPECT_EQ(get("tiles/q/q.glb").status, 200);
  EXPECT_THAT(std::string(get_json("status.json")["failure"]), HasSubstr("tile 0,0: "));
}

TEST_F(CitySite, EndsWhileItReads) {
  make({{0, 0}, {1, 0}}, /*with_overviews=*/false);
  for (int i = 0; i < 10; ++i) {
    show();
    for (const char* path : {"frames.json", "tiles/q/q.glb", "tiles/0_0/r.glb"}) {
      client_->send(std::string("GET /") + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    }
    show_.reset();
  }
}

}  // namespace fovea::city_site_test
