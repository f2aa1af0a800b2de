// Damage to any page of a map: it is found, named with one remedy, and repaired as far as possible.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map/map_schema.h"
#include "fovea/map/map_store.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/repair.h"

namespace fovea::map_damage_test {

using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// More frames, views and keyframes than a page holds, and free pages.
void write_map(const std::filesystem::path& path) {
  const auto writer = MapWriter::create(path, true);
  put_sample_map(*writer, sample_tile_map(800));
  for (int i = 10; i < 60; ++i) {
    FrameRecord frame = sample_frames()[0];
    frame.index = i;
    frame.note = std::string(300, 'x');
    frame.submap = i % 2;
    frame.T_local_lidar = sample_tile_map(1).submaps()[std::size_t(i) % 2].T_local_submap;
    for (int camera = 4; camera < 10; ++camera) frame.views.push_back({camera, i, std::nullopt});
    writer->put_frame(frame);
    KeyframeRecord keyframe = sample_keyframe();
    keyframe.frame = i;
    writer->put_keyframe(keyframe);
  }
  const PointCloud extra = one_point_each(std::vector<Eigen::Vector3f>(5000, {1, 1, 1}));
  for (int i = 0; i < 8; ++i) writer->put_tile({0, {1000 + i, 0, 0}}, extra);
  for (int i = 0; i < 8; ++i) writer->remove_tile({0, {1000 + i, 0, 0}});
  writer->commit();
}

class MapDamage : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const TemporaryFolder folder;
    write_map(folder / "a.fovea");
    std::ifstream file(folder / "a.fovea", std::ios::binary);
    bytes_ = {std::istreambuf_iterator<char>(file), {}};
    digest_ = MapReader(folder / "a.fovea").digest();
    points_ = MapReader(folder / "a.fovea").size();
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open((folder / "a.fovea").c_str(), &database), SQLITE_OK);
    sqlite3_exec(
        database, "SELECT name, pageno FROM dbstat",
        [](void*, int, char** values, char**) {
          owners_[std::stoul(values[1])] = values[0];
          return 0;
        },
        nullptr, nullptr);
    sqlite3_close(database);
  }

  std::filesystem::path map() const { return folder_ / "b.fovea"; }
  void write(const std::string& bytes) const { std::ofstream(map(), std::ios::binary) << bytes; }
  /// The map with some bytes of a page, from 1, that are others.
  static std::string with_damaged_page(std::size_t page) {
    std::string damaged = bytes_;
    Random random(static_cast<int>(page));
    for (std::size_t i = 0; i < 200; ++i) {
      damaged[(page - 1) * kPageSize + i] = static_cast<char>(random.below(256));
    }
    return damaged;
  }
  static std::size_t pages() { return bytes_.size() / kPageSize; }
  /// The pages of a table or index, or those of none.
  static std::vector<std::size_t> pages_of(const std::string& owner) {
    std::vector<std::size_t> pages;
    for (std::size_t page = 1; page <= MapDamage::pages(); ++page) {
      const auto found = owners_.find(page);
      if ((found == owners_.end() ? "" : found->second) == owner) pages.push_back(page);
    }
    return pages;
  }

  /// The error of a check that stops at the first damage; it has the one remedy.
  std::string error() const {
    try {
      MapReader(map()).check();
    } catch (const InputError& error) {
      EXPECT_EQ(error.remedy(), kRestoreMap) << error.what();
      EXPECT_THAT(error.where(), HasSubstr("b.fovea"));
      return error.what();
    }
    return "whole";
  }
  /// What a check that goes on reports.
  std::vector<std::string> damages() const {
    std::vector<std::string> damages;
    MapReader(map(), [&](const std::string& damage) { damages.push_back(damage); }).check();
    return damages;
  }
  RepairFigures repair(const std::filesystem::path& output) const {
    RepairFigures figures;
    {
      const auto writer = MapWriter::create(output, true);
      figures = repair_map(map(), *writer, [](const std::string&) {});
    }
    MapReader(output).check();
    return figures;
  }
  /// Repairs, and checks that all rows are there.
  void expect_nothing_lost() const {
    const RepairFigures figures = repair(folder_ / "c.fovea");
    EXPECT_GT(figures.faults, 0u);
    EXPECT_EQ(figures.left_out, 0u);
    EXPECT_EQ(MapReader(folder_ / "c.fovea").digest(), digest_);
  }

  TemporaryFolder folder_;
  static std::string bytes_, digest_;
  static std::size_t points_;
  static std::map<std::size_t, std::string> owners_;  // of pages
};
std::string MapDamage::bytes_, MapDamage::digest_;
std::size_t MapDamage::points_ = 0;
std::map<std::size_t, std::string> MapDamage::owners_;

