#include "fovea/map/map_keeper.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"

namespace fovea::map_keeper_test {

constexpr double kNear = 5;  // m

PointCloud points_at(double x, Random& random) {
  PointCloud points = random_map_points(500, random, 3.0);
  points.origin = {x, 0, 0};
  return points;
}

MapRows rows_of(const TileMap& map) {
  MapRows rows;
  for (std::size_t id = 0; id < map.submaps().size(); ++id) {
    rows.submaps.emplace_back(id, map.submaps()[id].T_local_submap);
  }
  return rows;
}

void expect_stored(const std::filesystem::path& path, const TileMap& map) {
  std::size_t tiles = 0;
  MapReader(path).for_each_tile(
      [&](std::size_t submap, const TileKey& key, const PointCloud& tile) {
        ++tiles;
        ASSERT_TRUE(map.submaps()[submap].tiles.contains(key));
        expect_same_columns(tile, map.submaps()[submap].tiles.at(key).points->cloud());
      });
  std::size_t expected = 0;
  for (const Submap& submap : map.submaps()) expected += submap.tiles.size();
  EXPECT_EQ(tiles, expected);
}

class Keeper : public testing::TestWithParam<bool> {
 protected:
  std::unique_ptr<MapKeeper> keeper(std::size_t memory = std::size_t{1} << 30,
                                    bool commit_at_end = false) {
    return std::make_unique<MapKeeper>(MapWriter::create(path_, true),
                                       MapKeeperOptions{GetParam(), memory, commit_at_end});
  }
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.fovea";
  Random random_{4};
};

INSTANTIATE_TEST_SUITE_P(WithAndWithoutThread, Keeper, testing::Bool());

// A map that grows, shrinks and changes colour along a road and back, beside one that never leaves
// the memory.
TEST_P(Keeper, TheMapIsTheSameAsInMemory) {
  const auto keeper = this->keeper();
  TileMap map(2.0), whole(2.0);
  const auto both = [&](const auto& change) { change(map), change(whole); };
  std::size_t dropped = 0;
  for (const int place : {0, 1, 2, 3, 4, 3, 2, 1, 0}) {
    const Eigen::Vector3d center(40.0 * place, 0, 0);
    keeper->bring_near(map, center, kNear);
    both([&](TileMap& m) { m.add_submap(RigidMotion(Eigen::Translation3d(center))); });
    const PointCloud points = points_at(center.x(), random_);
    std::vector<TileId> near;
    whole.for_each_tile_near(center, kNear,
                             [&](const TileId& id, const TilePoints&) { near.push_back(id); });
    both([&](TileMap& m) {
      m.add(points);
      for (std::size_t i = 0; i < near.size(); ++i) {
        if (i % 3 == 0) m.colors(near[i])[0].spread ^= 5;
        if (i % 3 == 1) m.keep_points(near[i], {});
      }
    });
    keeper->checkpoint(map, rows_of(map), center, kNear);
    dropped += map.size() - map.size_in_memory();
    EXPECT_EQ(map.size(), whole.size());
  }
  keeper->finish();
  EXPECT_GT(dropped, 0u);
  expect_stored(path_, whole);
}

TEST_P(Keeper, EachCheckpointIsCommitted) {
  const auto keeper = this->keeper();
  TileMap map;
  map.add_submap(RigidMotion::Identity());
  map.add(points_at(0, random_));
  EXPECT_FALSE(keeper->is_writing());
  MapRows rows = rows_of(map);
  rows.meta["complete"] = "0";
  rows.frames = sample_frames();
  keeper->checkpoint(map, std::move(rows), {0, 0, 0}, kNear);
  keeper->finish();
  EXPECT_FALSE(keeper->is_writing());
  expect_stored(path_, map);
  EXPECT_EQ(MapReader(path_).frames().size(), 3u);
  rows = {};
  rows.poses.emplace_back(8, RigidMotion(Eigen::Translation3d(1, 2, 3)));
  keeper->checkpoint(map, std::move(rows), {0, 0, 0}, kNear);
  keeper->finish();
  EXPECT_EQ(MapReader(path_).frames()[1].T_local_lidar.translation(), Eigen::Vector3d(1, 2, 3));
}

// Points are added and recolored while what they were before is still to be written, in tiles that
// are packed and in tiles that are shared.
TEST_P(Keeper, ACheckpointIsWrittenAsItWasWhateverChangesAfter) {
  const auto keeper = this->keeper();
  TileMap map(2.0);
  map.add_submap(RigidMotion::Identity());
  for (const double x : {0, 4, 8, 12}) {
    keeper->bring_near(map, {x, 0, 0}, kNear);
    map.add(points_at(x, random_));
  }
  const TileMap before = map;
  keeper->checkpoint(map, rows_of(map), {12, 0, 0}, kNear);
  for (const double x : {0, 4, 8, 12}) map.add(points_at(x, random_));
  for (const auto& [key, tile] : before.submaps()[0].tiles) map.colors({0, key})[0].views ^= 3;
  keeper->finish();
  expect_stored(path_, before);
  keeper->finish(map, {});
  expect_stored(path_, map);
}

/// Counts what is written.
class CountingWriter : public MapWriter {
 public:
  explicit CountingWriter(const std::filesystem::path& path)
      : file_(MapWriter::create(path, true)) {}
  int tiles = 0, commits = 0;

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
  void put_tile(const PackedTile& tile) override { ++tiles, file_->put_tile(tile); }
  void put_tiles(std::size_t count, const std::function<PackedTile(std::size_t)>& tile) override {
    tiles += int(count), file_->put_tiles(count, tile);
  }
  void remove_tile(const TileId& id) override { file_->remove_tile(id); }
  TilePoints read_tile(const TileId& id) override { return file_->read_tile(id); }
  void commit() override { ++commits, file_->commit(); }
  void finish(std::chrono::milliseconds reader_timeout) override {
    ++commits, file_->finish(reader_timeout);
  }

