// fovea simulate as a user meets it. What it simulates is tested in src/fovea/simulation.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/drive/frame_source.h"
#include "tests/program.h"

namespace fovea::simulate_program_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

/// A drive that takes no time.
constexpr const char* kSmall =
    " --frames 3 --set camera.width=96 --set camera.height=32"
    " --set camera.focal=60 --set camera.cx=47.5 --set camera.cy=15.5 --set lidar.columns=90 ";

class Simulate : public testing::Test {
 protected:
  ProgramRun simulate(const std::string& arguments, const std::string& before = "") const {
    return run_fovea("simulate -o '" + (folder_ / "out").string() + "' " + arguments, before);
  }
  void expect_error(const ProgramRun& run, int exit_code, const std::string& says) const {
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_THAT(run.err, AllOf(StartsWith("fovea: error: "), HasSubstr(says)));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }

  TemporaryFolder folder_;
};

TEST_F(Simulate, WrongUsageIsExitCodeTwoAndLeavesNothing) {
  expect_error(simulate("--scene moon"), 2, "moon");
  expect_error(simulate("--noise loud"), 2, "loud");
  expect_error(simulate("--frames 0"), 2, "--frames");
  expect_error(simulate("--frames 100001"), 2, "--frames");
  expect_error(simulate("--frames many"), 2, "--frames");
  expect_error(simulate("--seed -1"), 2, "--seed");
  expect_error(simulate("--threads -1"), 2, "--threads");
  expect_error(run_fovea("simulate"), 2, "--output");
  EXPECT_THAT(folder_.names(), IsEmpty());
}

TEST_F(Simulate, WrongSettingsAreErrorsAndLeaveNothing) {
  expect_error(simulate("--set lidar.colour=3"), 1, "lidar.colour");
  expect_error(simulate("--set vehicle.speed=fast"), 1, "vehicle.speed");
  expect_error(simulate("--set vehicle.speed=-3"), 1, "0 to 50 m/s");
  expect_error(simulate("--config /nonexistent.toml"), 1, "/nonexistent.toml");
  EXPECT_THAT(folder_.names(), IsEmpty());
}

TEST_F(Simulate, WritesADriveThatOpens) {
  std::ofstream(folder_ / "my.toml") << "[camera]\nnumbers = [0, 3]\n";
  const ProgramRun run =
      simulate(kSmall + ("--seed 7 --config '" + (folder_ / "my.toml").string() + "'"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty());
  EXPECT_THAT(run.out, AllOf(HasSubstr("3 frames"), HasSubstr("street"), HasSubstr("seed 7")));
  EXPECT_THAT(folder_.names(), ElementsAre("my.toml", "out"));
  DriveOptions options;
  options.cameras = {3, 0};
  const auto source = open_drive(folder_ / "out/2026_01_01/2026_01_01_drive_0001_sync", options);
  EXPECT_EQ(source->info().end - source->info().begin, 3);
  EXPECT_THAT(source->info().notes, IsEmpty());
  EXPECT_TRUE(source->info().navigation);
  EXPECT_TRUE(std::holds_alternative<Frame>(source->load(2)));
}

TEST_F(Simulate, NeverReplacesAndNeedsAParent) {
  std::filesystem::create_directory(folder_ / "out");
  for (const char* format : {" --format kitti", " --format generic"}) {
    const ProgramRun run = simulate(kSmall + std::string(format));
    expect_error(run, 1, "exists already");
    EXPECT_THAT(run.err, Not(HasSubstr("--force"))) << "which simulate does not have";
  }
  expect_error(run_fovea("simulate -o '" + (folder_ / "none/out").string() + "'" + kSmall), 1,
               "does not exist");
  EXPECT_THAT(folder_.names(), ElementsAre("out"));
}

TEST_F(Simulate, QuietSaysNothing) {
  const ProgramRun run = simulate(std::string("--quiet --threads 1") + kSmall);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.out + run.err, IsEmpty());
}

TEST_F(Simulate, AnInterruptEndsCleanlyAndLeavesNothing) {
  // `timeout` sends the signal, with --foreground only once (a second one would end the program on
  // the spot); --preserve-status gives the program's own exit code.
  const ProgramRun run =
      simulate("--frames 5000 --set camera.width=96 --set camera.height=32 --set lidar.columns=90",
               "timeout --foreground --preserve-status -s INT 2");
  expect_error(run, 130, "interrupted");
  EXPECT_THAT(folder_.names(), IsEmpty());
}

}  // namespace fovea::simulate_program_test
