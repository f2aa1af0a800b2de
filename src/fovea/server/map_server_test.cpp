#include "fovea/server/map_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/exporting/viewer/map_description.h"
#include "fovea/server/test_drive.h"
#include "fovea/server/web_client.h"

namespace fovea::map_server_test {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::array kPage{PageFile{"index.html", "<html>"}, PageFile{"assets/page.js", "go()"}};

class MapServerTest : public testing::Test {
 protected:
  void show(std::shared_ptr<const DriveImages> images = nullptr) {
    auto content = make_map_content(folder_ / "a.fovea", images.get());
    show_.emplace(std::move(content), kPage, std::move(images), WebServerOptions());
    client_.emplace(std::stoi(show_->url().substr(show_->url().rfind(':') + 1)));
  }
  WebClient::Response get(const std::string& path) { return client_->get("/" + path); }
  json get_json(const std::string& path) { return json::parse(get(path).body); }

  TemporaryFolder folder_;
  std::optional<MapServer> show_;
  std::optional<WebClient> client_;
};

TEST_F(MapServerTest, ThePageAndWhatTheMapTellsOfItself) {
  write_sample_map(folder_ / "a.fovea");
  show();
  EXPECT_EQ(get("").body, "<html>");
  EXPECT_THAT(get("assets/page.js").header, HasSubstr("text/javascript"));
  EXPECT_EQ(get("assets/other.js").status, 404);
  const json map = get_json("map.json");
  EXPECT_EQ(map["points"], MapReader(folder_ / "a.fovea").size());
  EXPECT_EQ(map["tile_size"], 4);
  EXPECT_EQ(map["live"], false);
  EXPECT_EQ(map["images"], false);
  EXPECT_NEAR(map["origin"]["latitude"], 49.011212804408, 1e-12);
  EXPECT_EQ(map["foveal"]["far"], 18);
  EXPECT_EQ(map["rules"][2], "planar");
  const json frames = get_json("frames.json");
  EXPECT_EQ(frames["index"], json({7, 8, 9}));
  EXPECT_EQ(frames["status"], json({"mapped", "held-out", "skipped"}));
  EXPECT_EQ(frames["time"][0], 0);
  EXPECT_EQ(frames["time"][2], nullptr);
  EXPECT_EQ(frames["T_local_lidar"][1].size(), 12u);
  EXPECT_EQ(frames["milliseconds"]["decode"], json({12.5, nullptr, nullptr}));
  EXPECT_EQ(get("images/7/3.jpg").status, 404);
}

TEST_F(MapServerTest, EveryTileOfTheTilesetIsThere) {
  write_sample_map(folder_ / "a.fovea");
  show();
  const json tileset = get_json("tiles/tileset.json");
  EXPECT_FALSE(tileset["root"].contains("transform"));
  std::size_t tiles = 0;
  const std::function<void(const json&)> visit = [&](const json& tile) {
    const WebClient::Response content = get("tiles/" + std::string(tile["content"]["uri"]));
    EXPECT_EQ(content.status, 200);
    EXPECT_EQ(content.body.substr(0, 4), "glTF");
    EXPECT_THAT(content.body, HasSubstr("_SOURCE"));
    ++tiles;
    if (!tile.contains("children")) return;
    for (const json& child : tile["children"]) visit(child);
  };
  visit(tileset["root"]);
  EXPECT_GE(tiles, 5u);
  EXPECT_EQ(get_json("status.json")["state"], "ready");
  EXPECT_EQ(get("tiles/r9.glb").status, 404);
}

TEST_F(MapServerTest, TheWriterOfAMapThatIsShownEndsItAsOneFile) {
  const TileMap tiles = sample_tile_map();
  const auto writer = MapWriter::create(folder_ / "a.fovea", false);
  put_sample_map(*writer, tiles);
  writer->commit();
  show();
  const auto statuses = [&] {
    std::set<int> seen;
    const std::function<void(const json&)> visit = [&](const json& tile) {
      seen.insert(get("tiles/" + std::string(tile["content"]["uri"])).status);
      if (!tile.contains("children")) return;
      for (const json& child : tile["children"]) visit(child);
    };
    visit(get_json("tiles/tileset.json")["root"]);
    return seen;
  };
  EXPECT_THAT(statuses(), ElementsAre(200));
  writer->remove_tile({0, tiles.submaps()[0].tiles.begin()->first});
  writer->finish(std::chrono::milliseconds(50));
  EXPECT_TRUE(log_of_map(folder_ / "a.fovea").empty());
  std::filesystem::copy_file(folder_ / "a.fovea", folder_ / "alone.fovea");
  EXPECT_EQ(MapReader(folder_ / "alone.fovea").check(), MapReader(folder_ / "a.fovea").check());
  EXPECT_THAT(statuses(), ElementsAre(200)) << "a tile that is gone is shown as empty";
}

TEST_F(MapServerTest, ImagesOfADrive) {
  write_sample_map(folder_ / "a.fovea");
  show(std::make_shared<DriveImages>(std::make_shared<TestDrive>()));
  const json map = get_json("map.json");
  EXPECT_EQ(map["images"], true);
  EXPECT_EQ(map["cameras"][0]["index"], 3);
  EXPECT_EQ(map["cameras"][0]["T_cam_lidar"], json({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}));
  EXPECT_EQ(get("images/7/3.jpg").body.substr(0, 2), "\xff\xd8");
  for (const char* path : {"images/6/3.jpg", "images/7/2.jpg", "images/8/3.jpg", "images/9/3.jpg",
                           "images/7/3.png", "images/7", "images/-1/3.jpg", "images/7/x.jpg",
                           "images/99999999999999/3.jpg", "images/7/3/3.jpg", "images/7/.jpg"}) {
    EXPECT_EQ(get(path).status, 404) << path;
  }
}

TEST_F(MapServerTest, AnEmptyMap) {
  MapWriter::create(folder_ / "a.fovea", false)->commit();
  show();
  EXPECT_EQ(get_json("map.json")["points"], 0);
  EXPECT_EQ(get_json("frames.json")["index"], json::array());
  EXPECT_FALSE(get_json("tiles/tileset.json")["root"].contains("content"));
  EXPECT_EQ(get_json("status.json")["state"], "ready");
}

TEST_F(MapServerTest, NoMap) {
  EXPECT_THROW(show(), InputError);
  std::ofstream(folder_ / "a.fovea") << "not a map";
  EXPECT_THROW(show(), InputError);
}

// A tile whose bytes have changed: what needs it says so, all else is shown.
TEST_F(MapServerTest, ADamagedTileIsToldOf) {
  write_sample_map(folder_ / "a.fovea");
  {
    std::fstream file(folder_ / "a.fovea", std::ios::in | std::ios::out | std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    const std::size_t column = bytes.rfind("\x28\xb5\x2f\xfd");  // begins a zstd frame
    ASSERT_NE(column, std::string::npos);
    file.seekp(static_cast<std::streamoff>(column + 4));
    file << "over";
  }
  show();
  std::size_t failed = 0, good = 0;
  std::string why;
  const std::function<void(const json&)> visit = [&](const json& tile) {
    const WebClient::Response content = get("tiles/" + std::string(tile["content"]["uri"]));
    (content.status == 200 ? good : failed) += 1;
    if (content.status == 500) why = content.body;
    if (!tile.contains("children")) return;
    for (const json& child : tile["children"]) visit(child);
  };
  visit(get_json("tiles/tileset.json")["root"]);
  EXPECT_GE(good, 2u);
  EXPECT_GE(failed, 1u);
  EXPECT_THAT(why, HasSubstr("restore the map"));
  EXPECT_THAT(std::string(get_json("status.json")["failure"]), HasSubstr("restore the map"));
}

TEST_F(MapServerTest, EndsWhileItReads) {
  write_sample_map(folder_ / "a.fovea");
  for (int i = 0; i < 20; ++i) {
    show();
    client_->send("GET /tiles/r.glb HTTP/1.1\r\nHost: localhost\r\n\r\n");
    show_.reset();
  }
}

}  // namespace fovea::map_server_test
