// Maps that grow in a scratch folder and are copied when they are whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/core/sqlite_database.h"
#include "fovea/errors.h"
#include "fovea/map/map_store.h"

namespace fovea::map_scratch_test {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::IsEmpty;

class MapScratch : public testing::Test {
 protected:
  std::unique_ptr<MapWriter> start(bool force = false) const {
    auto writer = MapWriter::create(shared_ / "a.fovea", force, scratch_.path());
    put_sample_map(*writer, map_);
    return writer;
  }

  TemporaryFolder shared_, scratch_;
  TileMap map_ = sample_tile_map();
};

TEST_F(MapScratch, TheSharedFolderGetsTheWholeMapAtOnce) {
  {
    const auto writer = start();
    writer->commit();
    EXPECT_THAT(shared_.names(), IsEmpty());
    EXPECT_EQ(scratch_.names().size(), 1u);
    writer->finish();
  }
  EXPECT_THAT(shared_.names(), ElementsAre("a.fovea"));
  EXPECT_THAT(scratch_.names(), IsEmpty());
  {
    const auto writer = MapWriter::create(scratch_ / "b.fovea", false);
    put_sample_map(*writer, map_);
    writer->finish();
  }
  EXPECT_EQ(MapReader(shared_ / "a.fovea").digest(), MapReader(scratch_ / "b.fovea").digest());
}

TEST_F(MapScratch, NothingStaysOfAMapWithoutEnd) {
  start().reset();
  EXPECT_THAT(shared_.names(), IsEmpty());
  EXPECT_THAT(scratch_.names(), IsEmpty());
}

TEST_F(MapScratch, TheMapCannotBeWrittenAndIsReadWithoutLocks) {
  start()->finish();
  const fs::path file = shared_ / "a.fovea";
  EXPECT_EQ(fs::status(file).permissions() & fs::perms::owner_write, fs::perms::none);
  const MapReader reader(file);
  const auto state = reader.hold_state();
  EXPECT_EQ(reader.size(), map_.size());
  fs::permissions(file, fs::perms::owner_write, fs::perm_options::add);
  sqlite::Database writer(file, sqlite::Access::kWrite, file);
  EXPECT_EQ(writer.attempt("BEGIN EXCLUSIVE"), sqlite::Outcome::kDone);  // no lock of the reader
}

TEST_F(MapScratch, ASecondRunOfTheSameJobReplacesTheFile) {
  const auto first = start(), second = start();
  first->finish();
  second->finish();
  EXPECT_THAT(shared_.names(), ElementsAre("a.fovea"));
  EXPECT_NO_THROW(MapReader(shared_ / "a.fovea").check());
}

TEST_F(MapScratch, AnExistingFileNeedsForce) {
  start()->finish();
  EXPECT_THROW(start(), OutputError);
  EXPECT_NO_THROW(start(/*force=*/true)->finish());
}

TEST_F(MapScratch, AScratchFolderThatIsNotThereIsAnError) {
  EXPECT_THROW(MapWriter::create(shared_ / "a.fovea", false, scratch_ / "none"), OutputError);
}

TEST_F(MapScratch, IdentityFollowsThePointsAndNotTheTimings) {
  start()->finish();
  const std::string identity = MapReader(shared_ / "a.fovea").identity();
  {
    const auto writer = start(/*force=*/true);
    writer->put_meta("timing.total", "12");
    writer->finish();
  }
  EXPECT_EQ(MapReader(shared_ / "a.fovea").identity(), identity);
  {
    const auto writer = start(/*force=*/true);
    writer->remove_tile({0, map_.submaps()[0].tiles.begin()->first});
    writer->finish();
  }
  EXPECT_NE(MapReader(shared_ / "a.fovea").identity(), identity);
}

}  // namespace fovea::map_scratch_test
