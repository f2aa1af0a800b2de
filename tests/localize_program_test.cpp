// fovea localize as a user meets it: on the real drive, and on another day of a simulated street.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/geometry/pose_file.h"
#include "tests/kitti_sample.h"
#include "tests/program.h"

namespace fovea::localize_program_test {

using testing::HasSubstr;

class LocalizeProgram : public testing::Test {
 protected:
  static std::string path(const std::string& name) { return (*folder_ / name).string(); }
  static void succeed(const std::string& command) {
    const ProgramRun run = run_fovea(command);
    ASSERT_EQ(run.exit_code, 0) << command << "\n" << run.err;
  }
  /// One pass in which the street is mapped, and another with other noise, exposure and traffic.
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    succeed(
        fmt::format("simulate -o '{}' --frames 24 --set camera.numbers=[2] --quiet", path("a")));
    succeed(fmt::format("map '{}' -o '{}' --quiet", path("a"), path("a.fovea")));
    succeed(
        fmt::format("simulate -o '{}' --scene traffic --frames 20 --set drive.pass=1 "
                    "--set camera.numbers=[2] --set camera.exposure=1.4 --set camera.width=64 "
                    "--set camera.height=32 --set camera.cx=32 --set camera.cy=16 --quiet",
                    path("b")));
  }
  static void TearDownTestSuite() { delete folder_; }
  static nlohmann::json report() {
    return nlohmann::json::parse(read_text(path("report.json")))["localize"];
  }
  static TemporaryFolder* folder_;
};
TemporaryFolder* LocalizeProgram::folder_ = nullptr;

TEST_F(LocalizeProgram, AnotherDayOfTheStreetIsFoundToCentimetres) {
  for (const char* guess : {"navigation", "first"}) {
    succeed(fmt::format("localize '{}' '{}' -o '{}' --guess {} --truth '{}' --report '{}' --force",
                        path("b"), path("a.fovea"), path("b.csv"), guess, path("a"),
                        path("report.json")));
    const nlohmann::json figures = report();
    EXPECT_EQ(figures["localized"], 20) << guess;
    EXPECT_EQ(figures["found"], 1) << guess;
    EXPECT_EQ(figures["guess"], guess);
    EXPECT_LE(figures["truth"]["position_rms_m"], 0.03) << guess;
    EXPECT_LE(figures["truth"]["rotation_rms_deg"], 0.1) << guess;
    EXPECT_LE(figures["truth"]["normalized_error"], 3) << guess;
    // Of so few frames it has been 0.18 to 0.3, as normals are rounded one way or another.
    EXPECT_GE(figures["truth"]["normalized_error"], 0.1) << guess;
    EXPECT_GT(figures["health_mean"], 0.6) << guess;
    EXPECT_GT(figures["latency_ms"]["frame"]["p50"], 0);
    EXPECT_THAT(read_text(path("b.csv")), HasSubstr("19,"));
  }
}

TEST_F(LocalizeProgram, ThePosesAreOnesThatFoveaReads) {
  const std::string command =
      fmt::format("localize '{}' '{}' -o '{}'", path("b"), path("a.fovea"), path("b.txt"));
  const ProgramRun run = run_fovea(command);
  EXPECT_THAT(run.out, HasSubstr("20 of 20 frames localized (guess: navigation)"));
  EXPECT_EQ(read_poses(path("b.txt")).size(), 20u);
  // Frames' poses are a guess, too, also where some are not known.
  succeed(fmt::format("localize '{}' '{}' -o '{}' --only 0-7,12-19", path("b"), path("a.fovea"),
                      path("gaps.txt")));
  EXPECT_FALSE(read_poses_with_gaps(path("gaps.txt"))[8]);
  succeed(command + "2 --guess '" + path("gaps.txt") + "'");
  EXPECT_THAT(run_fovea(fmt::format("render '{}' --poses '{}' --lidar hdl64 -o '{}'",
                                    path("a.fovea"), path("gaps.txt"), path("c")))
                  .err,
              HasSubstr("gaps.txt:9"));
  EXPECT_THAT(run_fovea(command).err, HasSubstr("--force"));
}

TEST_F(LocalizeProgram, AMapOfAnotherPlaceIsRefusedAndNothingWritten) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  for (const auto& [guess, why] : {std::pair("navigation", "the drive lies outside the map"),
                                   {"first", "the scans fit nowhere in the map"}}) {
    const ProgramRun run =
        run_fovea(fmt::format("localize '{}' '{}' -o '{}' --guess {} --frames 0:6", drive.string(),
                              path("a.fovea"), path("none.txt"), guess));
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr(why));
    EXPECT_FALSE(std::filesystem::exists(path("none.txt")));
  }
}

TEST_F(LocalizeProgram, WrongUsageSaysWhatToDo) {
  const auto error = [&](const std::string& rest) {
    return run_fovea(fmt::format("localize '{}' '{}' -o '{}' {}", path("b"), path("a.fovea"),
                                 path("x.txt"), rest))
        .err;
  };
  EXPECT_THAT(error("--guess nowhere.txt"), HasSubstr("nowhere.txt"));
  EXPECT_THAT(error("--only 2:5"), HasSubstr("--only"));
  EXPECT_THAT(error("--frames 90:95"), HasSubstr("hold none of the drive's"));
  EXPECT_THAT(error("--truth '" + path("a.fovea") + "'"), HasSubstr("a.fovea"));
  const std::string other_drive = error("--truth '" + path("b") + "'");
  EXPECT_THAT(other_drive, HasSubstr("the map was not made of the drive"));
  EXPECT_THAT(other_drive, HasSubstr("give --truth the drive"));
  EXPECT_FALSE(std::filesystem::exists(path("x.txt")));
}

TEST(LocalizeSampleDrive, OddFramesAreFoundInAMapOfTheEvenOnesWithoutNavigation) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  const TemporaryFolder folder;
  const auto path = [&](const char* name) { return (folder / name).string(); };
  const auto run = [&](const std::string& command) {
    const ProgramRun done = run_fovea(command);
    ASSERT_EQ(done.exit_code, 0) << done.err;
  };
  run(fmt::format("map '{}' -o '{}' --hold-out 2:1 --quiet", drive.string(), path("even.fovea")));
  run(fmt::format("export '{}' '{}' --format kitti-poses", path("even.fovea"), path("map.txt")));
  run(fmt::format("localize '{}' '{}' -o '{}' --only 2:1 --guess first", drive.string(),
                  path("even.fovea"), path("odd.txt")));
  // The mapper gave the held-out frames poses, too: by other scans and with navigation.
  const std::vector<RigidMotion> mapped = read_poses(path("map.txt"));
  const auto odd = read_poses_with_gaps(path("odd.txt"));
  ASSERT_EQ(odd.size(), mapped.size());
  double squared = 0;
  for (std::size_t i = 0; i < odd.size(); ++i) {
    ASSERT_EQ(odd[i].has_value(), i % 2 == 1) << i;
    if (!odd[i]) continue;
    const RigidMotion apart = mapped[i].inverse() * *odd[i];
    squared += apart.translation().squaredNorm();
    EXPECT_LT(apart.translation().norm(), 0.15) << i;
    EXPECT_LT(rotation_angle(apart.linear()), 0.005) << i;
  }
  EXPECT_LT(std::sqrt(squared / 25), 0.04);
}

}  // namespace fovea::localize_program_test
