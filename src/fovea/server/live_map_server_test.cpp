#include "fovea/server/live_map_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/map/checkpointer.h"
#include "fovea/server/recent_images.h"
#include "fovea/server/test_drive.h"
#include "fovea/server/web_client.h"

namespace fovea::live_map_server_test {

using nlohmann::json;
using ::testing::ElementsAre;

constexpr std::array kPage{PageFile{"index.html", "<html>"}};
constexpr int kFrames = 60;

/// What a page makes of the messages: the protocol, once more.
struct Picture {
  /// Position (mm) and colour.
  using Point = std::array<int, 6>;
  using Id = std::array<std::int32_t, 4>;

  void take(const WebClient::Message& message) {
    if (message.opcode == 1) {
      take_text(json::parse(message.bytes));
    } else if (message.opcode == 2) {
      const auto kind = read<std::uint32_t>(message.bytes, 0);
      if (kind == 2) {
        ++images;
        EXPECT_EQ(message.bytes.substr(12, 2), "\xff\xd8");
      } else {
        take_points(message.bytes);
      }
    }
  }

  std::string session;
  std::map<int, json> frames, moved;
  std::map<std::size_t, json> submaps;
  std::map<Id, std::multiset<Point>> tiles;
  int images = 0;
  bool ended = false;

 private:
  template <class T>
  static T read(const std::string& bytes, std::size_t offset) {
    T value{};
    std::memcpy(&value, bytes.substr(offset, sizeof(T)).data(), sizeof(T));
    return value;
  }

  void take_text(const json& message) {
    if (message["type"] == "hello") {
      session = message["session"];
      for (std::size_t i = 0; i < message["frames"]["index"].size(); ++i) {
        frames[message["frames"]["index"][i]] = message["frames"]["T_local_lidar"][i];
      }
      for (const json& T : message["T_local_submap"]) submaps[submaps.size()] = T;
    } else if (message["type"] == "frame") {
      frames[message["index"]] = message["T_local_lidar"];
    } else if (message["type"] == "poses") {
      for (const auto& [id, T] : message["T_local_submap"].items()) submaps[std::stoul(id)] = T;
      for (const auto& [id, T] : message["T_local_lidar"].items()) frames[std::stoi(id)] = T;
    } else {
      EXPECT_EQ(message["type"], "end");
      ended = true;
    }
  }

  void take_points(const std::string& bytes) {
    std::size_t at = 12;
    for (auto sections = read<std::uint32_t>(bytes, 8); sections > 0; --sections) {
      Id id{};
      for (std::size_t i = 0; i < 4; ++i) id[i] = read<std::int32_t>(bytes, at + 4 * i);
      const bool whole = read<std::uint32_t>(bytes, at + 16) == 1;
      const std::size_t n = read<std::uint32_t>(bytes, at + 20);
      if (whole) tiles.erase(id);
      const std::size_t positions = at + 24, colors = positions + 6 * n + n % 2 * 2;
      for (std::size_t i = 0; i < n; ++i) {
        Point point{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          point[axis] = read<std::uint16_t>(bytes, positions + 6 * i + 2 * axis);
          point[3 + axis] = read<std::uint8_t>(bytes, colors + 4 * i + axis);
        }
        tiles[id].insert(point);
      }
      at = colors + 16 * n;
    }
    EXPECT_EQ(at, bytes.size());
  }
};

/// A vehicle that adds points, colours anew what it sees and drops some, along 60 m; every 20
/// frames a submap begins, and once a loop is closed.
class LiveRun : public testing::Test {
 protected:
  void SetUp() override {
    job_.output = folder_ / "a.fovea";
    start(/*force=*/false);
  }
  void start(bool force) {
    show_ = std::make_unique<LiveMapServer>(job_, images_, kPage, WebServerOptions());
    CheckpointerOptions options;
    options.on_checkpoint = [this](const TileChanges& changes, const MapRows& rows) {
      show_->map_changed(changes, rows, map_);
    };
    file_ = std::make_unique<Checkpointer>(MapWriter::create(job_.output, force), options);
  }
  int port() const {
    const std::string url = show_->url();
    return std::stoi(url.substr(url.rfind(':') + 1));
  }

