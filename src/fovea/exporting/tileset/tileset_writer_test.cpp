#include "fovea/exporting/tileset/tileset_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <sstream>

#include "../../../../tests/file_size_limit.h"
#include "../../../../tests/sample_map.h"
#include "../../../../tests/temporary_folder.h"
#include "fovea/base/errors.h"
#include "fovea/exporting/tileset/glb.h"

namespace fovea {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string content(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.substr(offset, sizeof(T)).data(), sizeof(T));
  return value;
}

// That it is valid glTF and lies where it should is for tests/web to show, by readers of others.
TEST(Glb, QuantisedPositionsAndLinearColours) {
  const std::vector<Eigen::Vector3d> positions = {{10, 20, 30}, {14, 21, 30}, {10, 20, 33}};
  const Glb glb = make_glb(positions, {{0, 128, 255}, {1, 2, 3}, {255, 255, 255}});
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
  const TilesetFigures figures = write({.octree = {.leaf_points = 200}, .sort_points = 300});
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
  write({.octree = {.leaf_points = 100}});
  const auto first = bytes();
  write({.octree = {.leaf_points = 100}, .sort_points = 77, .force = true});
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

}  // namespace
}  // namespace fovea
