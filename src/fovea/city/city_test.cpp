#include "fovea/city/city.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

#include "../../../tests/sample_city.h"
#include "fovea/city/json_file_test_support.h"

namespace fovea::city_test {

using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

const std::vector<CityTile> kTiles{{1, -1}, {0, 0}, {-2, 3}};

class Manifest : public JsonFileTest {
 protected:
  Manifest()
      : JsonFileTest(
            "city.json", "manifest of a city", "fovea.city build",
            [](const Path& path) { write_sample_city(path.parent_path(), kTiles, 50); },
            [](const Path& path) { open_city(path); }) {}

  void put(const Json& json) const { write(json.dump()); }
  /// The error for the manifest as it is.
  std::string error() const {
    try {
      open_city(path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(Manifest, StatesWhatTheCityHas) {
  for (const fs::path& path :
       {path_, path_.parent_path(), path_.parent_path() / "manifests/1.json"}) {
    ASSERT_TRUE(is_city(path));
    const City city = open_city(path);
    EXPECT_EQ(city.revision, 1);
    EXPECT_EQ(city.origin.latitude, kSampleCityOrigin.latitude);
    EXPECT_EQ(city.tile_size, 64);
    EXPECT_EQ(city.points(), 150u);
    EXPECT_EQ(city.extent(), (std::array<double, 2>{4 * 64.0, 5 * 64.0}));
    ASSERT_EQ(city.drives.size(), 1u);
    EXPECT_EQ(city.drives[0].length, 120.5);
    ASSERT_EQ(city.tiles.size(), 3u);
    EXPECT_EQ(city.tiles[0].tile, (CityTile{-2, 3}));
    EXPECT_EQ(city.tiles[2].tile, (CityTile{1, -1}));
    EXPECT_TRUE(fs::equivalent(city.tiles[2].map, folder_ / "tiles/1_-1_0.fovea"));
  }
}

TEST_F(Manifest, AnOlderOneOpensWithItsTiles) {
  Json next = json_;
  next["revision"] = 2;
  next["tiles"].erase(0);
  write_sample_manifest(path_.parent_path(), next);
  EXPECT_EQ(open_city(path_).tiles.size(), 2u);
  EXPECT_EQ(open_city(folder_ / "manifests/1.json").tiles.size(), 3u);
}

TEST_F(Manifest, WithoutTilesIsWhole) {
  json_["tiles"] = Json::array();
  put(json_);
  EXPECT_TRUE(open_city(path_).tiles.empty());
  EXPECT_EQ(open_city(path_).extent()[0], 0);
}

TEST_F(Manifest, TruncatedOnesAreDamaged) {
  const std::string whole = text();
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, whole.size() / 3, whole.rfind('}')})
    expect_damaged(whole.substr(0, size));
}

TEST_F(Manifest, EachValueIsNeededAndOfItsKind) {
  for (const std::string place : {"", "/origin", "/drives/0", "/tiles/0"}) {
    const Json object = json_[Json::json_pointer(place)];
    for (const auto& item : object.items()) {
      if (item.key() == "bytes") continue;  // for people
      SCOPED_TRACE(place + "/" + item.key());
      Json json = json_;
      json[Json::json_pointer(place)].erase(item.key());
      expect_damaged(json.dump());
      expect_damaged_with(place + "/" + item.key(), nullptr);
    }
  }
}

TEST_F(Manifest, ImpossibleValuesAreRefused) {
  expect_damaged_with("/fovea_city", 2);
  expect_damaged_with("/revision", -1);
  expect_damaged_with("/revision", 1e12);
  expect_damaged_with("/tile_size_m", 0);
  expect_damaged_with("/tile_size_m", 1e9);
  expect_damaged_with("/origin/latitude_deg", 91);
  expect_damaged_with("/tiles/0/file", "../other/tile.fovea");
  expect_damaged_with("/tiles/0/file", "/etc/passwd");
  expect_damaged_with("/drives/0/length_m", -5.0);
  expect_damaged_with("/tiles/0/points", -5);
  expect_damaged_with("/tiles/0/x", 1.5);
  expect_damaged_with("/tiles", 5);
}

TEST_F(Manifest, ATileLiesWithin1000KilometersOfTheOrigin) {
  // Nothing of the grid is so far away: the pose of such a tile would not be finite.
  expect_damaged_with("/tiles/0/x", 1 << 30);
  expect_damaged_with("/tiles/0/y", -(1 << 30));
  // As a signed number it would be -5.
  expect_damaged_with("/tiles/0/y", std::numeric_limits<std::uint64_t>::max() - 4);
}

TEST_F(Manifest, NamesATileThatIsTwiceOrMissing) {
  Json twice = json_;
  twice["tiles"].push_back(twice["tiles"][0]);
  put(twice);
  EXPECT_THAT(error(), HasSubstr("tile 1,-1 is listed twice"));
  put(json_);
  fs::remove(folder_ / "tiles/0_0_0.fovea");
  EXPECT_THAT(error(), HasSubstr("the map of tile 0,0 is missing"));
}

TEST(IsCity, NotAMapNorAnotherFile) {
  const TemporaryFolder folder;
  write_sample_tile(folder / "a.fovea", {0, 0}, 64, 5);
  EXPECT_FALSE(is_city(folder / "a.fovea"));
  EXPECT_FALSE(is_city(folder / "none"));
  try {
    open_city(folder / "");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the folder is no city: it has no city.json"));
  }
}

TEST(CityDigest, CountsPlacesAndPointsAlone) {
  const TemporaryFolder folder;
  const auto manifest = write_sample_city(folder / "a", kTiles, 50);
  const std::string digest = city_digest(open_city(folder / "a"));
  EXPECT_EQ(digest.size(), 32u);
  write_sample_city(folder / "b", {{-2, 3}, {1, -1}, {0, 0}}, 50);
  auto other = manifest;
  other["revision"] = 7;
  other["session"] = "latest";
  fs::rename(folder / "b/tiles/0_0_0.fovea", folder / "b/tiles/other.fovea");
  other["tiles"][1]["file"] = "tiles/other.fovea";
  write_sample_manifest(folder / "b", other);
  EXPECT_EQ(city_digest(open_city(folder / "b")), digest);
  write_sample_tile(folder / "b/tiles/other.fovea", {0, 0}, 64, 51);
  EXPECT_NE(city_digest(open_city(folder / "b")), digest);
  other = manifest;
  other["tiles"][1]["x"] = 9;
  write_sample_manifest(folder / "a", other);
  EXPECT_NE(city_digest(open_city(folder / "a")), digest);
}

TEST(CityTiles, LieInTheGridAndAreFoundAroundAPlace) {
  const TemporaryFolder folder;
  write_sample_city(folder / "a", kTiles, 5);
  const City city = open_city(folder / "a");
  const RigidMotion T_local_tile = city.T_local_tile({1, -1});
  EXPECT_NEAR(T_local_tile.translation().x(), 96, 1e-2);
  EXPECT_NEAR(T_local_tile.translation().y(), -32, 1e-2);
  EXPECT_THAT(city.tiles_near({32, 32, 5}, 1), ElementsAre(1u));
  EXPECT_THAT(city.tiles_near({60, 5, 0}, 10), ElementsAre(1u, 2u));
  EXPECT_THAT(city.tiles_near({60, 5, 0}, 1000), ElementsAre(0u, 1u, 2u));
  EXPECT_TRUE(city.tiles_near({1000, 5, 0}, 10).empty());
}

TEST(CityTiles, TheOverviewLiesNextToTheMap) {
  EXPECT_EQ(overview_of_tile("a/tiles/0_-1_ab.fovea"), "a/tiles/0_-1_ab.overview.glb");
}

}  // namespace fovea::city_test
