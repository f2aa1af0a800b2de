#include "fovea/export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../../tests/file_content.h"
#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map.h"

namespace fovea::api_export_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

class ExportTest : public testing::Test {
 protected:
  ExportTest() { write_sample_map(map()); }
  std::filesystem::path map() const { return folder_ / "a.fovea"; }

  TemporaryFolder folder_;
};

TEST_F(ExportTest, AnOrthophotoOfAMapOnEarthIsInUtm) {
  const ExportedMap exported = export_map(map(), folder_ / "a.png", {.pixel = 0.5});
  EXPECT_GT(exported.points, 1000u);
  EXPECT_GT(exported.width, 40);
  EXPECT_GT(exported.height, 40);
  EXPECT_THAT(content(folder_ / "a.png.aux.xml"), HasSubstr("UTM zone 32N"));
  export_map(map(), folder_ / "b.png", {.crs = "local", .pixel = 0.5});
  EXPECT_THAT(content(folder_ / "b.png.aux.xml"), HasSubstr("LOCAL_CS"));
}

TEST_F(ExportTest, RefusesPixelsThatMakeNoPicture) {
  EXPECT_THAT([&] { export_map(map(), folder_ / "a.png", {.pixel = 0}); },
              ThrowsMessage<ConfigError>(HasSubstr("pixel")));
  EXPECT_THAT([&] { export_map(map(), folder_ / "a.png", {.pixel = 1e-6}); },
              ThrowsMessage<ConfigError>(HasSubstr("or more")));
}

TEST_F(ExportTest, ChoosesTheSamePointsAsAMapThatIsRead) {
  const std::string where = "x > 10 and y < 30 and camera >= 0 and height < 4";
  const ExportedMap exported = export_map(map(), folder_ / "a.ply", {.where = where});
  EXPECT_EQ(exported.points, Map(map()).points({.where = where}).size());
  EXPECT_GT(exported.points, 0u);
  EXPECT_GT(exported.filtered_out, 0u);
}

TEST_F(ExportTest, RefusesWhatAModelOfColmapCannotHave) {
  const std::filesystem::path out = folder_ / "model";
  EXPECT_THAT([&] { export_map(map(), out, {.format = "colmap", .crs = "utm"}); },
              ThrowsMessage<ConfigError>(HasSubstr("local")));
  EXPECT_THAT([&] { export_map(map(), out, {.format = "nerf", .max_points = 1}); },
              ThrowsMessage<ConfigError>(HasSubstr("max_points")));
  EXPECT_THAT([&] { export_map(map(), out, {.format = "nerf", .voxel = 0}); },
              ThrowsMessage<ConfigError>(HasSubstr("voxel")));
  // The sample states no cameras.
  EXPECT_THAT([&] { export_map(map(), out, {.format = "colmap"}); },
              ThrowsMessage<InputError>(HasSubstr("--drive")));
  EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace fovea::api_export_test
