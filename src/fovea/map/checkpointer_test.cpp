#include "fovea/map/checkpointer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <functional>
#include <thread>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map/map_test_support.h"

namespace fovea::checkpointer_test {

class CheckpointerTest : public testing::TestWithParam<bool> {
 protected:
  std::unique_ptr<Checkpointer> checkpointer(bool commit_at_end = false) {
    CheckpointerOptions options;
    options.threaded = GetParam();
    options.commit_at_end = commit_at_end;
    return std::make_unique<Checkpointer>(MapWriter::create(path_, true), options);
  }
  TileMap map_of(const PointCloud& points) const {
    TileMap map(2.0);
    map.add_submap(RigidMotion::Identity());
    map.add(points);
    return map;
  }
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.fovea";
  Random random_{4};
};

INSTANTIATE_TEST_SUITE_P(WithAndWithoutThread, CheckpointerTest, testing::Bool());

TEST_P(CheckpointerTest, EachCheckpointIsCommitted) {
  const auto file = checkpointer();
  TileMap map = map_of(points_at(0, random_));
  EXPECT_FALSE(file->is_writing());
  MapRows rows = rows_of(map);
  rows.meta["complete"] = "0";
  rows.frames = sample_frames();
  file->checkpoint(map, std::move(rows));
  file->wait();
  EXPECT_FALSE(file->is_writing());
  expect_stored(path_, map);
  EXPECT_EQ(MapReader(path_).frames().size(), 3u);
  rows = {};
  rows.poses.emplace_back(8, RigidMotion(Eigen::Translation3d(1, 2, 3)));
  file->checkpoint(map, std::move(rows));
  file->wait();
  EXPECT_EQ(MapReader(path_).frames()[1].T_local_lidar.translation(), Eigen::Vector3d(1, 2, 3));
}

// Points are added, recolored and removed while their earlier state is still to be written.
TEST_P(CheckpointerTest, LaterChangesDoNotReachACheckpoint) {
  const auto file = checkpointer();
  TileMap map = map_of(points_at(0, random_));
  for (const double x : {4, 8, 12}) map.add(points_at(x, random_));
  const TileMap before = map;
  file->checkpoint(map, rows_of(map));
  for (const double x : {0, 4, 8, 12}) map.add(points_at(x, random_));
  bool removed = false;
  for (const auto& [key, tile] : before.submaps()[0].tiles) {
    map.colors({0, key})[0].views ^= 3;
    if (!std::exchange(removed, true)) map.keep_points({0, key}, {});
  }
  file->wait();
  expect_stored(path_, before);
  file->finish(map, {});
  expect_stored(path_, map);
}

/// A writer that waits before each tile until the test lets it go on.
class GatedWriter : public MapWriter {
 public:
  explicit GatedWriter(const std::filesystem::path& path) : file_(MapWriter::create(path, true)) {}
  std::atomic<int> tiles_allowed = 0;
  std::atomic<int> tiles = 0, reads = 0;

  void put_meta(const std::string& key, const std::string& value) override {
    file_->put_meta(key, value);
  }
  void put_frame(const FrameRecord& record) override { file_->put_frame(record); }
  void put_drive(std::size_t id, const DriveRecord& drive) override { file_->put_drive(id, drive); }
  void put_sensor(std::size_t id, const SensorRecord& s) override { file_->put_sensor(id, s); }
  void put_submap(std::size_t id, const SubmapRecord& s) override { file_->put_submap(id, s); }
  void put_keyframe(const KeyframeRecord& k) override { file_->put_keyframe(k); }
  void put_checkpoint(const std::string& name, const CheckpointRecord& c) override {
    file_->put_checkpoint(name, c);
  }
  void put_pose(int frame, const RigidMotion& T) override { file_->put_pose(frame, T); }
  void put_tile(const PackedTile& tile) override {
    while (tiles_allowed <= tiles) std::this_thread::yield();
    ++tiles;
    file_->put_tile(tile);
  }
  void put_tiles(std::size_t count, const std::function<PackedTile(std::size_t)>& tile) override {
    file_->put_tiles(count, tile);
  }
  void remove_tile(const TileId& id) override { file_->remove_tile(id); }
  TilePoints read_tile(const TileId& id) override {
    ++reads;
    return file_->read_tile(id);
  }
  void commit() override { file_->commit(); }
  void finish(std::chrono::milliseconds reader_timeout) override { file_->finish(reader_timeout); }

