// What the store does where files, disks and programs fail.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <map>

#include "../../../tests/file_size_limit.h"
#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/core/random.h"
#include "fovea/errors.h"
#include "fovea/map/map_store.h"
#include "fovea/map/record_rows.h"

namespace fovea::map_store_failure_test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

template <class Error>
std::string message(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing thrown";
}

void write_file(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void run_sql(const std::filesystem::path& path, const std::string& sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
      << sqlite3_errmsg(database);
  sqlite3_close(database);
}

void put_meta_and_commit(MapWriter& writer, const std::string& value) {
  writer.put_meta("config", value);
  writer.commit();
}

// ---- names and folders

TEST(MapWriter, RefusesPathsBeforeAnyWork) {
  const TemporaryFolder folder;
  write_file(folder / "old.fovea", "something");
  const auto refusal = [](const std::filesystem::path& path, bool force) {
    return message<OutputError>([&] { MapWriter::create(path, force); });
  };
  EXPECT_THAT(refusal(folder / "old.fovea", false),
              AllOf(HasSubstr("exists already"), HasSubstr("old.fovea"), HasSubstr("--force")));
  EXPECT_THAT(refusal(folder.path(), true), HasSubstr("is a folder"));
  EXPECT_THAT(refusal(folder / "none/a.fovea", false), HasSubstr("folder does not exist"));
  EXPECT_THAT(refusal(folder / "old.fovea/a.fovea", true), HasSubstr("folder does not exist"));
  EXPECT_THAT(refusal("/proc/a.fovea", false), HasSubstr("cannot be written"));
  EXPECT_THAT(folder.names(), ElementsAre("old.fovea"));
}

TEST(MapWriter, NamesWithSpecialCharactersWork) {
  const TemporaryFolder folder;
  for (const char* name : {"a b.fovea", ":memory:", "q?x=1#y%20.fovea", "ü.fovea", "file:a"}) {
    write_sample_map(folder / name);
    EXPECT_EQ(MapReader(folder / name).frames().size(), 3u) << name;
  }
  EXPECT_EQ(folder.names().size(), 5u);
}

TEST(MapWriter, WithoutCommitNothingStays) {
  const TemporaryFolder folder;
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    put_sample_map(*writer, sample_tile_map());
    EXPECT_FALSE(std::filesystem::exists(folder / "a.fovea"));
  }
  EXPECT_THAT(folder.names(), IsEmpty());
}

TEST(MapWriter, ForceReplacesAtTheFirstCommit) {
  const TemporaryFolder folder;
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    put_meta_and_commit(*writer, "old");
  }
  {
    MapWriter::create(folder / "a.fovea", true)->put_meta("config", "dropped");
  }
  EXPECT_EQ(MapReader(folder / "a.fovea").meta().at("config"), "old");
  {
    const auto writer = MapWriter::create(folder / "a.fovea", true);
    writer->put_meta("config", "new");
    EXPECT_EQ(MapReader(folder / "a.fovea").meta().at("config"), "old");
    writer->commit();
    EXPECT_EQ(MapReader(folder / "a.fovea").meta().at("config"), "new");
  }
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea"));
  write_file(folder / "b.fovea", "not a map at all, but long enough to look like some file");
  write_file(folder / "b.fovea-wal", "stale");
  put_meta_and_commit(*MapWriter::create(folder / "b.fovea", true), "new");
  EXPECT_EQ(MapReader(folder / "b.fovea").meta().at("config"), "new");
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea", "b.fovea"));
}

/// A map whose writer ended while it was read: its log is still beside it.
void leave_log(const std::filesystem::path& path) {
  auto writer = MapWriter::create(path, false);
  put_meta_and_commit(*writer, "old");
  const MapReader reader(path);
  const auto held = reader.hold_state();
  put_meta_and_commit(*writer, "older");
  writer.reset();
}

TEST(MapWriter, TheLogOfARemovedMapIsNotTakenForItsOwn) {
  const TemporaryFolder folder;
  leave_log(folder / "a.fovea");
  ASSERT_TRUE(std::filesystem::exists(folder / "a.fovea-wal"));
  std::filesystem::remove(folder / "a.fovea");
  put_meta_and_commit(*MapWriter::create(folder / "a.fovea", false), "new");
  EXPECT_EQ(MapReader(folder / "a.fovea").meta().at("config"), "new");
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea"));
}