 private:
  std::unique_ptr<MapWriter> file_;
};

/// A writer that would wait for ever, unless it is told to hurry.
class PatientKeeper : public testing::Test {
 protected:
  void until_it_waits(int times) {
    while (pauses_ < times) std::this_thread::yield();
  }
  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.fovea";
  Random random_{4};
  std::atomic<int> pauses_ = 0;
  MapKeeperOptions options_{
      .pause = [this](WallClock::time_point latest, const std::stop_token& hurry) {
        EXPECT_LE(latest, WallClock::now() + std::chrono::seconds(1));
        ++pauses_;
        std::mutex guard;
        std::unique_lock lock(guard);
        std::condition_variable_any nobody;
        nobody.wait(lock, hurry, [] { return false; });
      }};
};

// By whoever needs what it writes, or a tile that it is to read after that.
TEST_F(PatientKeeper, HurriesWhenItIsWaitedFor) {
  std::optional<MapKeeper> keeper(std::in_place, MapWriter::create(path_, true), options_);
  TileMap map(2.0);
  map.add_submap(RigidMotion::Identity());
  map.add(points_at(0, random_));
  map.add_submap(RigidMotion(Eigen::Translation3d(100, 0, 0)));
  map.add(points_at(100, random_));
  const Eigen::Vector3d here(0, 0, 0), there(100, 0, 0);
  keeper->checkpoint(map, rows_of(map), there, kNear);
  until_it_waits(1);
  keeper->checkpoint(map, {}, there, kNear);  // waits for the first, drops what lies behind
  ASSERT_LT(map.size_in_memory(), map.size());
  map.add(points_at(100, random_));
  keeper->checkpoint(map, {}, there, kNear);
  until_it_waits(2);
  keeper->bring_near(map, here, kNear);
  EXPECT_EQ(map.size_in_memory(), map.size());
  map.add(points_at(100, random_));
  keeper->checkpoint(map, {}, here, 1000);
  until_it_waits(3);
  keeper->finish();
  expect_stored(path_, map);
  map.add(points_at(100, random_));
  keeper->checkpoint(map, {}, there, kNear);
  until_it_waits(4);
  keeper.reset();
  EXPECT_EQ(pauses_, 4);  // who is waited for waits no more
}

// Nobody needs the state before the last one: what of it is still to be written goes with that, and
// what has changed since is written once.
TEST_F(PatientKeeper, TheLastCheckpointTakesOverTheOneBefore) {
  for (const bool observed : {false, true}) {
    pauses_ = 0;
    int told = 0;
    if (observed) options_.on_checkpoint = [&](const TileChanges&, const MapRows&) { ++told; };
    auto counting = std::make_unique<CountingWriter>(path_);
    const CountingWriter& writer = *counting;
    MapKeeper keeper(std::move(counting), options_);
    TileMap map(2.0);
    map.add_submap(RigidMotion::Identity());
    for (const double x : {0, 50, 100}) {
      keeper.bring_near(map, {x, 0, 0}, kNear);
      map.add(points_at(x, random_));
    }
    map.begin_step(), map.begin_step(), map.begin_step();
    map.add(points_at(100, random_));  // packed at once, all else is shared
    const int tiles = int(map.submaps()[0].tiles.size());
    keeper.checkpoint(map, rows_of(map), {100, 0, 0}, 1000);
    until_it_waits(1);
    map.add(points_at(50, random_));
    const TileId gone{0, map.submaps()[0].tiles.begin()->first};
    map.keep_points(gone, {});
    keeper.finish(map, {});
    expect_stored(path_, map);
    EXPECT_EQ(told, observed ? 2 : 0);
    EXPECT_EQ(pauses_, 1);
    EXPECT_EQ(writer.commits, observed ? 2 : 1);
    const int now = int(map.submaps()[0].tiles.size());
    if (observed) {
      EXPECT_GT(writer.tiles, tiles);
    } else {
      EXPECT_LE(writer.tiles, now + 1);  // the one that it had begun
    }
  }
}

// A tile that is requested ahead lies in the checkpoint that finish() takes over.
TEST_F(PatientKeeper, ATileRequestedAheadDoesNotDisturbTheEnd) {
  MapKeeper keeper(MapWriter::create(path_, true), options_);
  TileMap map(2.0), whole(2.0);
  const PointCloud behind = points_at(0, random_), ahead = points_at(100, random_);
  for (TileMap* m : {&map, &whole}) {
    m->add_submap(RigidMotion::Identity());
    m->add(behind);
    m->add_submap(RigidMotion(Eigen::Translation3d(100, 0, 0)));
    m->add(ahead);
  }
  keeper.checkpoint(map, rows_of(map), {100, 0, 0}, kNear);
  until_it_waits(1);
  ASSERT_LT(map.size_in_memory(), map.size());
  keeper.bring_near(map, {20, 0, 0}, kNear);  // 20 m behind: wanted soon, not waited for
  keeper.finish(map, {});
  expect_stored(path_, whole);
}

TEST_P(Keeper, WantsACheckpointWhenMemoryRunsOut) {
  const auto keeper = this->keeper(/*memory=*/65'000);
  TileMap map(2.0);
  for (int place = 0; place < 4; ++place) {
    map.add_submap(RigidMotion::Identity());
    map.add(points_at(100.0 * place, random_));
  }
  EXPECT_TRUE(keeper->needs_memory(map));
  keeper->checkpoint(map, rows_of(map), {300, 0, 0}, kNear);
  EXPECT_EQ(map.size_in_memory(), 500u);
  EXPECT_FALSE(keeper->needs_memory(map));
  // What cannot be dropped is no reason to try again.
  map.add(points_at(300, random_));
  map.add(points_at(300, random_));
  EXPECT_TRUE(keeper->needs_memory(map));
  keeper->checkpoint(map, {}, {300, 0, 0}, kNear);
  EXPECT_FALSE(keeper->needs_memory(map));
}

TEST_P(Keeper, AnErrorOfWritingComesOut) {
  const auto keeper = this->keeper();
  TileMap map;
  map.add_submap(RigidMotion::Identity());
  MapRows rows;
  rows.meta["format_version"] = "9";  // the store's own
  keeper->checkpoint(map, std::move(rows), {0, 0, 0}, kNear);
  EXPECT_THROW(keeper->finish(), std::invalid_argument);
}

TEST_P(Keeper, WhatIsNotFinishedIsNotLost) {
  TileMap map;
  map.add_submap(RigidMotion::Identity());
  map.add(points_at(0, random_));
  {
    const auto keeper = this->keeper();
    keeper->checkpoint(map, rows_of(map), {0, 0, 0}, kNear);
    keeper->finish();
    map.add(points_at(1, random_));  // never told
  }
  EXPECT_EQ(MapReader(path_).size(), 500u);
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"a.fovea"});
}

