// A map is one whole file at the end of its writing, whatever reads it and however full the disk
// is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <future>
#include <thread>

#include "../../../tests/file_size_limit.h"
#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map/map_store.h"

namespace fovea::map_log_test {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::chrono::milliseconds kShort{50};

class MapLog : public testing::Test {
 protected:
  /// A map with a commit "one", and "two" to be committed.
  std::unique_ptr<MapWriter> growing_map() {
    auto writer = MapWriter::create(map_, false);
    writer->put_meta("config", "one");
    writer->commit();
    put_sample_map(*writer, sample_tile_map());
    writer->put_meta("config", "two");
    return writer;
  }

  /// The value in the file alone.
  std::string value_in_copy() const {
    std::filesystem::copy_file(map_, folder_ / "copy",
                               std::filesystem::copy_options::overwrite_existing);
    const MapReader copy(folder_ / "copy");
    copy.check();
    const std::string value = copy.meta().at("config");
    std::filesystem::remove(folder_ / "copy");
    std::filesystem::remove(folder_ / "copy-wal");
    std::filesystem::remove(folder_ / "copy-shm");
    return value;
  }

  std::string finish_error(MapWriter& writer) {
    try {
      writer.finish(kShort);
    } catch (const OutputError& error) {
      return error.what();
    }
    return "nothing thrown";
  }

  const TemporaryFolder folder_;
  const std::filesystem::path map_ = folder_ / "a.fovea";
};

TEST_F(MapLog, FinishMakesAWholeFileThatWasNeverCommittedBefore) {
  {
    const auto writer = MapWriter::create(map_, false);
    put_sample_map(*writer, sample_tile_map());
    writer->finish();
    EXPECT_THROW(writer->put_meta("config", "more"), std::logic_error);
    EXPECT_THROW(writer->finish(), std::logic_error);
  }
  EXPECT_THAT(folder_.names(), ElementsAre("a.fovea"));
  EXPECT_EQ(MapReader(map_).size(), sample_tile_map().size());
}

TEST_F(MapLog, TheFileIsWholeWhileAReaderHasTheMapOpen) {
  auto writer = growing_map();
  const MapReader reader(map_);
  ASSERT_EQ(reader.meta().at("config"), "one");
  writer->finish(kShort);
  EXPECT_TRUE(log_of_map(map_).empty());
  EXPECT_EQ(value_in_copy(), "two");
  writer.reset();
  EXPECT_TRUE(log_of_map(map_).empty());
  EXPECT_EQ(value_in_copy(), "two");
  EXPECT_EQ(reader.meta().at("config"), "two");
}

TEST_F(MapLog, TheFileIsWholeWhileAnotherProgramOfSqliteHasItOpen) {
  auto writer = growing_map();
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(map_.c_str(), &other), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(other, "SELECT * FROM meta", nullptr, nullptr, nullptr), SQLITE_OK);
  writer->finish(kShort);
  writer.reset();
  EXPECT_EQ(value_in_copy(), "two");
  sqlite3_close(other);
  EXPECT_THAT(folder_.names(), ElementsAre("a.fovea"));
}

TEST_F(MapLog, FinishWaitsForAReaderOfAnEarlierState) {
  const auto writer = growing_map();
  const MapReader reader(map_);
  auto held = reader.hold_state();
  ASSERT_EQ(reader.meta().at("config"), "one");
  auto finished = std::async(std::launch::async, [&] { writer->finish(); });
  EXPECT_EQ(finished.wait_for(std::chrono::milliseconds(200)), std::future_status::timeout);
  held.reset();
  EXPECT_NO_THROW(finished.get());
  EXPECT_EQ(value_in_copy(), "two");
}

TEST_F(MapLog, FinishReportsTheLogIfAReaderKeepsAnEarlierState) {
  auto writer = growing_map();
  const MapReader reader(map_);
  auto held = reader.hold_state();
  ASSERT_EQ(reader.meta().at("config"), "one");
  EXPECT_THAT(finish_error(*writer), AllOf(HasSubstr("another program"), HasSubstr("a.fovea-wal"),
                                           HasSubstr("keep"), HasSubstr("fovea info")));
  writer.reset();
  EXPECT_EQ(log_of_map(map_).filename(), "a.fovea-wal");
  EXPECT_EQ(value_in_copy(), "one");
  EXPECT_EQ(MapReader(map_).meta().at("config"), "two") << "with its log the map is whole";
  fold_log(map_);
  EXPECT_EQ(log_of_map(map_).filename(), "a.fovea-wal") << "it is still in use";
}

TEST_F(MapLog, AMapInUseIsNotReplacedAndThatShowsAtOnce) {
  {
    const auto writer = growing_map();
    const MapReader reader(map_);
    ASSERT_EQ(reader.meta().at("config"), "one");
    writer->finish(kShort);
    try {
      MapWriter::create(map_, true);
      ADD_FAILURE() << "nothing thrown";
    } catch (const OutputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("another program"));
    }
    EXPECT_EQ(value_in_copy(), "two");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.fovea.partial"));
  }
  MapWriter::create(map_, true)->finish(kShort);
  EXPECT_THAT(folder_.names(), ElementsAre("a.fovea"));
}

// The disk has room for the log, but not for the file that grows by it.
TEST_F(MapLog, FinishReportsTheLogIfTheDiskIsFull) {
  std::unique_ptr<MapWriter> writer;
  {
    writer = MapWriter::create(map_, false);
    put_sample_map(*writer, sample_tile_map(50'000));
    writer->put_meta("config", "one");
    writer->commit();
    TileMap more(4.0);
    more.add_submap(RigidMotion::Identity());
    Random random(3);
    PointCloud points = random_map_points(2000, random, 3.0);
    points.origin = {5000, 0, 0};
    more.add(points);
    for (const auto& [key, tile] : more.submaps()[0].tiles)
      writer->put_tile({0, key}, *tile.points);
    writer->put_meta("config", "two");
  }
  {
    const FileSizeLimit limit(std::filesystem::file_size(map_) + 8192);
    EXPECT_THAT(finish_error(*writer), AllOf(HasSubstr("File too large"), HasSubstr("a.fovea-wal"),
                                             HasSubstr("keep"), HasSubstr("free disk space")));
    writer.reset();
  }
  EXPECT_FALSE(log_of_map(map_).empty());
  EXPECT_EQ(MapReader(map_).meta().at("config"), "two") << "with its log the map is whole";
  fold_log(map_);
  EXPECT_THAT(folder_.names(), ElementsAre("a.fovea"));
  EXPECT_EQ(value_in_copy(), "two");
}

// What a reader of a map that is being written may do at any time.
TEST_F(MapLog, FoldingLeavesAMapThatIsBeingWritten) {
  const auto writer = growing_map();
  writer->commit();
  fold_log(map_);
  writer->put_meta("config", "three");
  writer->finish(kShort);
  EXPECT_EQ(value_in_copy(), "three");
}

}  // namespace fovea::map_log_test
