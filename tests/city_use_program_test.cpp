// fovea localize and fovea evaluate of a city, as a user meets them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "fovea/geometry/pose_file.h"
#include "tests/city_test_support.h"
#include "tests/program.h"

namespace fovea::city_use_program_test {

using testing::HasSubstr;
namespace fs = std::filesystem;

/// A map of a street, with held-out frames, cut into tiles: the city of one map. Another drive
/// passes there later, and a third one is in another place.
class CityUse : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    simulate_street("a", "--frames 40");
    simulate_street("b",
                    "--frames 30 --scene traffic --set drive.pass=1 --set camera.exposure=1.4");
    simulate_street("far", "--frames 4 --set navigation.latitude=49.5");
    succeed(fmt::format("map '{}' -o '{}' --hold-out 10:9 --quiet", file("a"), file("a.fovea")));
    adjust_alone({file("a.fovea")}, file("poses.json"));
    tiles_ = make_city(file("city"), {file("a.fovea")}, file("poses.json"), {-2, -1}, {2, 0}, 48);
  }
  static void TearDownTestSuite() { delete scratch_; }

  static void simulate_street(const std::string& name, const std::string& options) {
    succeed(fmt::format(
        "simulate -o '{}' --format generic --quiet --set camera.numbers=[2] --set camera.width=414 "
        "--set camera.height=125 --set camera.focal=240.5 --set camera.cx=203.2 "
        "--set camera.cy=57.6 {}",
        file(name), options));
  }
  static std::string file(const std::string& name) { return (*scratch_ / name).string(); }
  static void succeed(const std::string& command) {
    const ProgramRun run = run_fovea(command);
    ASSERT_EQ(run.exit_code, 0) << command << "\n" << run.err;
  }
  static nlohmann::json report(const std::string& name) {
    return nlohmann::json::parse(read_text(file(name)));
  }
  static ProgramRun evaluate(const std::string& drive, const std::string& options = "") {
    return run_fovea(fmt::format("evaluate '{}' '{}' {}", file("city"), file(drive), options));
  }

  static TemporaryFolder* scratch_;
  static std::size_t tiles_;
};
TemporaryFolder* CityUse::scratch_ = nullptr;
std::size_t CityUse::tiles_ = 0;

TEST_F(CityUse, HasSeveralTiles) { EXPECT_GE(tiles_, 4u); }

TEST_F(CityUse, ADriveIsLocalizedInTilesAsInTheMap) {
  for (const char* guess : {"navigation", "first"}) {
    const auto localize = [&](const std::string& map, const std::string& output) {
      succeed(fmt::format(
          "localize '{}' '{}' -o '{}' --guess {} --frames 0:25 --truth '{}' --report '{}' --force",
          file("b"), file(map), file(output), guess, file("a"), file(output + ".json")));
    };
    localize("a.fovea", "in_map.txt");
    localize("city", "in_city.txt");
    const nlohmann::json figures = report("in_city.txt.json")["localize"];
    EXPECT_EQ(figures["localized"], 25) << guess;
    EXPECT_LE(figures["truth"]["position_rms_m"], 0.04) << guess;
    EXPECT_LE(figures["truth"]["rotation_rms_deg"], 0.1) << guess;
    const auto in_map = read_poses_with_gaps(file("in_map.txt")),
               in_city = read_poses_with_gaps(file("in_city.txt"));
    ASSERT_EQ(in_map.size(), 25u);  // beyond them the map ends, and little holds a scan
    ASSERT_EQ(in_city.size(), 25u);
    double squared = 0;
    for (std::size_t i = 0; i < in_map.size(); ++i) {
      if (!in_map[i] || !in_city[i]) continue;
      // The origins of the local frames differ: the motions must not. Other points stay when
      // they are thinned.
      const RigidMotion difference = (in_map.front()->inverse() * *in_map[i]).inverse() *
                                     (in_city.front()->inverse() * *in_city[i]);
      EXPECT_LT(difference.translation().norm(), 0.01) << guess << " " << i;
      EXPECT_LT(rotation_angle(difference.linear()), 0.0005) << guess << " " << i;
      squared += difference.translation().squaredNorm();
    }
    EXPECT_LT(std::sqrt(squared / 25), 0.004) << guess;
  }
}

TEST_F(CityUse, ADriveIsEvaluatedInTilesAsInTheMap) {
  for (const char* protocol : {"held-out", "in-sample", "truth"}) {
    succeed(fmt::format("evaluate '{}' '{}' --protocol {} --json '{}'", file("a.fovea"), file("a"),
                        protocol, file("in_map.json")));
    const ProgramRun run =
        evaluate("a", fmt::format("--protocol {} --json '{}'", protocol, file("in_city.json")));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const nlohmann::json map = report("in_map.json"), city = report("in_city.json");
    if (std::string(protocol) == "truth") {
      EXPECT_NEAR(city["accuracy_mean"], map["accuracy_mean"], 0.0005) << city;
      continue;
    }
    EXPECT_EQ(city["frames_scored"], map["frames_scored"]);
    EXPECT_EQ(city["map_points"], map["map_points"]);
    for (const char* figure : {"me_mean", "te_mean", "te_gain_mean"}) {
      const double expected = map[figure];
      EXPECT_NEAR(city[figure], expected, 0.0005 + 0.01 * expected) << figure;
    }
  }
}

TEST_F(CityUse, AnOlderManifestIsACityToo) {
  fs::create_directories(file("city/manifests"));
  fs::copy_file(file("city/city.json"), file("city/manifests/1.json"),
                fs::copy_options::overwrite_existing);
  succeed(fmt::format("localize '{}' '{}' -o '{}' --frames 0:3 --quiet", file("b"),
                      file("city/manifests/1.json"), file("older.txt")));
}

TEST_F(CityUse, RefusesWhatIsNotThere) {
  const auto localize = [&](const std::string& drive, const std::string& city,
                            const std::string& options = "") {
    return run_fovea(fmt::format("localize '{}' '{}' -o '{}' {}", file(drive), file(city),
                                 file("none.txt"), options))
        .err;
  };
  EXPECT_THAT(localize("far", "city"), HasSubstr("the drive lies outside the map"));
  EXPECT_THAT(localize("b", "city", "--truth '" + file("b") + "'"),
              HasSubstr("the city was not made of the drive 'b'"));
  EXPECT_FALSE(fs::exists(file("none.txt")));
  EXPECT_THAT(evaluate("b").err, HasSubstr("the city was not made of the drive 'b'"));
  EXPECT_THAT(evaluate("far").err, HasSubstr("the drive 'far' lies outside of the city"));
  EXPECT_THAT(evaluate("a", "--poses x.txt").err, HasSubstr("a city has poses of its own"));
  EXPECT_THAT(evaluate("a", "--protocol in-sample-nav").err,
              HasSubstr("a city has no navigation poses"));
}

TEST_F(CityUse, ADamagedTileIsNamed) {
  fs::copy(file("city"), file("damaged"), fs::copy_options::recursive);
  for (const auto& entry : fs::directory_iterator(file("damaged/tiles"))) {
    fs::permissions(entry.path(), fs::perms::owner_write, fs::perm_options::add);
    fs::resize_file(entry.path(), entry.file_size() / 2);
  }
  for (const std::string& command :
       {fmt::format("localize '{}' '{}' -o '{}'", file("b"), file("damaged"), file("none.txt")),
        fmt::format("evaluate '{}' '{}'", file("damaged"), file("a"))}) {
    const ProgramRun run = run_fovea(command);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr("damaged/tiles/"));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
}

}  // namespace fovea::city_use_program_test