TEST_P(Keeper, AMapThatIsOfUseOnlyWhenWholeAppearsAtTheEnd) {
  TileMap map;
  map.add_submap(RigidMotion::Identity());
  for (const bool finish : {false, true}) {
    const auto keeper = this->keeper(1, /*commit_at_end=*/true);
    for (const double x : {0, 100, 0, 100}) {
      const Eigen::Vector3d center(x, 0, 0);
      keeper->bring_near(map, center, kNear);
      map.add_submap(RigidMotion::Identity());
      map.add(points_at(x, random_));
      keeper->checkpoint(map, rows_of(map), center, kNear);
      EXPECT_FALSE(std::filesystem::exists(path_));
    }
    EXPECT_EQ(map.size(), 2000u);
    if (!finish) {
      map = TileMap();
      map.add_submap(RigidMotion::Identity());
      continue;
    }
    keeper->finish();
    EXPECT_EQ(MapReader(path_).size(), map.size());
  }
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"a.fovea"});
}

// An error elsewhere ends a run while its checkpoint still waits for the thread.
TEST_P(Keeper, ACheckpointBegunIsCommittedHoweverTheRunEnds) {
  TileMap map;
  map.add_submap(RigidMotion::Identity());
  map.add(points_at(0, random_));
  for (int trial = 0; trial < 20; ++trial) {
    TileMap copy = map;
    this->keeper()->checkpoint(copy, rows_of(copy), {0, 0, 0}, kNear);
    EXPECT_EQ(MapReader(path_).size(), 500u);
    std::filesystem::remove(path_);
  }
}

}  // namespace fovea::map_keeper_test