TEST_F(MapDamage, TheMapHasPagesOfEachKind) {
  write(bytes_);
  EXPECT_EQ(error(), "whole");
  EXPECT_THAT(damages(), IsEmpty());
  EXPECT_GE(pages_of("").size(), 2u);  // free
  EXPECT_GE(pages_of("frames").size(), 5u);
  EXPECT_GE(pages_of("tiles").size(), 20u);
  for (const Table* table : kTables) EXPECT_FALSE(pages_of(table->name).empty()) << table->name;
  EXPECT_EQ(repair(folder_ / "c.fovea").faults, 0u);
  EXPECT_EQ(MapReader(folder_ / "c.fovea").digest(), digest_);
}

TEST_F(MapDamage, AnyDamagedPageIsFoundAndItsTableNamed) {
  for (const Table* table : kTables) {
    for (const std::string& owner :
         {std::string(table->name), fmt::format("sqlite_autoindex_{}_1", table->name)}) {
      for (const std::size_t page : pages_of(owner)) {
        write(with_damaged_page(page));
        EXPECT_NE(error(), "whole") << page << " of " << owner;
        EXPECT_THAT(damages(), Contains(AnyOf(HasSubstr(fmt::format("table '{}'", table->name)),
                                              HasSubstr(table == &kTilesTable ? ", tile " : "?"))))
            << page << " of " << owner;
      }
    }
  }
}

TEST_F(MapDamage, RepairSavesAllPagesButTheDamagedOne) {
  for (const Table* table : kTables) {
    const std::vector<std::size_t> pages = pages_of(table->name);
    const std::size_t page = pages[pages.size() / 2];
    write(with_damaged_page(page));
    const RepairFigures figures = repair(folder_ / "c.fovea");
    EXPECT_GT(figures.left_out, 0u) << table->name;
    const MapReader repaired(folder_ / "c.fovea");
    EXPECT_TRUE(repaired.meta().contains(meta_key::kRepair)) << table->name;
    if (table == &kTilesTable) {
      EXPECT_GT(repaired.size(), points_ / 2);
    } else {
      EXPECT_EQ(repaired.size(), points_) << table->name;
    }
    EXPECT_GE(repaired.frames().size(), table == &kFramesTable ? 40u : 53u) << table->name;
    if (table == &kMetaTable) {
      EXPECT_THAT(figures.lost, Contains("config"));
      EXPECT_THAT(figures.restored, Contains("map.tile_size_m"));
      EXPECT_THAT(repaired.meta().at(meta_key::kRepair), HasSubstr("lost: "));
    }
  }
}

TEST_F(MapDamage, DamagedIndexesAndFreePagesCostNoRow) {
  for (const char* owner : {"sqlite_autoindex_tiles_1", "sqlite_autoindex_keyframes_1", ""}) {
    const std::vector<std::size_t> pages = pages_of(owner);
    // The first free page lists others.
    std::string damaged;
    for (const std::size_t page : pages) {
      write(with_damaged_page(page));
      if (error() != "whole") break;
    }
    EXPECT_NE(error(), "whole") << owner;
    const RepairFigures figures = repair(folder_ / "c.fovea");
    EXPECT_GT(figures.faults, 0u) << owner;
    EXPECT_EQ(MapReader(folder_ / "c.fovea").size(), points_) << owner;
  }
}

TEST_F(MapDamage, ADamagedFirstPageCostsNoRow) {
  for (const auto& [offset, count] : std::map<std::size_t, std::size_t>{{0, 200},
                                                                        {0, 1},
                                                                        {16, 2},
                                                                        {20, 1},
                                                                        {56, 4},
                                                                        {60, 4},
                                                                        {68, 4},
                                                                        {100, 8},
                                                                        {5000, 3000},
                                                                        {0, kPageSize}}) {
    std::string damaged = bytes_;
    for (std::size_t i = 0; i < count; ++i) damaged[offset + i] = static_cast<char>(0x5a ^ i);
    write(damaged);
    EXPECT_THAT(error(), HasSubstr("the first page")) << offset;
    EXPECT_THAT(damages(), ElementsAre(HasSubstr("the first page"))) << offset;
    expect_nothing_lost();
  }
}