  void drive(int first, int end) {
    for (int frame = first; frame < end; ++frame) {
      map_frame(frame);
      if (frame % 5 == 4) checkpoint();
    }
  }
  void map_frame(int index) {
    if (index % 20 == 0) {
      map_.add_submap(exp_se3((Twist() << 0, 0, 0.1 * index, index, 0, 0).finished()));
    }
    Frame frame;
    frame.index = index;
    frame.images = {Image(8, 4, 3)};
    FrameRecord record;
    record.index = index;
    record.stamp = from_seconds(100 + 0.1 * index);
    record.T_local_lidar.translation().x() = index;
    record.figures = {{"texture_error", 9.5}, {"other", 1}};
    record.milliseconds = {{"frame", 70.0}};
    frames_.push_back(record);
    change_map(index);
    show_->frame_mapped(record, &frame, map_);
  }
  void change_map(int index) {
    std::vector<TileId> near;
    map_.for_each_tile_near({double(index), 0, 0}, 5,
                            [&](const TileId& id, const TilePoints&) { near.push_back(id); });
    for (const TileId& id : near) {
      for (FusedColor& of_point : map_.colors(id)) {
        of_point.color.code[1] = codes_of_bytes()[std::size_t(index)];
      }
    }
    if (index % 7 == 3 && !near.empty()) {
      const PointCloud tile = map_.submaps()[near[0].submap].tiles.at(near[0].key).points->cloud();
      std::vector<std::uint32_t> kept;
      for (std::uint32_t i = 0; i < tile.size(); i += 2) kept.push_back(i);
      map_.keep_points(near[0], kept);
    }
    if (index > 20 && index % 5 == 3) {  // far behind, and written long ago
      map_.keep_points({0, map_.submaps()[0].tiles.begin()->first}, {});
      ++removed_;
    }
    PointCloud points = random_map_points(3000, random_, 3.0);
    points.origin = {double(index), 0, 0};
    points.frame.assign(points.size(), index);
    map_.add(points);
  }
  void checkpoint() {
    MapRows rows;
    rows.frames = std::exchange(frames_, {});
    for (std::size_t i = 0; i < map_.submaps().size(); ++i) {
      rows.submaps.emplace_back(i, map_.submaps()[i].T_local_submap);
    }
    if (rows.frames.back().index == 44) {  // a loop is closed
      RigidMotion moved = map_.submaps()[0].T_local_submap;
      moved.translation().y() += 0.5;
      map_.move_submap(0, moved);
      for (int frame = 0; frame < 20; ++frame) {
        RigidMotion T = RigidMotion::Identity();
        T.translation() = Eigen::Vector3d(frame, 0.5, 0);
        rows.poses.emplace_back(frame, T);
      }
    }
    rows.meta["map.tile_size_m"] = "4";
    file_->checkpoint(map_, std::move(rows));
  }
  void finish() {
    file_->wait();
    show_->finish();
  }