 private:
  std::unique_ptr<MapWriter> file_;
};

TEST(Checkpointer, ReadsOfTilesGoBeforeQueuedTiles) {
  TemporaryFolder folder;
  Random random(4);
  auto gated = std::make_unique<GatedWriter>(folder / "a.fovea");
  GatedWriter& writer = *gated;
  Checkpointer file(std::move(gated), {});
  TileMap map(2.0);
  map.add_submap(RigidMotion::Identity());
  map.add(points_at(0, random));
  const TileId first{0, map.submaps()[0].tiles.begin()->first};
  writer.tiles_allowed = 1000;
  file.checkpoint(map, rows_of(map));
  file.wait();
  map.add(points_at(100, random));
  const int written = writer.tiles;
  writer.tiles_allowed = written;  // none, until the read is in the queue
  file.checkpoint(map, {});
  EXPECT_TRUE(file.is_writing());
  std::future<TilePoints> tile = file.read_tile(first);
  writer.tiles_allowed = written + 1;
  EXPECT_EQ(tile.get().size(), map.submaps()[0].tiles.at(first.key).points->size());
  EXPECT_LE(writer.tiles, written + 1);
  EXPECT_TRUE(file.is_writing());
  writer.tiles_allowed = 1000;
  file.wait();
  expect_stored(folder / "a.fovea", map);
}

TEST_P(CheckpointerTest, TheObserverSeesAllEarlierCheckpointsInTheFile) {
  CheckpointerOptions options;
  options.threaded = GetParam();
  std::vector<std::size_t> points;
  options.on_checkpoint = [&](const TileChanges&, const MapRows&) {
    points.push_back(std::filesystem::exists(path_) ? MapReader(path_).size() : 0);
  };
  Checkpointer file(MapWriter::create(path_, true), options);
  TileMap map = map_of(points_at(0, random_));
  for (int i = 0; i < 3; ++i) {
    file.checkpoint(map, rows_of(map));
    map.add(points_at(100, random_));
  }
  file.finish(map, {});
  EXPECT_EQ(points, (std::vector<std::size_t>{0, 500, 1000, 1500}));
}

TEST_P(CheckpointerTest, AnErrorOfWritingSurfaces) {
  const auto file = checkpointer();
  TileMap map = map_of(points_at(0, random_));
  MapRows rows;
  rows.meta["format_version"] = "9";  // set by the store
  file->checkpoint(map, std::move(rows));
  EXPECT_THROW(file->wait(), std::invalid_argument);
  EXPECT_THROW(file->read_tile({0, {}}).get(), std::invalid_argument);
  file->checkpoint(map, {});
  EXPECT_THROW(file->finish(map, {}), std::invalid_argument);
}

TEST_P(CheckpointerTest, AFailedReadEndsTheMap) {
  const auto file = checkpointer();
  TileMap map = map_of(points_at(0, random_));
  file->read_tile({7, {}}).wait();  // not in the file
  EXPECT_THROW(file->finish(map, {}), InputError);
}

// An error elsewhere may end a run while its checkpoint still waits for the thread.
TEST_P(CheckpointerTest, DestructionCommitsTheQueuedCheckpoint) {
  const TileMap map = map_of(points_at(0, random_));
  for (int trial = 0; trial < 20; ++trial) {
    TileMap copy = map;
    checkpointer()->checkpoint(copy, rows_of(copy));
    EXPECT_EQ(MapReader(path_).size(), 500u);
    std::filesystem::remove(path_);
  }
  EXPECT_EQ(folder_.names(), std::vector<std::string>{});
}

TEST_P(CheckpointerTest, UnfinishedChangesAreLeftOut) {
  TileMap map = map_of(points_at(0, random_));
  {
    const auto file = checkpointer();
    file->checkpoint(map, rows_of(map));
    file->wait();
    map.add(points_at(1, random_));
  }
  EXPECT_EQ(MapReader(path_).size(), 500u);
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"a.fovea"});
}

TEST_P(CheckpointerTest, WithCommitAtTheEndTheFileAppearsWhenItIsComplete) {
  for (const bool finish : {false, true}) {
    const auto file = checkpointer(/*commit_at_end=*/true);
    TileMap map(2.0);
    for (const double x : {0, 100, 0, 100}) {
      map.add_submap(RigidMotion::Identity());
      map.add(points_at(x, random_));
      file->checkpoint(map, rows_of(map));
      EXPECT_FALSE(std::filesystem::exists(path_));
    }
    if (!finish) continue;
    file->finish(map, {});
    expect_stored(path_, map);
  }
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"a.fovea"});
}

}  // namespace fovea::checkpointer_test
