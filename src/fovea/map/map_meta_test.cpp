#include "fovea/map/map_meta.h"

#include <gtest/gtest.h>

#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"

namespace fovea::map_meta_test {

MapMeta georeferenced() {
  return {{"georeferenced", "1"},
          {"origin.latitude_deg", "49.5"},
          {"origin.longitude_deg", "-8.25"},
          {"origin.height_m", "110"}};
}

MapMeta with(MapMeta meta, const std::string& key, const std::string& text) {
  meta[key] = text;
  return meta;
}

TEST(MapMeta, TellsWhereLocalBegins) {
  const auto origin = map_origin(georeferenced());
  ASSERT_TRUE(origin);
  EXPECT_EQ(origin->latitude, 49.5);
  EXPECT_EQ(origin->longitude, -8.25);
  EXPECT_EQ(origin->altitude, 110);
  EXPECT_FALSE(map_origin(with(georeferenced(), "georeferenced", "0")));
  for (const char* text : {"", "north", "49 50", "49\nproperty", "nan"}) {
    EXPECT_FALSE(map_origin(with(georeferenced(), "origin.latitude_deg", text))) << text;
  }
}

TEST(MapMeta, TellsTheSizeOfItsTiles) {
  EXPECT_EQ(map_tile_size({{"map.tile_size_m", "4"}}), 4);
  EXPECT_THROW(map_tile_size({}), InputError);
  for (const char* text : {"", "four", "0", "-4", "nan", "1000"}) {
    EXPECT_THROW(map_tile_size(with({}, "map.tile_size_m", text)), InputError) << text;
  }
}

DriveRecord merged_drive(const std::string& digest, int first_frame, int end_frame) {
  DriveRecord drive;
  drive.name = "drive " + digest;
  drive.source_digest = digest;
  drive.first_frame = first_frame;
  drive.end_frame = end_frame;
  drive.frame_shift = first_frame - 8;
  return drive;
}

/// A map of drives, with a submap of each of these drives.
std::vector<MergedDrive> read_back(const std::vector<DriveRecord>& drives,
                                   const std::vector<int>& drive_of_submap) {
  const TemporaryFolder folder;
  const auto writer = MapWriter::create(folder / "a.fovea", false);
  for (std::size_t id = 0; id < drives.size(); ++id) writer->put_drive(id, drives[id]);
  for (std::size_t id = 0; id < drive_of_submap.size(); ++id) {
    SubmapRecord submap;
    submap.drive = drive_of_submap[id];
    writer->put_submap(id, submap);
  }
  writer->commit();
  return merged_drives(MapReader(folder / "a.fovea"));
}

TEST(MapMeta, NamesTheDrivesOfAMergedMap) {
  const auto drives =
      read_back({merged_drive("d1", 0, 5), merged_drive("d2", 5, 9)}, {0, 0, 1, 1, 1});
  ASSERT_EQ(drives.size(), 2u);
  EXPECT_EQ(drives[1].digest, "d2");
  EXPECT_EQ(drives[1].name, "drive d2");
  EXPECT_EQ(drives[1].first_frame, 5);
  EXPECT_EQ(drives[1].end_frame, 9);
  EXPECT_EQ(drives[1].frame_shift, -3);
  EXPECT_EQ(drives[0].end_submap, 2);
  EXPECT_EQ(drives[1].first_submap, 2);
  EXPECT_EQ(drives[1].end_submap, 5);
}

TEST(MapMeta, AMapOfOneDriveIsNotMerged) {
  DriveRecord drive = merged_drive("d1", 0, 5);
  drive.source_digest.reset();
  EXPECT_TRUE(read_back({drive}, {0, 0}).empty());
  EXPECT_TRUE(read_back({}, {0}).empty());
}

TEST(MapMeta, SubmapsOutOfTheOrderOfDrivesAreRefused) {
  const std::vector<DriveRecord> drives{merged_drive("d1", 0, 5), merged_drive("d2", 5, 9)};
  EXPECT_THROW(read_back(drives, {1, 0}), InputError);
  EXPECT_THROW(read_back(drives, {0, 1, 2}), InputError);
  DriveRecord own = drives[1];
  own.source_digest.reset();
  EXPECT_THROW(read_back({drives[0], own}, {0, 1}), InputError);
}

}  // namespace fovea::map_meta_test