  /// Reads until the end has been told.
  static Picture picture_of(WebClient& client, Picture picture = {}) {
    while (!picture.ended) {
      const WebClient::Message message = client.message();
      if (message.opcode < 0) break;
      picture.take(message);
    }
    return picture;
  }
  /// Of each tile there is one point in each cell that has any, in the colour that it has now.
  void expect_all(const Picture& picture) const {
    EXPECT_TRUE(picture.ended);
    EXPECT_EQ(picture.frames.size(), std::size_t{kFrames});
    EXPECT_EQ(picture.frames.at(7)[7], 0.5);
    EXPECT_EQ(picture.frames.at(33)[3], 33);
    ASSERT_EQ(picture.submaps.size(), map_.submaps().size());
    std::size_t tiles = 0;
    for (std::size_t submap = 0; submap < map_.submaps().size(); ++submap) {
      EXPECT_EQ(picture.submaps.at(submap),
                json(matrix_rows(map_.submaps()[submap].T_local_submap)));
      for (const auto& [key, tile] : map_.submaps()[submap].tiles) {
        ++tiles;
        const Picture::Id id{static_cast<std::int32_t>(submap), key.x, key.y, key.z};
        ASSERT_TRUE(picture.tiles.contains(id));
        expect_sample(picture.tiles.at(id), tile.points->cloud());
      }
    }
    for (const auto& [id, points] : picture.tiles) tiles -= !points.empty();
    EXPECT_EQ(tiles, 0u) << "tiles are shown that have gone";
    EXPECT_GT(removed_, 5);
  }
  static void expect_sample(const std::multiset<Picture::Point>& shown, const PointCloud& tile) {
    std::map<std::array<int, 3>, int> cells;  // of 62.5 mm
    std::set<Picture::Point> there;
    const auto cell = [](const Picture::Point& p) {
      return std::array{p[0] * 2 / 125, p[1] * 2 / 125, p[2] * 2 / 125};
    };
    for (std::size_t i = 0; i < tile.size(); ++i) {
      Picture::Point point{};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        point[axis] = static_cast<int>(std::lround(tile.position[i][int(axis)] * 1000));
      }
      point[3] = to_rgb(tile.color[i]).r;
      point[4] = to_rgb(tile.color[i]).g;
      point[5] = to_rgb(tile.color[i]).b;
      there.insert(point);
      cells.emplace(cell(point), 0);
    }
    for (const Picture::Point& point : shown) {
      EXPECT_TRUE(there.contains(point));
      ++cells[cell(point)];
    }
    std::size_t empty = 0;
    for (const auto& [key, count] : cells) {
      empty += count == 0;
      EXPECT_LE(count, 2);  // a point on a face is in one cell here and in the other there
    }
    EXPECT_LE(empty, cells.size() / 20);
  }

  TemporaryFolder folder_;
  MapJob job_;
  std::shared_ptr<FrameImages> images_ =
      std::make_shared<DriveImages>(std::make_shared<TestDrive>(0, kFrames));
  Random random_{5};
  int removed_ = 0;  // tiles
  TileMap map_{4.0};
  std::vector<FrameRecord> frames_;
  std::unique_ptr<LiveMapServer> show_;
  std::unique_ptr<Checkpointer> file_;
};

TEST_F(LiveRun, EverybodyHasTheWholeMapInTheEnd) {
  WebClient keen(port()), deaf(port(), 4096), late(port());
  ASSERT_EQ(keen.open_socket("/live"), 101);
  ASSERT_EQ(deaf.open_socket("/live"), 101);
  Picture seen;
  std::thread reader([&] { seen = picture_of(keen); });
  drive(0, 33);
  ASSERT_EQ(late.open_socket("/live"), 101);  // between two checkpoints
  // These join when a checkpoint removes a tile, before the next one.
  drive(33, 40);
  WebClient later(port());
  ASSERT_EQ(later.open_socket("/live"), 101);
  Picture first;
  first.take(later.message());
  drive(40, 45);
  WebClient latest(port());
  ASSERT_EQ(latest.open_socket("/live"), 101);
  drive(45, kFrames);
  EXPECT_EQ(removed_, 8);
  finish();
  reader.join();
  expect_all(seen);
  expect_all(picture_of(later, first));
  expect_all(picture_of(latest));
  EXPECT_GT(seen.images, 0);
  expect_all(picture_of(late));
  expect_all(picture_of(deaf));  // which has read nothing so far
  WebClient after(port());
  ASSERT_EQ(after.open_socket("/live"), 101);
  const Picture last = picture_of(after);
  expect_all(last);
  EXPECT_EQ(last.session, seen.session);
}

