#include "fovea/exporting/tileset/tileset_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <limits>

#include "../../../../tests/file_content.h"
#include "../../../../tests/file_size_limit.h"
#include "../../../../tests/sample_map.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/exporting/tileset/glb.h"

namespace fovea::tileset_writer_test {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.substr(offset, sizeof(T)).data(), sizeof(T));
  return value;
}

std::vector<ExportPoint> three_points() {
  std::vector<ExportPoint> points(3);
  points[0].position = {10, 20, 30};
  points[1].position = {14, 21, 30};
  points[2].position = {10, 20, 33};
  points[0].color = {0, 128, 255};
  return points;
}

// That it is valid glTF and lies where it should is for tests/web to show, by readers of others.
TEST(Glb, QuantisedPositionsAndLinearColours) {
  const Glb glb = make_glb(three_points(), /*with_sources=*/false);
  EXPECT_DOUBLE_EQ(glb.step, 4.0 / 65535);
  EXPECT_EQ(at<std::uint32_t>(glb.bytes, 8), glb.bytes.size());
  const std::size_t json = at<std::uint32_t>(glb.bytes, 12), binary = 28 + json;
  EXPECT_EQ(json % 4, 0u);
  EXPECT_EQ(at<std::uint32_t>(glb.bytes, 20 + json), 3 * 16u);
  EXPECT_EQ(at<std::uint16_t>(glb.bytes, binary + 8), 65535);       // x of the second
  EXPECT_EQ(at<std::uint16_t>(glb.bytes, binary + 10), 16384);      // y: a quarter of the edge
  EXPECT_EQ(at<std::uint16_t>(glb.bytes, binary + 16 + 4), 49151);  // z of the third: 3 of 4 m
  EXPECT_EQ(at<std::uint16_t>(glb.bytes, binary + 24), 0);
  EXPECT_EQ(at<std::uint16_t>(glb.bytes, binary + 26), 14146);  // sRGB 128 is 21.6 % of white
  EXPECT_EQ(at<std::uint16_t>(glb.bytes, binary + 28), 65535);
}

TEST(Glb, WhereEachPointComesFrom) {
  std::vector<ExportPoint> points = three_points();
  points[1].frame = 123'456;
  points[1].range = 12.345f;
  points[1].incidence = 0.5f;  // 28.65 degrees
  points[1].camera = 2;
  points[1].reason = 0x12;
  points[1].interpolated = 1;
  points[1].views = 7;
  points[1].spread = 9;
  points[2].range = 1e9f;
  points[2].incidence = std::numeric_limits<float>::quiet_NaN();
  const Glb glb = make_glb(points, /*with_sources=*/true);
  const std::size_t sources = 28 + at<std::uint32_t>(glb.bytes, 12) + 3 * 16;
  EXPECT_EQ(glb.bytes.size(), sources + 3 * 12);
  EXPECT_EQ(at<float>(glb.bytes, sources + 4), 123'456.f);
  EXPECT_EQ(at<std::uint16_t>(glb.bytes, sources + 12 + 4), 1235);  // 12.345 is a little more
  EXPECT_EQ(at<std::uint16_t>(glb.bytes, sources + 12 + 6), 2865);
  EXPECT_EQ(at<std::uint16_t>(glb.bytes, sources + 12 + 8), 65534);
  EXPECT_EQ(at<std::uint16_t>(glb.bytes, sources + 12 + 10), 65535);
  EXPECT_EQ(at<std::uint8_t>(glb.bytes, sources + 24), 255);  // no camera
  const std::size_t second = sources + 24 + 4;
  EXPECT_EQ(at<std::uint8_t>(glb.bytes, second), 2);
  EXPECT_EQ(at<std::uint8_t>(glb.bytes, second + 1), 0x92);
  EXPECT_EQ(at<std::uint8_t>(glb.bytes, second + 2), 7);
  EXPECT_EQ(at<std::uint8_t>(glb.bytes, second + 3), 9);
}

TEST(Glb, NoPointsAnEmptyScene) {
  const Glb glb = make_glb({}, true);
  EXPECT_EQ(at<std::uint32_t>(glb.bytes, 8), glb.bytes.size());
  EXPECT_THAT(glb.bytes, HasSubstr("\"scenes\":[{}]"));
}

class TilesetWriter : public testing::Test {
 protected:
  void SetUp() override { write_sample_map(folder_ / "a.fovea"); }
  TilesetFigures write(const TilesetOptions& options = {}) {
    return write_tileset(MapReader(folder_ / "a.fovea"), folder_ / "a.tiles", options);
  }
  void change(const std::function<void(MapWriter&)>& f) const {
    const auto writer = MapWriter::open(folder_ / "a.fovea");
    f(*writer);
    writer->commit();
  }
  TemporaryFolder folder_;
};

TEST_F(TilesetWriter, AFolderOfTilesOnEarth) {
  const TilesetFigures figures = write({.tree = {.leaf_points = 200}});
  EXPECT_EQ(figures.points, MapReader(folder_ / "a.fovea").colored_size());
  EXPECT_GT(figures.tiles, 10u);
  EXPECT_THAT(folder_.names(), ElementsAre("a.fovea", "a.tiles"));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder_ / "a.tiles/tiles")) {
    EXPECT_EQ(content(entry.path()).substr(0, 4), "glTF");
    ++files;
  }
  EXPECT_EQ(files, figures.tiles);
  const std::string json = content(folder_ / "a.tiles/tileset.json");
  EXPECT_THAT(json, testing::StartsWith("{\"asset\":{\"version\":\"1.1\""));
  EXPECT_THAT(json, HasSubstr("\"transform\":["));
  EXPECT_THAT(json, HasSubstr("\"refine\":\"REPLACE\""));
}

