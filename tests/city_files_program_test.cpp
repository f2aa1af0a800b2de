// info, view and export of a city as a user calls them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/background_program.h"
#include "tests/program.h"
#include "tests/sample_city.h"

namespace fovea::city_files_program_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::UnorderedElementsAre;
namespace fs = std::filesystem;

class CityFiles : public testing::Test {
 protected:
  void SetUp() override {
    manifest_ = write_sample_city(folder_ / "city", {{0, 0}, {1, 0}, {0, -1}});
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  ProgramRun run(const std::string& command, const std::string& options = "",
                 const std::string& city = "city") const {
    return run_fovea(fmt::format("{} '{}' {}", command, path(city), options));
  }
  /// The bytes of all files below a folder, by their place in it.
  std::map<std::string, std::string> bytes_below(const std::string& name) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / name)) {
      if (!entry.is_regular_file()) continue;
      files[fs::relative(entry.path(), folder_ / name).string()] = read_text(entry.path());
    }
    return files;
  }
  std::vector<std::string> names_in(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / name)) {
      names.push_back(entry.path().filename().string());
    }
    return names;
  }

  TemporaryFolder folder_;
  nlohmann::ordered_json manifest_;
};

TEST_F(CityFiles, InfoDescribesIt) {
  const ProgramRun text = run("info");
  EXPECT_EQ(text.exit_code, 0) << text.err;
  EXPECT_THAT(text.out, AllOf(HasSubstr("city, revision 1"), HasSubstr("a: 8 frames, 120.5 m"),
                              HasSubstr("3 of 64 m"), HasSubstr("2 x 2 tiles, 128 x 128 m"),
                              HasSubstr("changed in revision 1: 0,-1  0,0  1,0")));
  const auto json = nlohmann::json::parse(run("info", "--json").out);
  EXPECT_EQ(json.at("points"), 9000);
  EXPECT_EQ(json.at("extent_tiles"), nlohmann::json({2, 2}));
  EXPECT_EQ(json.at("tiles").at(0).at("y"), -1);
  EXPECT_EQ(json.at("drives").at(0).at("length_m"), 120.5);
}

TEST_F(CityFiles, InfoChecksAllTilesAndNamesThoseThatAreDamaged) {
  EXPECT_THAT(run("info", "--check").out, HasSubstr("whole, 3 tiles"));
  damage_sample_tile(folder_ / "city/tiles/1_0_0.fovea");
  std::ofstream(folder_ / "city/tiles/0_-1_0.fovea") << "no map";
  const ProgramRun damaged = run("info", "--check");
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_THAT(damaged.out, AllOf(HasSubstr("tile 1,0: "), HasSubstr("tile 0,-1: ")));
  EXPECT_THAT(damaged.out, testing::Not(HasSubstr("tile 0,0: ")));
  EXPECT_THAT(damaged.err, HasSubstr("2 of 3 tiles are damaged"));
}

TEST_F(CityFiles, AnOlderManifestOpens) {
  auto next = manifest_;
  next["revision"] = 2;
  next["tiles"].erase(1);
  write_sample_manifest(folder_ / "city", next);
  EXPECT_THAT(run("info").out, HasSubstr("2 of 64 m"));
  EXPECT_THAT(run("info", "", "city/manifests/1.json").out, HasSubstr("3 of 64 m"));
  const ProgramRun exported =
      run("export", "'" + path("las") + "' --format las", "city/manifests/1.json");
  EXPECT_EQ(exported.exit_code, 0) << exported.err;
  EXPECT_THAT(names_in("las"), UnorderedElementsAre("0_0.las", "1_0.las", "0_-1.las"));
  EXPECT_NE(run("info", "--digest").out, run("info", "--digest", "city/manifests/1.json").out);
}