// Another map under the output's name is gone with the first commit, and never shown.
TEST_F(LiveRun, AnOldMapOfThatNameIsNotShown) {
  show_.reset();
  file_.reset();
  auto old = MapWriter::create(job_.output, true);
  put_sample_map(*old, sample_tile_map());
  old->commit();
  old.reset();
  start(/*force=*/true);
  WebClient client(port());
  ASSERT_EQ(client.open_socket("/live"), 101);
  drive(0, kFrames);
  finish();
  expect_all(picture_of(client));
}

TEST_F(LiveRun, NobodyLooksOnForAWhile) {
  {
    WebClient client(port());
    ASSERT_EQ(client.open_socket("/live"), 101);
    drive(0, 12);
  }
  drive(12, 41);
  WebClient client(port());
  ASSERT_EQ(client.open_socket("/live"), 101);
  drive(41, kFrames);
  finish();
  expect_all(picture_of(client));
}

TEST_F(LiveRun, AFrameIsToldOfWithItsPointsAtOnce) {
  WebClient client(port());
  ASSERT_EQ(client.open_socket("/live"), 101);
  Picture picture;
  picture.take(client.message());
  EXPECT_TRUE(picture.frames.empty());
  map_frame(0);
  while (picture.tiles.empty() || picture.images == 0) picture.take(client.message());
  EXPECT_EQ(picture.frames.size(), 1u);
  std::size_t points = 0;
  for (const auto& [id, tile] : picture.tiles) points += tile.size();
  EXPECT_GT(points, 1000u);
}

TEST_F(LiveRun, TheSiteBeforeAndAfter) {
  WebClient client(port());
  json map = json::parse(client.get("/map.json").body);
  EXPECT_EQ(map["live"], true);
  EXPECT_EQ(map["tileset"], nullptr);
  EXPECT_EQ(map["cameras"].size(), 1u);
  EXPECT_EQ(client.get("/tiles/tileset.json").status, 404);
  EXPECT_EQ(client.get("/").body, "<html>");
  drive(0, kFrames);
  EXPECT_EQ(json::parse(client.get("/frames.json").body)["index"].size(), std::size_t{kFrames});
  EXPECT_EQ(json::parse(client.get("/frames.json").body)["score"][3], 9.5);
  EXPECT_EQ(client.get("/images/3/3.jpg").status, 200);
  finish();
  map = json::parse(client.get("/map.json").body);
  EXPECT_EQ(map["live"], false);
  EXPECT_EQ(map["images"], true);
  EXPECT_EQ(client.get("/tiles/tileset.json").status, 200);
  EXPECT_EQ(client.get("/tiles/r.glb").status, 200);
}

TEST_F(LiveRun, LatestImagesOfARobotAreShownToTheEnd) {
  show_.reset();
  file_.reset();
  images_ = std::make_shared<RecentImages>(TestDrive(0, kFrames).info(), /*capacity=*/1);
  start(/*force=*/true);
  WebClient client(port());
  drive(0, 10);
  EXPECT_EQ(client.get("/images/9/3.jpg").status, 200);
  EXPECT_EQ(client.get("/images/8/3.jpg").status, 410);
  EXPECT_EQ(client.get("/images/8/3.jpg").body, "the image is no longer kept\n");
  drive(10, kFrames);
  finish();
  EXPECT_EQ(client.get("/images/59/3.jpg").status, 200);
  EXPECT_EQ(client.get("/images/9/3.jpg").status, 410);
}

TEST_F(LiveRun, EndsInTheMiddle) {
  WebClient client(port()), deaf(port(), 4096);
  ASSERT_EQ(client.open_socket("/live"), 101);
  ASSERT_EQ(deaf.open_socket("/live"), 101);
  drive(0, 21);
  file_.reset();
  show_.reset();
  while (client.message().opcode >= 0) {
  }
}

}  // namespace fovea::live_map_server_test
