// Which drives the commands accept for a map: by stamps, scans and calibration, not by names.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>

#include "tests/program.h"

namespace fovea::drive_identity_program_test {

using ::testing::AllOf;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kSmall =
    "--scene plaza --frames 6 --set camera.width=160 --set camera.height=48 "
    "--set camera.focal=92 --set camera.cx=79.5 --set camera.cy=22 --set 'camera.numbers=[2]' "
    "--quiet";

/// Two simulated drives of the same name, stamps and calibration, and the map of the first.
class DriveIdentity : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    for (const int seed : {1, 2}) {
      const fs::path root = *scratch_ / fmt::to_string(seed);
      const ProgramRun run =
          run_fovea(fmt::format("simulate -o '{}' --seed {} {}", root.string(), seed, kSmall));
      ASSERT_EQ(run.exit_code, 0) << run.err;
    }
    const ProgramRun run = run_fovea(
        fmt::format("map '{}' -o '{}' --hold-out 4:2 --quiet", root(1).string(), map().string()));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    std::ofstream(*scratch_ / "poses.txt") << "1 0 0 0 0 1 0 0 0 0 1 0\n";
  }
  static void TearDownTestSuite() { delete scratch_; }

  static fs::path root(int seed) { return *scratch_ / fmt::to_string(seed); }
  static fs::path map() { return *scratch_ / "m.fovea"; }
  static fs::path drive_below(const fs::path& root) {
    return root / "2026_01_01" / "2026_01_01_drive_0001_sync";
  }
  /// A copy of the first drive, with its calibration, that a test may change.
  fs::path copy(const std::string& name) const {
    fs::copy(root(1), own_ / name, fs::copy_options::recursive);
    return own_ / name;
  }

  /// Runs each command that takes a map and its drive.
  void for_each_command(const fs::path& drive, const std::string& more,
                        const std::function<void(const ProgramRun&, const std::string&)>& f) const {
    const std::string of_both = fmt::format("'{}' '{}'", map().string(), drive.string());
    const auto output = [&](const char* name) {
      return fmt::format("-o '{}' --force", (own_ / name).string());
    };
    for (const std::string& command :
         {"evaluate " + of_both, "evaluate --truth " + of_both,
          "recolor " + of_both + " " + output("recolored.fovea"),
          "render " + of_both + " " + output("picture.png"),
          fmt::format("render {} {} --poses '{}'", of_both, output("rendered"),
                      (*scratch_ / "poses.txt").string())}) {
      f(run_fovea(command + " " + more), command);
    }
    const std::string view = fmt::format("view '{}' --drive '{}' --no-browser --port 0 {}",
                                         map().string(), drive.string(), more);
    f(run_view(view), view);
  }
  /// Ends a view once it shows the map. Its exit code is 0 then.
  static ProgramRun run_view(const std::string& arguments) {
    constexpr int kEndedBySigint = 130;
    const TemporaryFolder scratch;
    const std::string out = (scratch / "out").string(), err = (scratch / "err").string();
    const int status =
        std::system(fmt::format("'{}' {} >'{}' 2>'{}' & view=$!; "
                                "for i in $(seq 600); do grep -q http: '{}' && break; "
                                "kill -0 $view 2>/dev/null || break; sleep 0.1; done; "
                                "kill -INT $view 2>/dev/null; wait $view",
                                FOVEA_PROGRAM, arguments, out, err, out)
                        .c_str());
    const int code = WEXITSTATUS(status);
    return {code == kEndedBySigint ? 0 : code, read_text(out), read_text(err)};
  }
  void expect_accepted(const fs::path& drive, const std::string& more = "") const {
    for_each_command(drive, more, [](const ProgramRun& run, const std::string& command) {
      EXPECT_EQ(run.exit_code, 0) << command << '\n' << run.err;
    });
  }
  void expect_refused(const fs::path& drive, const std::string& why) const {
    for_each_command(drive, "", [&](const ProgramRun& run, const std::string& command) {
      EXPECT_EQ(run.exit_code, 1) << command;
      EXPECT_THAT(run.err, AllOf(HasSubstr(why), HasSubstr("--foreign"))) << command;
    });
    EXPECT_FALSE(fs::exists(own_ / "recolored.fovea"));
    EXPECT_FALSE(fs::exists(own_ / "picture.png"));
    EXPECT_FALSE(fs::exists(own_ / "rendered"));
  }

  static TemporaryFolder* scratch_;
  TemporaryFolder own_;
};
TemporaryFolder* DriveIdentity::scratch_ = nullptr;

