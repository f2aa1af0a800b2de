// Warnings: on standard error, in every JSON report, and errors with --strict.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/map/map_store.h"
#include "tests/kitti_writer.h"
#include "tests/program.h"

namespace fovea::warnings_program_test {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::IsSupersetOf;
using testing::Not;
using testing::StartsWith;
using Texts = std::vector<std::string>;

/// A drive, and a copy of it without one image and with a malformed stamp.
class WarningsProgram : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    good_ = write_kitti_drive(SyntheticDrive(street_scene(), 6, 0.8), folder_->path());
    const auto copy = *folder_ / "copy";
    std::filesystem::copy(good_.parent_path(), copy, std::filesystem::copy_options::recursive);
    bad_ = copy / good_.filename();
    std::filesystem::remove(bad_ / "image_02/data" / (kitti_stem(3) + ".png"));
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string path(const std::string& name) { return (*folder_ / name).string(); }
  static ProgramRun map(const std::filesystem::path& drive, const std::string& more = "") {
    return run_fovea(fmt::format("map '{}' -o '{}' --force --report '{}' {}", drive.string(),
                                 path("a.fovea"), path("report.json"), more));
  }
  static Texts texts(const std::string& file, const std::string& key) {
    const auto json = nlohmann::json::parse(read_text(path(file)));
    return json.at(nlohmann::json::json_pointer(key)).get<Texts>();
  }

  static TemporaryFolder* folder_;
  static std::filesystem::path good_, bad_;
};
TemporaryFolder* WarningsProgram::folder_ = nullptr;
std::filesystem::path WarningsProgram::good_, WarningsProgram::bad_;

TEST_F(WarningsProgram, AGoodDriveHasNoneAndIsNoErrorWithStrict) {
  const ProgramRun run = map(good_, "--strict");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(texts("report.json", "/map/warnings"), IsEmpty());
  EXPECT_EQ(run_fovea(fmt::format("--strict map '{}' -o '{}' --force --quiet", good_.string(),
                                  path("a.fovea")))
                .exit_code,
            0);
}

TEST_F(WarningsProgram, AreOnStandardErrorAndInTheReport) {
  const ProgramRun run = map(bad_);
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, StartsWith("warning: "));
  EXPECT_THAT(run.err, HasSubstr("skipped: 1 frame (missing image)"));
  EXPECT_THAT(run.out, Not(HasSubstr("missing image")));
  EXPECT_THAT(texts("report.json", "/map/warnings"), Contains(HasSubstr("missing image")));
  // `notes` has all messages.
  EXPECT_THAT(texts("report.json", "/map/notes"),
              IsSupersetOf(texts("report.json", "/map/warnings")));
}

TEST_F(WarningsProgram, AreErrorsWithStrictAndNamed) {
  for (const char* quiet : {"", " --quiet"}) {
    const ProgramRun run = map(bad_, std::string("--strict") + quiet);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr("warning: skipped: 1 frame (missing image)\n"));
    EXPECT_THAT(run.err, HasSubstr("fovea: error: 1 warning with --strict"));
  }
  EXPECT_EQ(map(bad_, "--quiet").err, "");
  // The map is kept, and so is the report.
  EXPECT_EQ(run_fovea("info '" + path("a.fovea") + "'").exit_code, 0);
}

TEST_F(WarningsProgram, EveryJsonReportHasAnArrayOfThem) {
  ASSERT_EQ(map(good_, "--hold-out 4:2").exit_code, 0);
  const std::string good = "'" + good_.string() + "'", a = "'" + path("a.fovea") + "'";
  const auto run = [](const std::string& command) {
    const ProgramRun done = run_fovea(command);
    EXPECT_EQ(done.exit_code, 0) << command << "\n" << done.err;
    return done;
  };
  run("evaluate " + a + " " + good + " --json '" + path("scores.json") + "'");
  EXPECT_NO_THROW(texts("scores.json", "/warnings"));
  run("localize " + good + " " + a + " -o '" + path("poses.txt") + "' --report '" +
      path("localize.json") + "'");
  EXPECT_THAT(texts("localize.json", "/localize/warnings"), IsEmpty());
  std::ofstream(path("info.json")) << run("info --json " + a).out;
  EXPECT_THAT(texts("info.json", "/warnings"), IsEmpty());
  run("reproduce " + good + " -o '" + path("tables") + "' --rows E0 --quiet");
  EXPECT_NO_THROW(texts("tables/results.json", "/warnings"));
}

// A drive whose scans the map does not have everywhere.
TEST_F(WarningsProgram, OfOtherCommandsAreErrorsWithStrict) {
  ASSERT_EQ(map(good_).exit_code, 0);
  const ProgramRun localized =
      run_fovea(fmt::format("localize '{}' '{}' -o '{}' --strict --force", bad_.string(),
                            path("a.fovea"), path("poses.txt")));
  EXPECT_EQ(localized.exit_code, 0) << localized.err;  // it needs no image
  std::filesystem::remove(bad_ / "velodyne_points/data" / (kitti_stem(4) + ".bin"));
  const ProgramRun lost = run_fovea(fmt::format("localize '{}' '{}' -o '{}' --strict --force",
                                                bad_.string(), path("a.fovea"), path("poses.txt")));
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_THAT(lost.err, HasSubstr("warning: 1 frames without a scan"));
  const ProgramRun recolored = run_fovea(fmt::format(
      "recolor '{}' '{}' -o '{}' --strict", path("a.fovea"), bad_.string(), path("b.fovea")));
  EXPECT_EQ(recolored.exit_code, 1);
  EXPECT_THAT(recolored.err, HasSubstr("warning: "));
}

// export and merge read maps alone: a map that was repaired or is unfinished may lack parts.
TEST_F(WarningsProgram, OfAMapThatMayLackPartsAreErrorsWithStrict) {
  ASSERT_EQ(map(good_).exit_code, 0);
  const auto run = [&](const std::string& command, const std::string& more) {
    return run_fovea(
        fmt::format(fmt::runtime(command), path("a.fovea"), path("part.fovea"), path("out")) +
        " --force --quiet " + more);
  };
  for (const auto& [key, value, warning] :
       {std::tuple("complete", "0", "the map is unfinished"),
        {"repair", "1 of 2 tiles", "the map was repaired and lacks parts"}}) {
    std::filesystem::copy_file(path("a.fovea"), path("part.fovea"),
                               std::filesystem::copy_options::overwrite_existing);
    const auto part = MapWriter::open(path("part.fovea"));
    part->put_meta(key, value);
    part->finish();
    for (const char* command :
         {"export '{1}' '{2}.ply'", "export '{1}' '{2}.glb'", "merge '{0}' '{1}' -o '{2}.fovea'"}) {
      const ProgramRun quiet = run(command, "");
      EXPECT_EQ(quiet.exit_code, 0) << command << quiet.err;
      EXPECT_EQ(quiet.err, "") << command;
      const ProgramRun strict = run(command, "--strict");
      EXPECT_EQ(strict.exit_code, 1) << command;
      EXPECT_THAT(strict.err, HasSubstr(warning)) << command;
    }
  }
  const ProgramRun whole = run("export '{0}' '{2}.ply'", "--strict");
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
}

}  // namespace fovea::warnings_program_test
