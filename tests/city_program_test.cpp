// fovea align and fovea adjust as a user meets them: drives that cross in a simulated town.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/drive/drive_truth.h"
#include "fovea/map/map_store.h"
#include "fovea/simulation/simulate.h"
#include "tests/program.h"

namespace fovea::city_program_test {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

/// Three short drives: east over crossing 1,0; north over it, with navigation some 15 m off; and
/// one in another part of the town.
class CityProgram : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    make("east", "0,0 2,0", 35, 1, 0.4);
    make("north", "1,0 1,3", 0, 2, 15);
    make("far", "3,3 3,1", 0, 3, 0.4);
  }
  static void TearDownTestSuite() { delete scratch_; }

  static void make(const std::string& name, const std::string& route, double begin, int day,
                   double navigation_bias) {
    SimulationOptions options = simulation_options(Scene::kTown, "default");
    options.seed = 7;
    options.pass = day;
    options.frames = 45;
    options.format = DriveFormat::kGeneric;
    options.town.route = route;
    options.town.begin = begin;
    options.navigation.position_bias = navigation_bias;
    options.camera.cameras = {kitti_camera(2)};
    options.camera.width = 128;
    options.camera.height = 40;
    options.camera.focal = 74;
    options.camera.cx = 63;
    options.camera.cy = 18;
    simulate(options, *scratch_ / name);
    const ProgramRun run =
        run_fovea(fmt::format("map '{}' -o '{}' --quiet", file(name), file(name + ".fovea")));
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
  static std::string file(const std::string& name) { return (*scratch_ / name).string(); }
  std::string own(const std::string& name) const { return (own_ / name).string(); }

  ProgramRun align(const std::string& a, const std::string& b, const std::string& options) const {
    return run_fovea(
        fmt::format("align '{}' '{}' {}", file(a + ".fovea"), file(b + ".fovea"), options));
  }

  static TemporaryFolder* scratch_;
  TemporaryFolder own_;
};
TemporaryFolder* CityProgram::scratch_ = nullptr;

RigidMotion motion_of(const nlohmann::json& json) {
  const auto t = json.at("translation").get<std::vector<double>>();
  const auto R = json.at("rotation").get<std::vector<double>>();
  RigidMotion T = RigidMotion::Identity();
  T.linear() = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.data());
  T.translation() << t[0], t[1], t[2];
  return T;
}

/// Poses of the frames of a map, as adjusted, in earth-centered coordinates.
std::vector<RigidMotion> adjusted(const nlohmann::json& poses, const std::string& map_file) {
  const MapReader map(map_file);
  const std::vector<RigidMotion> T_local_submap = map.submaps();
  std::vector<RigidMotion> T_ecef_lidar;
  for (const auto& placed : poses.at("maps")) {
    if (placed.at("identity") != map.identity()) continue;
    for (const FrameRecord& frame : map.frames()) {
      const auto id = static_cast<std::size_t>(frame.submap);
      T_ecef_lidar.push_back(motion_of(placed.at("submaps").at(id).at("T_ecef_submap")) *
                             T_local_submap.at(id).inverse() * frame.T_local_lidar);
    }
  }
  return T_ecef_lidar;
}

TEST_F(CityProgram, DrivesThatCrossLieRightToEachOther) {
  const ProgramRun aligned = align("east", "north", "-o '" + own("pair.json") + "' --threads 1");
  ASSERT_EQ(aligned.exit_code, 0) << aligned.err;
  EXPECT_THAT(aligned.out, HasSubstr("pairs of submaps match"));
  EXPECT_THAT(align("east", "north", "-o '" + own("pair.json") + "'").err, HasSubstr("--force"));
  EXPECT_EQ(align("east", "north", "-o '" + own("again.json") + "' --threads 2").exit_code, 0);
  EXPECT_EQ(read_text(own("pair.json")), read_text(own("again.json")));

  const std::string adjust = fmt::format("adjust '{}' '{}' '{}' -o '{}'", file("east.fovea"),
                                         file("north.fovea"), own("pair.json"), own("poses.json"));
  const ProgramRun run = run_fovea(adjust);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("2 maps"));
  EXPECT_THAT(run.err, Not(HasSubstr("warning")));
  const auto poses = nlohmann::json::parse(read_text(own("poses.json")));
  const auto east = adjusted(poses, file("east.fovea")),
             north = adjusted(poses, file("north.fovea"));
  const auto true_east = DriveTruth(file("east")).T_local_lidar(),
             true_north = DriveTruth(file("north")).T_local_lidar();
  ASSERT_EQ(east.size(), true_east.size());
  for (const std::size_t i : {10u, 20u, 30u}) {
    const RigidMotion error =
        (true_east[20].inverse() * true_north[i]).inverse() * (east[20].inverse() * north[i]);
    EXPECT_LT(error.translation().norm(), 0.08) << i;
  }

  // The poses stay where they are fixed.
  const ProgramRun fixed = run_fovea(
      fmt::format("adjust '{}' '{}' '{}' -o '{}' --fixed '{}'", file("east.fovea"),
                  file("north.fovea"), own("pair.json"), own("fixed.json"), own("poses.json")));
  ASSERT_EQ(fixed.exit_code, 0) << fixed.err;
  EXPECT_THAT(fixed.out, HasSubstr("fixed"));
}

