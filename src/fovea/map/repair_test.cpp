#include "fovea/map/repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map/map_meta.h"

namespace fovea::repair_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class Repair : public testing::Test {
 protected:
  void SetUp() override { write_sample_map(folder_ / "a.fovea"); }

  void run_sql(const std::string& sql) {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open((folder_ / "a.fovea").c_str(), &database), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
  }
  RepairFigures repair() {
    damages_.clear();
    const auto writer = MapWriter::create(folder_ / "b.fovea", true);
    return repair_map(folder_ / "a.fovea", *writer,
                      [&](const std::string& damage) { damages_.push_back(damage); });
  }
  MapReader repaired() const { return MapReader(folder_ / "b.fovea"); }

  TemporaryFolder folder_;
  std::vector<std::string> damages_;
};

TEST_F(Repair, AWholeMapStaysTheSame) {
  const RepairFigures figures = repair();
  EXPECT_EQ(figures.left_out, 0u);
  EXPECT_EQ(figures.points, sample_tile_map().size());
  EXPECT_EQ(repaired().digest(), MapReader(folder_ / "a.fovea").digest());
  EXPECT_FALSE(repaired().checkpoint("tracker"));
}

TEST_F(Repair, LeavesOutDamagedRowsAndKeepsAllOthers) {
  run_sql("UPDATE frames SET note='x' WHERE frame=8");
  run_sql("UPDATE views SET stamp_ns=1 WHERE camera=2");
  run_sql("UPDATE meta SET value='x' WHERE key='config'");
  run_sql("UPDATE sensors SET name='x'");
  const RepairFigures figures = repair();
  EXPECT_EQ(figures.left_out, 4u);
  EXPECT_THAT(damages_, ElementsAre(HasSubstr("key 'config'"), HasSubstr("table 'sensors'"),
                                    HasSubstr("frame 7, camera 2"), HasSubstr("frame 8")));
  const MapReader map = repaired();
  EXPECT_EQ(map.check(), MapReader(folder_ / "a.fovea").tile_sizes().size());
  const std::vector<FrameRecord> frames = map.frames();
  ASSERT_EQ(frames.size(), 2u);
  ASSERT_EQ(frames[0].views.size(), 1u);
  EXPECT_EQ(frames[0].views[0].camera, 3);
  EXPECT_EQ(frames[1].index, 9);
  EXPECT_FALSE(map.meta().contains("config"));
  EXPECT_THAT(map.meta().at("repair"), HasSubstr("4 damaged parts"));
  EXPECT_EQ(map.drives().size(), 1u);
  EXPECT_TRUE(map.sensors().empty());
}

TEST_F(Repair, ALostSubmapTakesItsTilesAlong) {
  run_sql("DELETE FROM submaps WHERE id=0");
  repair();
  const MapReader map = repaired();
  EXPECT_EQ(map.submaps().size(), 2u);
  for (const auto& [id, points] : map.tile_sizes()) EXPECT_EQ(id.submap, 1u);
  const TileMap sample = sample_tile_map();
  EXPECT_EQ(map.tile_sizes().size(), sample.submaps()[1].tiles.size());
  EXPECT_EQ(map.submaps()[1].matrix(), sample.submaps()[1].T_local_submap.matrix());
}

// The poses of submaps are one page: without them, all points would be lost.
TEST_F(Repair, LostSubmapsGetThePosesOfTheirFirstFrames) {
  const TileMap sample = sample_tile_map();
  {
    const auto writer = MapWriter::open(folder_ / "a.fovea");
    for (int i = 0; i < 4; ++i) {
      FrameRecord frame;
      frame.index = 7 + i;
      frame.submap = i / 2;
      const RigidMotion moved(Eigen::Translation3d(i % 2, 0, 0));
      frame.T_local_lidar = sample.submaps()[std::size_t(i) / 2].T_local_submap * moved;
      writer->put_frame(frame);
    }
    writer->commit();
  }
  for (const char* loss : {"DELETE FROM submaps WHERE id=0", "DELETE FROM submaps WHERE id=1",
                           "UPDATE submaps SET pose='1'", "DROP TABLE submaps"}) {
    run_sql(loss);
    EXPECT_GT(repair().left_out, 0u);
    const std::vector<RigidMotion> submaps = repaired().submaps();
    ASSERT_EQ(submaps.size(), 2u) << loss;
    for (std::size_t id = 0; id < 2; ++id) {
      EXPECT_EQ(submaps[id].matrix(), sample.submaps()[id].T_local_submap.matrix()) << loss;
    }
    EXPECT_EQ(repaired().size(), sample.size()) << loss;
  }
}

// The meta data are one page: it may be lost as a whole.
TEST_F(Repair, RestoresMetaDataThatOtherRowsStateToo) {
  run_sql("DROP TABLE meta");
  EXPECT_THROW(MapReader(folder_ / "a.fovea").meta(), InputError);
  EXPECT_GT(repair().left_out, 0u);
  const MapMeta meta = repaired().meta();
  EXPECT_EQ(map_tile_size(meta), 4);
  const auto origin = map_origin(meta);
  ASSERT_TRUE(origin);
  EXPECT_EQ(origin->latitude, sample_drive().origin->latitude);
  EXPECT_EQ(repaired().size(), sample_tile_map().size());
}

TEST_F(Repair, FindsMissingRows) {
  run_sql("DELETE FROM tiles WHERE rowid=1");
  run_sql("DELETE FROM frames WHERE frame=9");
  EXPECT_EQ(repair().left_out, 2u);
  EXPECT_THAT(damages_, ElementsAre(HasSubstr("table 'frames'"), HasSubstr("table 'tiles'")));
}

}  // namespace fovea::repair_test