TEST_F(MapDamage, AHeaderThatStatesTooFewPagesCostsNoRow) {
  std::string damaged = bytes_;
  damaged[31] = 5;
  write(damaged);
  EXPECT_THAT(error(), HasSubstr("the first page"));
  expect_nothing_lost();
}

TEST_F(MapDamage, ATruncatedFileIsCutShort) {
  for (const std::size_t size :
       {bytes_.size() - 1, bytes_.size() - kPageSize, bytes_.size() / 2, 3 * kPageSize + 17}) {
    write(bytes_.substr(0, size));
    EXPECT_THAT(error(), AllOf(HasSubstr("cut short"),
                               HasSubstr(fmt::format("{} of {} bytes", size, bytes_.size()))));
    EXPECT_THAT(damages(), Contains(HasSubstr("cut short")));
    repair(folder_ / "c.fovea");
  }
}

TEST_F(MapDamage, SwappedPagesAreFound) {
  Random random(5);
  for (int trial = 0; trial < 60; ++trial) {
    const std::size_t a = 2 + random.below(pages() - 1), b = 2 + random.below(pages() - 1);
    if (a == b || !owners_.contains(a) || !owners_.contains(b)) continue;
    std::string swapped = bytes_;
    swapped.replace((a - 1) * kPageSize, kPageSize, bytes_, (b - 1) * kPageSize, kPageSize);
    swapped.replace((b - 1) * kPageSize, kPageSize, bytes_, (a - 1) * kPageSize, kPageSize);
    write(swapped);
    EXPECT_NE(error(), "whole") << a << ' ' << b;
    EXPECT_THAT(damages(), Not(IsEmpty())) << a << ' ' << b;
    if (trial % 10 == 0) repair(folder_ / "c.fovea");
  }
}

/// A page whose cells all refer to one page.
std::string page_of_references(char type, std::uint32_t child, int cells) {
  std::string page(kPageSize, '\0');
  const auto put = [&](std::size_t at, std::uint32_t number, int bytes) {
    for (int i = 0; i < bytes; ++i) {
      page[at + std::size_t(i)] = static_cast<char>(number >> (8 * (bytes - 1 - i)) & 0xff);
    }
  };
  page[0] = type;
  const std::size_t first_cell = kPageSize - 5 * std::size_t(cells);
  put(3, std::uint32_t(cells), 2);
  put(5, std::uint32_t(first_cell), 2);
  put(8, child, 4);
  for (int i = 0; i < cells; ++i) {
    const std::size_t cell = first_cell + 5 * std::size_t(i);
    put(12 + 2 * std::size_t(i), std::uint32_t(cell), 2);
    put(cell, child, 4);
    page[cell + 4] = 10;  // a number of a row
  }
  return page;
}

// 1,000 references each to 1,000 references each to 1,000 references to a leaf.
TEST_F(MapDamage, PagesThatReferToEachOtherDoNotHang) {
  const std::vector<std::size_t> of_frames = pages_of("frames"), of_tiles = pages_of("tiles");
  std::string damaged = bytes_;
  const std::size_t leaf = of_frames.back();
  std::size_t child = leaf;
  for (const std::size_t page : {of_tiles[5], of_tiles[6], of_frames.front()}) {
    constexpr char kInnerPage = 5;
    damaged.replace((page - 1) * kPageSize, kPageSize,
                    page_of_references(kInnerPage, std::uint32_t(child), 1000));
    child = page;
  }
  write(damaged);
  EXPECT_NE(error(), "whole");
  EXPECT_THAT(damages(), Contains(AllOf(HasSubstr("more rows than the file can hold"),
                                        HasSubstr("table 'frames'"))));
}

TEST_F(MapDamage, OtherFilesAreNoMapsWithADamagedFirstPage) {
  for (const std::string& bytes :
       {std::string(bytes_.size(), 'x'), std::string(bytes_.size(), '\0'), std::string("text")}) {
    write(bytes);
    try {
      MapReader(map(), [](const std::string&) {});
      ADD_FAILURE() << "opened";
    } catch (const InputError& error) {
      EXPECT_TRUE(error.problem().ends_with("not a Fovea map")) << error.problem();
    }
  }
}

}  // namespace fovea::map_damage_test