TEST(MapWriter, ALogThatWasLeftIsFoldedIn) {
  const TemporaryFolder folder;
  leave_log(folder / "a.fovea");
  fold_log(folder / "a.fovea");
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea"));
  EXPECT_EQ(MapReader(folder / "a.fovea").meta().at("config"), "older");
  fold_log(folder / "a.fovea");  // nothing to do
  EXPECT_EQ(MapReader(folder / "a.fovea").meta().at("config"), "older");
}

TEST(MapWriter, DoesNotReplaceWhatAppearedMeanwhile) {
  const TemporaryFolder folder;
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    write_file(folder / "a.fovea", "somebody else's");
    EXPECT_THROW(writer->commit(), OutputError);
  }
  EXPECT_EQ(std::filesystem::file_size(folder / "a.fovea"), 15u);
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea"));
}

// ---- commits

TEST(MapWriter, ReadersSeeCommitsAndOnlyThose) {
  const TemporaryFolder folder;
  const auto writer = MapWriter::create(folder / "a.fovea", false);
  put_meta_and_commit(*writer, "one");
  const MapReader reader(folder / "a.fovea");
  EXPECT_EQ(reader.meta().at("config"), "one");
  writer->put_meta("config", "two");
  EXPECT_EQ(reader.meta().at("config"), "one");
  writer->commit();
  EXPECT_EQ(reader.meta().at("config"), "two");
}

TEST(MapWriter, WhatWasNotCommittedIsDroppedAtTheEnd) {
  const TemporaryFolder folder;
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    put_meta_and_commit(*writer, "one");
    put_sample_map(*writer, sample_tile_map());
  }
  const MapReader reader(folder / "a.fovea");
  EXPECT_EQ(reader.meta().at("config"), "one");
  EXPECT_EQ(reader.size(), 0u);
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea"));
}

TEST(MapWriter, OpenGoesOn) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  {
    const auto writer = MapWriter::open(folder / "a.fovea");
    FrameRecord frame;
    frame.index = 10;
    writer->put_frame(frame);
    writer->commit();
  }
  const MapReader reader(folder / "a.fovea");
  EXPECT_EQ(reader.frames().size(), 4u);
  EXPECT_EQ(reader.size(), sample_tile_map().size());
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea"));
  EXPECT_THROW(MapWriter::open(folder / "none.fovea"), InputError);
  write_file(folder / "text", "this is no map");
  EXPECT_THROW(MapWriter::open(folder / "text"), InputError);
}

TEST(MapWriter, ASecondWriterIsRefused) {
  const TemporaryFolder folder;
  const auto writer = MapWriter::create(folder / "a.fovea", false);
  const auto second = [&](bool force) {
    return message<OutputError>([&] { MapWriter::create(folder / "a.fovea", force); });
  };
  EXPECT_THAT(second(false), HasSubstr("another program"));
  put_meta_and_commit(*writer, "one");
  EXPECT_THAT(message<OutputError>([&] { MapWriter::open(folder / "a.fovea"); }),
              HasSubstr("another program"));
  EXPECT_THAT(message<OutputError>(
                  [&] { put_meta_and_commit(*MapWriter::create(folder / "a.fovea", true), "x"); }),
              HasSubstr("another program"));
  put_meta_and_commit(*writer, "two");
  EXPECT_EQ(MapReader(folder / "a.fovea").meta().at("config"), "two");
}

// ---- killed programs and full disks

/// Runs `f` in a process of its own, which is killed at its end without any clean-up.
void run_and_kill(const std::function<void()>& f) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    try {
      f();
    } catch (...) {
      _exit(1);
    }
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status)) << "the child failed by itself";
}