TEST_F(DriveIdentity, TheFolderThatMapAcceptedIsAccepted) { expect_accepted(root(1)); }

TEST_F(DriveIdentity, ARenamedThinnedDriveBehindALinkIsAccepted) {
  const fs::path date = copy("copy") / "2026_01_01";
  const fs::path renamed = date / "any_name";
  fs::rename(drive_below(own_ / "copy"), renamed);
  fs::remove(renamed / "velodyne_points" / "data" / "0000000001.bin");
  fs::remove(renamed / "image_02" / "data" / "0000000003.png");
  fs::rename(date, own_ / "elsewhere");
  fs::create_directory_symlink(own_ / "elsewhere" / "any_name", own_ / "elsewhere" / "link");
  expect_accepted(own_ / "elsewhere" / "link");
}

TEST_F(DriveIdentity, AnotherDriveOfTheSameNameIsRefused) {
  expect_refused(root(2), "was not made of the drive");
}

TEST_F(DriveIdentity, AnotherDriveIsAcceptedIfAsked) { expect_accepted(root(2), "--foreign"); }

TEST_F(DriveIdentity, AnotherCalibrationIsRefused) {
  const fs::path drive = copy("recalibrated");
  const fs::path file = drive / "2026_01_01" / "calib_velo_to_cam.txt";
  std::string text = read_text(file);
  const std::size_t at = text.find("\nT: ") + 4;
  text.replace(at, text.find(' ', at) - at, "0.2");
  std::ofstream(file, std::ios::binary) << text;
  expect_refused(drive, "another calibration than the map: camera 2");

  const ProgramRun resume = run_fovea(
      fmt::format("map '{}' -o '{}' --hold-out 4:2 --resume", drive.string(), map().string()));
  EXPECT_EQ(resume.exit_code, 1);
  EXPECT_THAT(resume.err, HasSubstr("another calibration (camera 2)"));
}

TEST_F(DriveIdentity, ResumeRefusesAnotherDriveAndReportsACompleteMap) {
  const auto resume = [&](int seed) {
    return run_fovea(fmt::format("map '{}' -o '{}' --hold-out 4:2 --resume", root(seed).string(),
                                 map().string()));
  };
  EXPECT_EQ(resume(2).exit_code, 1);
  EXPECT_THAT(resume(2).err, HasSubstr("a drive with other scans"));
  const std::string before = read_text(map());
  const ProgramRun again = resume(1);
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_THAT(again.out, HasSubstr("the map is complete: there is nothing to resume"));
  EXPECT_EQ(read_text(map()), before);
}

// Format 6 has no fingerprint. The simulator writes the same stamps into each drive.
TEST_F(DriveIdentity, AMapOfFormat6IsAcceptedWithANote) {
  const ProgramRun run = run_fovea(fmt::format("recolor '{}' '{}' -o '{}'",
                                               FOVEA_SOURCE_DIR "/tests/data/format_6.fovea",
                                               root(1).string(), (own_ / "out.fovea").string()));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("note: the map has no fingerprint of its drive"));
}

TEST_F(DriveIdentity, EachDriveOfAMergedMapIsAccepted) {
  const fs::path second = own_ / "second.fovea", both = own_ / "both.fovea";
  for (const std::string& command :
       {fmt::format("map '{}' -o '{}' --frames 1:6 --quiet", root(2).string(), second.string()),
        fmt::format("merge '{}' '{}' -o '{}' --force --quiet", map().string(), second.string(),
                    both.string())}) {
    const ProgramRun run = run_fovea(command);
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  for (const int seed : {1, 2}) {
    const std::string of_both = fmt::format("'{}' '{}'", both.string(), root(seed).string());
    const ProgramRun picture = run_fovea(
        fmt::format("render {} -o '{}' --force", of_both, (own_ / "picture.png").string()));
    EXPECT_EQ(picture.exit_code, 0) << picture.err;
    const ProgramRun recolored = run_fovea(
        fmt::format("recolor {} -o '{}' --force", of_both, (own_ / "recolored.fovea").string()));
    EXPECT_EQ(recolored.exit_code, 0) << recolored.err;
    EXPECT_THAT(recolored.out, HasSubstr("the map is of several drives"));
    const ProgramRun scored = run_fovea(fmt::format("evaluate {} --protocol in-sample", of_both));
    EXPECT_EQ(scored.exit_code, 0) << scored.err;
  }
}

}  // namespace fovea::drive_identity_program_test