TEST_F(TilesetWriter, AMapWithoutAPlaceOnEarthStaysLocal) {
  change([](MapWriter& writer) { writer.put_meta("georeferenced", "0"); });
  write();
  EXPECT_EQ(content(folder_ / "a.tiles/tileset.json").find("transform"), std::string::npos);
}

TEST_F(TilesetWriter, TheSameMapGivesTheSameBytes) {
  const auto bytes = [&] {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "a.tiles")) {
      if (entry.is_regular_file()) files[entry.path().string()] = content(entry.path());
    }
    return files;
  };
  write({.tree = {.leaf_points = 100}});
  const auto first = bytes();
  write({.tree = {.leaf_points = 100}, .force = true});
  EXPECT_EQ(bytes(), first);
}

TEST_F(TilesetWriter, ReplacesOnlyATilesetAndOnlyWithForce) {
  write();
  EXPECT_THROW(write(), OutputError);
  EXPECT_GT(write({.force = true}).tiles, 0u);
  std::ofstream(folder_ / "a.tiles/notes.txt") << "mine";
  EXPECT_THROW(write({.force = true}), OutputError);
  EXPECT_EQ(content(folder_ / "a.tiles/notes.txt"), "mine");
}

TEST_F(TilesetWriter, LeavesNothingWhenTheDiskIsFull) {
  const MapReader reader(folder_ / "a.fovea");
  const FileSizeLimit limit(10'000);
  EXPECT_THROW(write_tileset(reader, folder_ / "a.tiles"), OutputError);
  EXPECT_THAT(folder_.names(), ElementsAre("a.fovea"));
}

TEST_F(TilesetWriter, AnEmptyMapGivesAnEmptyTileset) {
  MapWriter::create(folder_ / "b.fovea", false)->commit();
  const TilesetFigures figures = write_tileset(MapReader(folder_ / "b.fovea"), folder_ / "b");
  EXPECT_EQ(figures.tiles, 0u);
  EXPECT_EQ(content(folder_ / "b/tileset.json").find("content"), std::string::npos);
}

TEST_F(TilesetWriter, RefusesMapsThatSpanCountries) {
  change([](MapWriter& writer) {
    RigidMotion far = RigidMotion::Identity();
    far.translation().x() = 1e300;
    writer.put_submap(1, far);
  });
  EXPECT_THROW(write(), InputError);
}

}  // namespace fovea::tileset_writer_test
