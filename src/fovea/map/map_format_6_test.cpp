#include "fovea/map/map_format_6.h"

#include <gtest/gtest.h>

#include "fovea/errors.h"

namespace fovea::map_format_6_test {

TEST(MapFormat6, KeysGetTheirNewNames) {
  const MapMeta meta = format_6().meta({{"schema_version", "6"},
                                        {"map.tile_size", "4"},
                                        {"origin.latitude", "49"},
                                        {"origin.longitude", "8"},
                                        {"origin.altitude", "110"},
                                        {"calibration", "corrected"},
                                        {"calibration.camera_2", "0.001 -0.002 0.003 0.0028"},
                                        {"merged.1.name", "first"},
                                        {"config", "[map]"}});
  EXPECT_EQ(meta, (MapMeta{{"format_version", "6"},
                           {"map.tile_size_m", "4"},
                           {"origin.latitude_deg", "49"},
                           {"origin.longitude_deg", "8"},
                           {"origin.height_m", "110"},
                           {"calibration", "corrected"},
                           {"calibration.camera_2.rotation_rad", "0.001 -0.002 0.003"},
                           {"calibration.camera_2.delay_s", "0.0028"},
                           {"config", "[map]"}}));
}

MapMeta merged() {
  return {{"drive.kind", "kitti-raw"}, {"georeferenced", "1"},       {"origin.latitude", "49"},
          {"origin.longitude", "8"},   {"origin.altitude", "110"},   {"merged.1.digest", "d1"},
          {"merged.1.name", "one"},    {"merged.1.frames", "0 5 0"}, {"merged.1.submaps", "0 2"},
          {"merged.2.digest", "d2"},   {"merged.2.name", "two"},     {"merged.2.frames", "5 9 -3"},
          {"merged.2.submaps", "2 4"}};
}

TEST(MapFormat6, DrivesOfAMergedMapComeFromItsMetaData) {
  const std::vector<DriveRecord> drives = format_6().drives(merged());
  ASSERT_EQ(drives.size(), 2u);
  EXPECT_EQ(drives[0].kind, "kitti-raw");
  ASSERT_TRUE(drives[0].origin);
  EXPECT_EQ(drives[0].origin->longitude, 8);
  EXPECT_EQ(drives[1].source_digest, "d2");
  EXPECT_EQ(drives[1].name, "two");
  EXPECT_EQ(drives[1].first_frame, 5);
  EXPECT_EQ(drives[1].end_frame, 9);
  EXPECT_EQ(drives[1].frame_shift, -3);
  EXPECT_FALSE(drives[1].origin);
  EXPECT_EQ(format_6().submap_drives(merged(), 4), (std::vector<int>{0, 0, 1, 1}));
}

TEST(MapFormat6, DamagedDrivesAreRefused) {
  for (const char* frames : {"", "1 2", "5 2 0", "-1 2 0", "0 1.5 0", "0 1e99 0", "0 x 0"}) {
    MapMeta meta = merged();
    meta["merged.2.frames"] = frames;
    EXPECT_THROW(format_6().drives(meta), InputError) << frames;
  }
  EXPECT_THROW(format_6().submap_drives(merged(), 3), InputError);
}

}  // namespace fovea::map_format_6_test