TEST_F(CityFiles, ExportsATilesetInOneGoOrByJobs) {
  const ProgramRun whole = run("export", "'" + path("whole") + "' --format 3dtiles");
  ASSERT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_THAT(whole.out, HasSubstr("tile 1,0: "));
  fs::create_directories(folder_ / "jobs");
  for (const std::string tile : {"0_0", "1_0", "0_-1"}) {
    const ProgramRun part =
        run_fovea(fmt::format("export '{}' '{}' --format 3dtiles --exposure map",
                              path("city/tiles/" + tile + "_0.fovea"), path("jobs/" + tile)));
    ASSERT_EQ(part.exit_code, 0) << part.err;
  }
  const std::string root_only = "'" + path("jobs") + "' --format 3dtiles --root-only";
  const ProgramRun root = run("export", root_only);
  ASSERT_EQ(root.exit_code, 0) << root.err;
  EXPECT_EQ(bytes_below("jobs"), bytes_below("whole"));
  EXPECT_THAT(run("export", root_only).err, HasSubstr("--force"));
  EXPECT_EQ(run("export", root_only + " --force").exit_code, 0);
  EXPECT_EQ(bytes_below("jobs"), bytes_below("whole"));
  fs::remove_all(folder_ / "jobs/1_0");
  EXPECT_THAT(run("export", root_only + " --force").err,
              HasSubstr("the part of tile 1,0 is missing"));
}

TEST_F(CityFiles, AKilledExportOfTheRootLeavesAWholeTileset) {
  ASSERT_EQ(run("export", "'" + path("out") + "' --format 3dtiles").exit_code, 0);
  auto next = manifest_;
  next["revision"] = 2;
  next["tiles"].erase(1);
  write_sample_manifest(folder_ / "city", next);
  const std::string options = "'" + path("out") + "' --format 3dtiles --root-only --force";
  const auto points_of = [&](const std::string& tileset) {
    const auto root = nlohmann::json::parse(tileset).at("root");
    return read_text(folder_ / "out" / root.at("content").at("uri").get<std::string>());
  };
  std::map<std::string, std::string> points;  // of the root, by the tileset of a revision
  for (const char* revision : {"city/manifests/1.json", "city/manifests/2.json"}) {
    ASSERT_EQ(run("export", options, revision).exit_code, 0);
    const std::string tileset = read_text(folder_ / "out/tileset.json");
    points[tileset] = points_of(tileset);
  }
  ASSERT_EQ(points.size(), 2u);
  for (int i = 0; i < 40; ++i) {
    const std::string revision = path(fmt::format("city/manifests/{}.json", 1 + i % 2));
    run_fovea(fmt::format("export '{}' {}", revision, options),
              fmt::format("timeout -s KILL {:.3f}", 0.001 * (1 + i)));
    const std::string tileset = read_text(folder_ / "out/tileset.json");
    ASSERT_TRUE(points.contains(tileset)) << "after " << i << " ms";
    ASSERT_EQ(points_of(tileset), points[tileset]) << "after " << i << " ms";
  }
  EXPECT_EQ(run("export", options).exit_code, 0);
  EXPECT_THAT(names_in("out"), UnorderedElementsAre("tileset.json", "q", "0_0", "1_0", "0_-1"));
  EXPECT_EQ(names_in("out/q").size(), 1u);
}

TEST_F(CityFiles, ExportReplacesOnlyAnExportAndOnlyWithForce) {
  const std::string options = "'" + path("out") + "' --format ply --quiet";
  ASSERT_EQ(run("export", options).exit_code, 0);
  EXPECT_THAT(names_in("out"), UnorderedElementsAre("0_0.ply", "1_0.ply", "0_-1.ply"));
  EXPECT_THAT(run("export", options).err, HasSubstr("--force"));
  EXPECT_EQ(run("export", options + " --force").exit_code, 0);
  std::ofstream(folder_ / "out/notes.txt") << "mine";
  EXPECT_EQ(run("export", options + " --force").exit_code, 1);
  EXPECT_EQ(read_text(folder_ / "out/notes.txt"), "mine");
}

TEST_F(CityFiles, OrthophotosOfTilesFitTogether) {
  const std::string options = "'" + path("out") + "' --format orthophoto --pixel 0.5";
  ASSERT_EQ(run("export", options).exit_code, 0);
  EXPECT_THAT(names_in("out"),
              UnorderedElementsAre("0_0.png", "0_0.pgw", "0_0.png.aux.xml", "1_0.png", "1_0.pgw",
                                   "1_0.png.aux.xml", "0_-1.png", "0_-1.pgw", "0_-1.png.aux.xml"));
  for (const char* tile : {"0_0", "1_0", "0_-1"}) {
    std::istringstream lines(read_text(folder_ / "out" / (std::string(tile) + ".pgw")));
    double number = 0;
    for (int i = 0; i < 4; ++i) lines >> number;
    for (int axis = 0; axis < 2; ++axis) {
      lines >> number;  // a center
      EXPECT_NEAR(std::remainder(number - 0.25, 0.5), 0, 1e-6) << tile;
    }
  }
  EXPECT_THAT(run("export", options).err, HasSubstr("--force"));
  EXPECT_EQ(run("export", options + " --force").exit_code, 0);
  // Tiles without chosen points have no picture.
  EXPECT_EQ(run("export", options + " --force --where 'frame > 1e6'").exit_code, 0);
  EXPECT_THAT(names_in("out"), testing::IsEmpty());
}

