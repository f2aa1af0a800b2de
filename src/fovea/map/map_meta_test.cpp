#include "fovea/map/map_meta.h"

#include <gtest/gtest.h>

#include "fovea/base/errors.h"

namespace fovea::map_meta_test {

MapMeta georeferenced() {
  return {{"georeferenced", "1"},
          {"origin.latitude", "49.5"},
          {"origin.longitude", "-8.25"},
          {"origin.altitude", "110"}};
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
    EXPECT_FALSE(map_origin(with(georeferenced(), "origin.latitude", text))) << text;
  }
}

TEST(MapMeta, TellsTheSizeOfItsTiles) {
  EXPECT_EQ(map_tile_size({{"map.tile_size", "4"}}), 4);
  EXPECT_THROW(map_tile_size({}), InputError);
  for (const char* text : {"", "four", "0", "-4", "nan", "1000"}) {
    EXPECT_THROW(map_tile_size(with({}, "map.tile_size", text)), InputError) << text;
  }
}

TEST(MapMeta, TellsItsDrives) {
  MapMeta meta = georeferenced();
  EXPECT_TRUE(merged_drives(meta).empty());
  set_merged_drives({{"d1", "one", 0, 5, 0, 0, 2}, {"d2", "two", 5, 9, -3, 2, 4}}, meta);
  const auto drives = merged_drives(meta);
  ASSERT_EQ(drives.size(), 2u);
  EXPECT_EQ(drives[1].digest, "d2");
  EXPECT_EQ(drives[1].name, "two");
  EXPECT_EQ(drives[1].first_frame, 5);
  EXPECT_EQ(drives[1].end_frame, 9);
  EXPECT_EQ(drives[1].frame_shift, -3);
  EXPECT_EQ(drives[1].first_submap, 2);
  EXPECT_EQ(drives[1].end_submap, 4);
  set_merged_drives({drives[0]}, meta);
  EXPECT_EQ(merged_drives(meta).size(), 1u);
  set_merged_drives({}, meta);
  EXPECT_EQ(meta, georeferenced());
}

TEST(MapMeta, DamagedDrivesAreRefused) {
  for (const char* frames : {"", "1 2", "5 2 0", "-1 2 0", "0 1.5 0", "0 1e99 0", "0 x 0"}) {
    MapMeta meta;
    set_merged_drives({{"d1", "one", 0, 5, 0, 0, 2}}, meta);
    EXPECT_THROW(merged_drives(with(meta, "merged.1.frames", frames)), InputError) << frames;
  }
}

}  // namespace fovea::map_meta_test