TEST(MapWriter, AKillBeforeTheFirstCommitLeavesNoMapAndBlocksNobody) {
  const TemporaryFolder folder;
  run_and_kill([&] {
    auto writer = MapWriter::create(folder / "a.fovea", false);
    put_sample_map(*writer, sample_tile_map(50'000));
    (void)writer.release();
  });
  EXPECT_FALSE(std::filesystem::exists(folder / "a.fovea"));
  put_meta_and_commit(*MapWriter::create(folder / "a.fovea", false), "new");
  EXPECT_EQ(MapReader(folder / "a.fovea").meta().at("config"), "new");
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea"));
}

TEST(MapWriter, AKillLaterLeavesTheLastCommit) {
  const TemporaryFolder folder;
  run_and_kill([&] {
    auto writer = MapWriter::create(folder / "a.fovea", false);
    put_meta_and_commit(*writer, "one");
    put_meta_and_commit(*writer, "two");
    put_sample_map(*writer, sample_tile_map(50'000));  // more than SQLite's cache: it spills
    (void)writer.release();
  });
  {
    const MapReader reader(folder / "a.fovea");
    EXPECT_EQ(reader.meta().at("config"), "two");
    EXPECT_EQ(reader.size(), 0u);
  }
  {
    const auto writer = MapWriter::open(folder / "a.fovea");
    put_meta_and_commit(*writer, "three");
  }
  EXPECT_EQ(MapReader(folder / "a.fovea").meta().at("config"), "three");
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea"));
}

TEST(MapWriter, ForceOverAKilledMapIgnoresItsLog) {
  const TemporaryFolder folder;
  run_and_kill([&] {
    auto writer = MapWriter::create(folder / "a.fovea", false);
    put_meta_and_commit(*writer, "one");
    put_sample_map(*writer, sample_tile_map(50'000));
    (void)writer.release();
  });
  put_meta_and_commit(*MapWriter::create(folder / "a.fovea", true), "new");
  EXPECT_EQ(MapReader(folder / "a.fovea").meta().at("config"), "new");
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea"));
}

TEST(MapWriter, AFullDiskBeforeTheFirstCommitLeavesTheOldMap) {
  const TemporaryFolder folder;
  put_meta_and_commit(*MapWriter::create(folder / "a.fovea", false), "old");
  EXPECT_THAT(message<OutputError>([&] {
                const auto writer = MapWriter::create(folder / "a.fovea", true);
                const FileSizeLimit limit(200'000);
                put_sample_map(*writer, sample_tile_map(50'000));
                writer->commit();
              }),
              AllOf(HasSubstr("the disk is full"), HasSubstr("a.fovea"), HasSubstr("free some")));
  EXPECT_EQ(MapReader(folder / "a.fovea").meta().at("config"), "old");
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea"));
}

TEST(MapWriter, AFullDiskLaterLeavesTheLastCommit) {
  const TemporaryFolder folder;
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    put_meta_and_commit(*writer, "one");
    const FileSizeLimit limit(200'000);
    EXPECT_THAT(message<OutputError>([&] {
                  put_sample_map(*writer, sample_tile_map(50'000));
                  writer->commit();
                }),
                HasSubstr("the disk is full"));
    // Going on would write half of what belongs together.
    EXPECT_THROW(writer->put_meta("config", "two"), std::logic_error);
    EXPECT_THROW(writer->commit(), std::logic_error);
  }
  const MapReader reader(folder / "a.fovea");
  EXPECT_EQ(reader.meta().at("config"), "one");
  EXPECT_EQ(reader.size(), 0u);
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea"));
}

// ---- reading what is no map

TEST(MapReader, RefusesWhatIsNoMap) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& name) {
    return message<InputError>([&] { MapReader(folder / name); });
  };
  EXPECT_THAT(refusal("none.fovea"), AllOf(HasSubstr("does not exist"), HasSubstr("none.fovea")));
  EXPECT_THAT(message<InputError>([&] { MapReader(folder.path()); }), HasSubstr("it is a folder"));
  write_file(folder / "empty", "");
  EXPECT_THAT(refusal("empty"), HasSubstr("empty"));
  write_file(folder / "text", "hello");
  EXPECT_THAT(refusal("text"), HasSubstr("not a Fovea map"));
  write_file(folder / "long", std::string(100'000, 'x'));
  EXPECT_THAT(refusal("long"), HasSubstr("not a Fovea map"));
  run_sql(folder / "other", "CREATE TABLE meta(key, value)");
  EXPECT_THAT(refusal("other"), HasSubstr("not a Fovea map"));
  EXPECT_THAT(folder.names(), ElementsAre("empty", "long", "other", "text"));
}

TEST(MapReader, RefusesOtherVersions) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  run_sql(folder / "a.fovea", "PRAGMA user_version=8");
  EXPECT_THAT(message<InputError>([&] { MapReader(folder / "a.fovea"); }),
              AllOf(HasSubstr("format version 8"), HasSubstr("newer Fovea")));
  EXPECT_THROW(MapWriter::open(folder / "a.fovea"), InputError);
  for (const char* old : {"0", "5"}) {  // 5: no runs
    run_sql(folder / "a.fovea", std::string("PRAGMA user_version=") + old);
    EXPECT_THAT(
        message<InputError>([&] { MapReader(folder / "a.fovea"); }),
        AllOf(HasSubstr(std::string("format version ") + old), HasSubstr("map the drive again")));
  }
}

TEST(MapReader, ATruncatedMapIsAnInputError) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const auto size = std::filesystem::file_size(folder / "a.fovea");
  for (const double share : {0.01, 0.1, 0.5, 0.9, 0.999}) {
    std::filesystem::copy_file(folder / "a.fovea", folder / "b.fovea",
                               std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(folder / "b.fovea", std::uintmax_t(double(size) * share));
    EXPECT_THROW((void)MapReader(folder / "b.fovea").digest(), InputError) << share;
  }
}

TEST(MapReader, NamesTheDamagedTile) {
  const TemporaryFolder folder;
  const TileMap map = sample_tile_map();
  const TileKey key = std::next(map.submaps()[1].tiles.begin(), 20)->first;
  const auto numbers = [&](const char* between_y, const char* between_z) {
    return std::to_string(key.x) + between_y + std::to_string(key.y) + between_z +
           std::to_string(key.z);
  };
  const auto damage = [&](const std::string& assignment) {
    std::filesystem::remove(folder / "a.fovea");
    write_sample_map(folder / "a.fovea");
    run_sql(folder / "a.fovea", "UPDATE tiles SET " + assignment +
                                    " WHERE submap=1 AND x=" + numbers(" AND y=", " AND z="));
    return message<InputError>(
        [&] { MapReader(folder / "a.fovea").for_each_tile([](auto, auto&, auto&) {}); });
  };
  EXPECT_EQ(damage("points=points"), "nothing thrown");
  for (const char* assignment :
       {"position_mm=x'00'", "position_mm=color", "color=zeroblob(length(color))",
        "frame=substr(frame, 1, length(frame) - 1)", "intensity=NULL", "checksum=checksum+1",
        "points=points+1", "colored=colored-1", "origin_z_m=origin_z_m+4",
        "camera=CAST('text' AS BLOB)"}) {
    EXPECT_THAT(damage(assignment), AllOf(HasSubstr("tile " + numbers(" ", " ") + " of submap 1"),
                                          HasSubstr("a.fovea")))
        << assignment;
  }
}

/// What a reader that goes on tells of a file, and the tiles that it gives.
struct Salvaged {
  std::vector<std::string> damages;
  std::map<TileId, std::size_t> tiles;
};
Salvaged salvage(const std::filesystem::path& path) {
  Salvaged found;
  const MapReader reader(path, [&](const std::string& what) { found.damages.push_back(what); });
  reader.frames();
  reader.for_each_tile([&](std::size_t submap, const TileKey& key, const PointCloud& tile) {
    found.tiles[{submap, key}] = tile.size();
  });
  return found;
}

TEST(MapReader, ReadsAllTilesButTheDamagedOnes) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const Salvaged whole = salvage(folder / "a.fovea");
  EXPECT_TRUE(whole.damages.empty());
  run_sql(folder / "a.fovea", "UPDATE tiles SET color=zeroblob(length(color)) WHERE x=1");
  run_sql(folder / "a.fovea", "UPDATE frames SET pose='x' WHERE frame=8");
  const Salvaged rest = salvage(folder / "a.fovea");
  std::size_t damaged = 0;
  for (const auto& [id, size] : whole.tiles) {
    EXPECT_EQ(rest.tiles.contains(id), id.key.x != 1);
    damaged += id.key.x == 1;
  }
  ASSERT_GT(damaged, 3u);
  ASSERT_EQ(rest.damages.size(), damaged + 1);
  EXPECT_THAT(rest.damages[0], HasSubstr("frame 8"));
  EXPECT_THAT(rest.damages[1], AllOf(HasSubstr("checksum"), HasSubstr("tile 1 ")));
}

// Bits flipped anywhere, and a file cut short: no crash, no wrong point, and what is told of and
// what is read make up the whole.
TEST(MapReader, OfADamagedFileWhatIsWholeIsRead) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const Salvaged whole = salvage(folder / "a.fovea");
  const std::string bytes = read_file(folder / "a.fovea");
  Random random(9);
  std::size_t partly = 0;
  for (int trial = 0; trial < 150; ++trial) {
    std::string damaged = bytes;
    if (trial % 5 == 0) {
      damaged.resize(bytes.size() / 4 + random.below(bytes.size() * 3 / 4));
    } else {
      for (int k = 0; k < 3; ++k) {
        damaged[random.below(damaged.size())] ^= static_cast<char>(1 << random.below(8));
      }
    }
    write_file(folder / "b.fovea", damaged);
    try {
      const Salvaged rest = salvage(folder / "b.fovea");
      for (const auto& [id, size] : rest.tiles) {
        ASSERT_TRUE(whole.tiles.contains(id));
        ASSERT_EQ(whole.tiles.at(id), size);
      }
      partly += !rest.damages.empty() && !rest.tiles.empty();
      if (rest.damages.empty() && damaged.size() == bytes.size()) {
        ASSERT_EQ(rest.tiles.size(), whole.tiles.size());
      }
    } catch (const InputError&) {
      // Not even the schema, the meta data or the submaps are whole.
    }
  }
  EXPECT_GT(partly, 60u);
}

/// The eight bytes of a row's checksum as SQLite stores them.
std::string checksum_bytes(const FrameRecord& frame) {
  const std::uint64_t checksum = row_checksum(kFramesTable, frame_row(frame));
  std::string bytes;
  for (int shift = 56; shift >= 0; shift -= 8) bytes += static_cast<char>(checksum >> shift);
  return bytes;
}

// Bytes of an index put where others are: SQLite gives rows in the order in which they lie there.
TEST(MapReader, RowsOutOfOrderAreDamage) {
  const TemporaryFolder folder;
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    FrameRecord frame;
    frame.note = "frame of a test";
    for (frame.index = 3; frame.index <= 4; ++frame.index) writer->put_frame(frame);
    writer->put_submap(0, RigidMotion::Identity());
    writer->commit();
  }
  std::string bytes = read_file(folder / "a.fovea");
  // A row of a table is its length, its number and then its columns; the later lies before.
  const std::size_t at = bytes.find("frame of a test");
  ASSERT_NE(at, std::string::npos);
  const std::size_t begin = bytes.rfind(char{4}, at);
  bytes[begin] = 2;
  FrameRecord frame;
  frame.note = "frame of a test";
  frame.index = 4;
  const std::size_t checksum = bytes.find(checksum_bytes(frame));
  ASSERT_NE(checksum, std::string::npos);
  frame.index = 2;
  bytes.replace(checksum, 8, checksum_bytes(frame));
  write_file(folder / "b.fovea", bytes);
  EXPECT_THAT(message<InputError>([&] { MapReader(folder / "b.fovea").frames(); }),
              AllOf(HasSubstr("not in order"), HasSubstr("frame 2")));
  std::vector<std::string> damages;
  const MapReader salvage(folder / "b.fovea",
                          [&](const std::string& what) { damages.push_back(what); });
  EXPECT_EQ(salvage.frames().size(), 2u);
  EXPECT_THAT(damages, IsEmpty());
}

TEST(MapReader, IntensitiesAreInAllTilesOrNone) {
  const TemporaryFolder folder;
  PointCloud with = one_point_each({{1, 1, 1}});
  with.intensity = {0.5f};
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    writer->put_submap(0, RigidMotion::Identity());
    writer->put_tile({0, {0, 0, 0}}, one_point_each({{1, 1, 1}}));
    writer->put_tile({0, {1, 0, 0}}, with);
    writer->commit();
  }
  EXPECT_THAT(message<InputError>([&] { MapReader(folder / "a.fovea").all_points_local(); }),
              AllOf(HasSubstr("only some tiles have intensities"), HasSubstr("tile 1 0 0")));
}

// A map may come from anybody, and a view of his can be a query without end.
TEST(MapReader, AViewInPlaceOfATableIsRefused) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  run_sql(folder / "a.fovea",
          "DROP TABLE meta; CREATE VIEW meta(key, value) AS SELECT id, pose FROM submaps");
  EXPECT_THAT(message<InputError>([&] { MapReader(folder / "a.fovea").meta(); }),
              HasSubstr("prohibited"));
}

// A row is refused if any of its values has changed, whatever the value.
TEST(MapReader, NamesTheDamagedRow) {
  const TemporaryFolder folder;
  const auto damage = [&](const std::string& sql) {
    std::filesystem::remove(folder / "a.fovea");
    write_sample_map(folder / "a.fovea");
    run_sql(folder / "a.fovea", sql);
    return message<InputError>([&] { MapReader(folder / "a.fovea").check(); });
  };
  EXPECT_EQ(damage("UPDATE frames SET note=note"), "nothing thrown");
  for (const auto& [sql, row] : std::map<std::string, std::string>{
           {"UPDATE meta SET value='x' WHERE key='config'", "table 'meta', key 'config'"},
           {"UPDATE drives SET name='x'", "table 'drives', id 0"},
           {"UPDATE sensors SET profile='{}'", "table 'sensors', id 0"},
           {"UPDATE frames SET pose='1 2 3' WHERE frame=8", "table 'frames', frame 8"},
           {"UPDATE frames SET timings_ms='{}' WHERE frame=7", "table 'frames', frame 7"},
           {"UPDATE frames SET checksum='7' WHERE frame=7", "table 'frames', frame 7"},
           {"UPDATE views SET stamp_ns=stamp_ns+1 WHERE camera=3",
            "table 'views', frame 7, camera 3"},
           {"UPDATE views SET log2_gain_red=NULL WHERE camera=3",
            "table 'views', frame 7, camera 3"},
           {"UPDATE submaps SET pose='' WHERE id=1", "table 'submaps', id 1"},
           {"UPDATE submaps SET id=7 WHERE id=1", "table 'submaps', id 7"},
           {"UPDATE keyframes SET columns=columns+1", "table 'keyframes', frame 7, sensor 0"},
           {"UPDATE checkpoint SET state=x'00'", "table 'checkpoint', name 'tracker'"},
           {"UPDATE counts SET row_count=3 WHERE table_name='submaps'", "table 'counts'"}}) {
    EXPECT_THAT(damage(sql), AllOf(HasSubstr("checksum"), HasSubstr("a.fovea, " + row))) << sql;
  }
  EXPECT_THAT(damage("UPDATE tiles SET x=1<<40 WHERE rowid=1"), HasSubstr("impossible key"));
  EXPECT_THAT(damage("ALTER TABLE tiles DROP COLUMN range_cm"), HasSubstr("cannot be read"));
  EXPECT_THAT(damage("DROP TABLE views"), HasSubstr("cannot be read"));
}

TEST(MapReader, PosesFarFromAnyDriveAreRefused) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::function<void(MapWriter&)>& put) {
    std::filesystem::remove(folder / "a.fovea");
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    put_sample_map(*writer, sample_tile_map());
    put(*writer);
    writer->commit();
    return message<InputError>([&] { MapReader(folder / "a.fovea").check(); });
  };
  EXPECT_EQ(refusal([](MapWriter&) {}), "nothing thrown");
  for (const double far : {1e300, -1.1e7}) {
    const RigidMotion pose(Eigen::Translation3d(0, far, 0));
    EXPECT_THAT(refusal([&](MapWriter& writer) {
                  FrameRecord frame = sample_frames()[1];
                  frame.T_local_lidar = pose;
                  writer.put_frame(frame);
                }),
                AllOf(HasSubstr("column 'pose'"), HasSubstr("table 'frames', frame 8")));
    EXPECT_THAT(refusal([&](MapWriter& writer) { writer.put_submap(1, pose); }),
                AllOf(HasSubstr("column 'pose'"), HasSubstr("table 'submaps', id 1")));
  }
  RigidMotion turned = RigidMotion::Identity();
  turned.linear()(0, 0) = 1e300;
  EXPECT_THAT(refusal([&](MapWriter& writer) { writer.put_submap(0, turned); }),
              HasSubstr("table 'submaps', id 0"));
  EXPECT_THAT(refusal([&](MapWriter& writer) {
                Random random(1);
                PointCloud tile = random_map_points(1, random, 1.0);
                tile.origin = {1e300, 0, 0};
                writer.put_tile({0, {500, 0, 0}}, tile);
              }),
              HasSubstr("impossible origin"));
}

TEST(MapReader, APipeOrSocketInPlaceOfAFileIsRefusedAtOnce) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe.fovea").c_str(), 0600), 0);
  EXPECT_THAT(message<InputError>([&] { MapReader(folder / "pipe.fovea"); }),
              AllOf(HasSubstr("it is a pipe"), HasSubstr("pipe.fovea")));
  EXPECT_THAT(message<InputError>([&] { MapReader("/dev/zero"); }), HasSubstr("it is a device"));
  for (const char* ending : {"-wal", "-journal", "-shm"}) {
    std::filesystem::remove(folder / "a.fovea");
    write_sample_map(folder / "a.fovea");
    const auto side = folder / ("a.fovea" + std::string(ending));
    ASSERT_EQ(mkfifo(side.c_str(), 0600), 0);
    EXPECT_THAT(message<InputError>([&] { MapReader(folder / "a.fovea").check(); }),
                AllOf(HasSubstr("it is a pipe"), HasSubstr(ending)));
    EXPECT_THAT(message<InputError>([&] { MapWriter::open(folder / "a.fovea"); }),
                HasSubstr("it is a pipe"));
    std::filesystem::remove(side);
  }
}

TEST(MapReader, FindsMissingRows) {
  const TemporaryFolder folder;
  for (const auto& [table, row] :
       std::map<std::string, std::string>{{"meta", "key='config'"},
                                          {"drives", "id=0"},
                                          {"sensors", "id=0"},
                                          {"frames", "frame=9"},
                                          {"views", "camera=3"},
                                          {"submaps", "id=1"},
                                          {"keyframes", "frame=7"},
                                          {"tiles", "rowid=1"},
                                          {"checkpoint", "name='tracker'"},
                                          {"counts", "table_name='tiles'"}}) {
    std::filesystem::remove(folder / "a.fovea");
    write_sample_map(folder / "a.fovea");
    run_sql(folder / "a.fovea", fmt::format("DELETE FROM {} WHERE {}", table, row));
    EXPECT_THAT(message<InputError>([&] { MapReader(folder / "a.fovea").check(); }),
                HasSubstr("table '"))
        << table;
  }
}

TEST(MapReader, SizesOfImpossibleTilesAreRefused) {
  const TemporaryFolder folder;
  const auto sizes_damaged_by = [&](const std::string& sql) {
    std::filesystem::remove(folder / "a.fovea");
    write_sample_map(folder / "a.fovea");
    run_sql(folder / "a.fovea", sql);
    return message<InputError>([&] { MapReader(folder / "a.fovea").tile_sizes(); });
  };
  EXPECT_THAT(sizes_damaged_by("UPDATE tiles SET submap=2 WHERE rowid=1"),
              HasSubstr("impossible submap"));
  EXPECT_THAT(sizes_damaged_by("UPDATE tiles SET points=1<<27 WHERE rowid=1"),
              HasSubstr("impossible submap or size"));
}

// A damaged frame must not get a new checksum.
TEST(MapWriter, DoesNotHideADamagedFrame) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  run_sql(folder / "a.fovea", "UPDATE frames SET note='x' WHERE frame=8");
  const auto writer = MapWriter::open(folder / "a.fovea");
  EXPECT_THAT(message<InputError>([&] { writer->put_pose(8, RigidMotion::Identity()); }),
              HasSubstr("frame 8"));
}

}  // namespace fovea::map_store_failure_test