TEST_F(CityProgram, MapsOfOtherPlacesHaveNoMatches) {
  const ProgramRun aligned = align("east", "far", "-o '" + own("pair.json") + "'");
  EXPECT_EQ(aligned.exit_code, 0);
  EXPECT_THAT(aligned.err, HasSubstr("do not overlap"));
  EXPECT_EQ(nlohmann::json::parse(read_text(own("pair.json"))).at("verdict"), "no overlap");
  const ProgramRun run =
      run_fovea(fmt::format("adjust '{}' '{}' '{}' -o '{}'", file("east.fovea"), file("far.fovea"),
                            own("pair.json"), own("poses.json")));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("has no match with another map"));
}

class CityTiles : public CityProgram {
 protected:
  CityTiles() {
    EXPECT_EQ(align("east", "north", "--quiet -o '" + own("pair.json") + "'").exit_code, 0);
    const ProgramRun run =
        run_fovea(fmt::format("adjust '{}' '{}' '{}' -o '{}' --quiet", file("east.fovea"),
                              file("north.fovea"), own("pair.json"), own("poses.json")));
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
  ProgramRun fuse(const std::string& maps, const std::string& tile, const std::string& out,
                  const std::string& options = "") const {
    std::string command = "fuse";
    for (const char* map : {"east", "north", "far"}) {
      if (maps.find(map) != std::string::npos)
        command += fmt::format(" '{}'", file(map) + ".fovea");
    }
    return run_fovea(fmt::format("{} --poses '{}' --tile={} -o '{}' {}", command, own("poses.json"),
                                 tile, own(out), options));
  }
};

TEST_F(CityTiles, EachPointOfAMapIsInOneTile) {
  std::size_t points = 0;
  for (int x = -1; x <= 2; ++x) {
    for (int y = -2; y <= 1; ++y) {
      const std::string tile = fmt::format("{},{}", x, y);
      const ProgramRun run = fuse("east", tile, "tile.fovea", "--force --quiet");
      if (run.exit_code != 0) {
        EXPECT_THAT(run.err, HasSubstr("no map has a point in tile")) << tile;
        continue;
      }
      points += MapReader(own("tile.fovea")).size();
    }
  }
  EXPECT_EQ(points, MapReader(file("east.fovea")).size());
}

TEST_F(CityTiles, ATileHasEachSurfaceOnceAndItsColorsOfOneDrive) {
  const ProgramRun run = fuse("east north", "0,0", "tile.fovea", "--threads 1");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("points of 2 maps"));
  ASSERT_EQ(fuse("north east", "0,0", "again.fovea", "--threads 2").exit_code, 0);
  const MapReader tile(own("tile.fovea"));
  EXPECT_EQ(tile.digest(), MapReader(own("again.fovea")).digest());
  ASSERT_EQ(fuse("east", "0,0", "east.fovea").exit_code, 0);
  ASSERT_EQ(fuse("north", "0,0", "north.fovea").exit_code, 0);
  const std::size_t east = MapReader(own("east.fovea")).size(),
                    north = MapReader(own("north.fovea")).size();
  EXPECT_GT(tile.size(), std::max(east, north));
  EXPECT_LT(tile.size(), 0.95 * double(east + north));
  EXPECT_EQ(tile.drives().size(), 2u);
  EXPECT_GT(fs::file_size(own("tile.overview.glb")), 10'000u);
}

TEST_F(CityTiles, RefusesWhatIsNoTileOfTheseMaps) {
  EXPECT_THAT(fuse("east", "9000,0", "tile.fovea").err, HasSubstr("no map has a point"));
  EXPECT_THAT(fuse("east", "1.5,0", "tile.fovea").err, HasSubstr("X,Y"));
  EXPECT_THAT(fuse("east far", "0,0", "tile.fovea").err, HasSubstr("the poses are of other maps"));
  EXPECT_THAT(fuse("east", "0,0", "tile.fovea", "--session 1999-01-01").err,
              HasSubstr("no map has the session"));
  EXPECT_FALSE(fs::exists(own("tile.fovea")));
  EXPECT_FALSE(fs::exists(own("tile.overview.glb")));
}

TEST_F(CityProgram, RefusesFilesThatDoNotBelongTogether) {
  ASSERT_EQ(align("east", "north", "--quiet -o '" + own("pair.json") + "'").exit_code, 0);
  const ProgramRun other = run_fovea(fmt::format("adjust '{}' '{}' -o '{}'", file("far.fovea"),
                                                 own("pair.json"), own("poses.json")));
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.err, HasSubstr("of a map that is not given"));
  EXPECT_FALSE(fs::exists(own("poses.json")));
  const ProgramRun wrong =
      run_fovea(fmt::format("adjust '{}' -o '{}' --control '{}'", file("far.fovea"),
                            own("poses.json"), own("pair.json")));
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("there is no column"));
}

}  // namespace fovea::city_program_test