TEST_F(CityFiles, OptionsOfExportAreForAllTiles) {
  const auto export_error = [&](const std::string& options) {
    const ProgramRun result = run("export", "'" + path("out") + "' " + options);
    EXPECT_NE(result.exit_code, 0) << options;
    EXPECT_FALSE(fs::exists(folder_ / "out")) << options;
    return result.err;
  };
  EXPECT_THAT(export_error(""), HasSubstr("--format"));
  EXPECT_THAT(export_error("--format mesh"), HasSubstr("a city has no export"));
  EXPECT_THAT(export_error("--format las --crs local"), HasSubstr("local frame of its own"));
  EXPECT_THAT(export_error("--format las --exposure frame:1"), HasSubstr("no common numbers"));
  EXPECT_THAT(export_error("--format las --root-only"), HasSubstr("--root-only"));
  EXPECT_THAT(export_error("--format 3dtiles --root-only --uncolored"), HasSubstr("--uncolored"));
  const ProgramRun some =
      run("export", "'" + path("out") + "' --format pcd --crs ecef --where 'range < 9'");
  EXPECT_EQ(some.exit_code, 0) << some.err;
  EXPECT_THAT(some.out, HasSubstr("points that do not meet --where"));
}

TEST_F(CityFiles, ExportEndsAtADamagedTile) {
  damage_sample_tile(folder_ / "city/tiles/1_0_0.fovea");
  const ProgramRun result = run("export", "'" + path("out") + "' --format 3dtiles");
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("1_0_0.fovea"));
  EXPECT_FALSE(fs::exists(folder_ / "out"));
}

TEST_F(CityFiles, BadCitiesAreOneClearLine) {
  const auto error = [&](const std::string& command, const std::string& options = "") {
    const ProgramRun result = run(command, options);
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    return result.err;
  };
  const auto expect_errors = [&](const char* text) {
    EXPECT_THAT(error("info"), HasSubstr(text));
    EXPECT_THAT(error("view", "--no-browser --port 0"), HasSubstr(text));
    EXPECT_THAT(error("export", "'" + path("out") + "' --format las"), HasSubstr(text));
  };
  auto other = manifest_;
  other["fovea_city"] = 2;
  write_sample_manifest(folder_ / "city", other);
  expect_errors("another version");
  std::ofstream(folder_ / "city/city.json") << manifest_.dump().substr(0, 100);
  expect_errors("the manifest of a city is damaged");
  write_sample_manifest(folder_ / "city", manifest_);
  fs::remove(folder_ / "city/tiles/1_0_0.fovea");
  expect_errors("the map of tile 1,0 is missing");
  fs::remove(folder_ / "city/city.json");
  expect_errors("the folder is no city");
}

TEST_F(CityFiles, ACityWithoutTilesIsEmpty) {
  manifest_["tiles"] = nlohmann::ordered_json::array();
  write_sample_manifest(folder_ / "city", manifest_);
  EXPECT_THAT(run("info").out, HasSubstr("0 of 64 m"));
  EXPECT_THAT(run("info", "--check").out, HasSubstr("whole, 0 tiles"));
  EXPECT_EQ(run("info", "--json").exit_code, 0);
  EXPECT_EQ(run("export", "'" + path("out") + "' --format 3dtiles").exit_code, 0);
  EXPECT_THAT(names_in("out"), UnorderedElementsAre("tileset.json", "q"));
}

TEST_F(CityFiles, ViewTellsWhatIsNotForCities) {
  EXPECT_THAT(run("view", "--drive x --no-browser").err, HasSubstr("a city has many drives"));
  EXPECT_THAT(run("view", "--exposure frame:3 --no-browser").err, HasSubstr("no common numbers"));
}

}  // namespace fovea::city_files_program_test
