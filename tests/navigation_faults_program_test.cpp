// Navigation in wrong units or of wrong order, and the clock of a drive, through the program.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>
#include <vector>

#include "fovea/simulation/simulate.h"
#include "tests/program.h"

namespace fovea::navigation_faults_program_test {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// A simulated street of scans alone, with positions on earth.
class NavigationFaultsProgram : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    SimulationOptions options = simulation_options(Scene::kStreet, "default");
    options.seed = 3;
    options.frames = 14;
    options.format = DriveFormat::kGeneric;
    options.camera.cameras = {kitti_camera(2)};
    options.camera.width = 64;
    options.camera.height = 32;
    options.camera.focal = 40;
    options.camera.cx = 32;
    options.camera.cy = 16;
    simulate(options, *scratch_ / "street");
  }
  static void TearDownTestSuite() { delete scratch_; }

  /// The street whose lines of gnss.csv a function changes: time, latitude, longitude, altitude,
  /// accuracy and so on.
  fs::path street_with(const std::function<void(std::vector<std::string>&)>& change) const {
    fs::create_directories(own_ / "drive");
    for (const char* name : {"lidar", "images", "drive.toml"}) {
      fs::create_symlink(*scratch_ / "street" / name, own_ / "drive" / name);
    }
    std::istringstream lines(read_text(*scratch_ / "street/gnss.csv"));
    std::ofstream changed(own_ / "drive/gnss.csv");
    std::string line;
    std::getline(lines, line);
    changed << line << '\n';
    while (std::getline(lines, line)) {
      std::vector<std::string> cells;
      std::istringstream stream(line);
      for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
      change(cells);
      changed << fmt::format("{}\n", fmt::join(cells, ","));
    }
    return own_ / "drive";
  }

  ProgramRun map(const fs::path& drive) const {
    const ProgramRun run =
        run_fovea(fmt::format("map '{}' -o '{}' --force --cameras none --set surface.spacing_m=0.5",
                              drive.string(), (own_ / "map.fovea").string()));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run;
  }
  std::string info() const { return run_fovea("info '" + (own_ / "map.fovea").string() + "'").out; }

  static TemporaryFolder* scratch_;
  TemporaryFolder own_;
};
TemporaryFolder* NavigationFaultsProgram::scratch_ = nullptr;

TEST_F(NavigationFaultsProgram, RightPositionsGiveNoNote) {
  const ProgramRun run = map(*scratch_ / "street");
  EXPECT_THAT(run.out + run.err, Not(HasSubstr("navigation")));
  EXPECT_THAT(info(), Not(HasSubstr("not georeferenced")));
}

TEST_F(NavigationFaultsProgram, PositionsOfAWrongFormNameTheCause) {
  const auto swapped = street_with([](auto& cells) { std::swap(cells[1], cells[2]); });
  EXPECT_THAT(map(swapped).err, HasSubstr("likely cause: latitude and longitude are swapped"));
  fs::remove_all(own_ / "drive");
  const auto radians = street_with([](auto& cells) {
    for (const int column : {1, 2}) {
      cells[std::size_t(column)] =
          fmt::format("{:.15g}", std::stod(cells[std::size_t(column)]) * std::numbers::pi / 180);
    }
  });
  EXPECT_THAT(map(radians).err,
              HasSubstr("likely cause: latitude and longitude are in radians, not in degrees"));
}

TEST_F(NavigationFaultsProgram, PositionsWithoutAFixDoNotGeoreference) {
  const auto no_fix = street_with([](auto& cells) { cells[4] = "inf"; });
  EXPECT_THAT(map(no_fix).err, HasSubstr("no position with a fix"));
  EXPECT_THAT(info(), HasSubstr("not georeferenced"));
  fs::remove_all(own_ / "drive");
  const auto null = street_with([](auto& cells) { cells[1] = cells[2] = cells[3] = "0"; });
  EXPECT_THAT(map(null).err, HasSubstr("without a fix (latitude and longitude 0)"));
  EXPECT_THAT(info(), HasSubstr("not georeferenced"));
}

TEST_F(NavigationFaultsProgram, UnixTimeIsTheUtcOfExports) {
  map(*scratch_ / "street");
  const auto gps_time = [&](const std::string& more) {
    const std::string file = (own_ / "map.las").string();
    const ProgramRun run = run_fovea(fmt::format("export '{}' '{}' --uncolored --force {}",
                                                 (own_ / "map.fovea").string(), file, more));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string bytes = read_text(file);
    std::uint32_t points_at = 0;
    double time = 0;
    std::memcpy(&points_at, bytes.data() + 96, sizeof points_at);
    std::memcpy(&time, bytes.data() + points_at + 22, sizeof time);
    return time;
  };
  // 2026-01-01 12:00 UTC is noon of day 4 of GPS week 2399; 18 leap seconds.
  constexpr double kNoon = (2399 * 7 + 4) * 86'400.0 + 43'200 + 18 - 1e9;
  const double given = gps_time("");
  EXPECT_GE(given, kNoon);
  EXPECT_LT(given, kNoon + 3);
  EXPECT_NEAR(gps_time("--utc-offset 1.5"), given - 5400, 1e-6);
}

}  // namespace fovea::navigation_faults_program_test
