// fovea merge as a user meets it, on the real drive: two overlapping halves of it are one map
// again.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/kitti_sample.h"
#include "tests/program.h"

namespace fovea::merge_program_test {

using testing::HasSubstr;

class MergeProgram : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (own_ / name).string(); }
  nlohmann::json score(const std::string& map, const std::filesystem::path& drive) const {
    const ProgramRun run = run_fovea(fmt::format("evaluate '{}' '{}' --hold-out 8:4 --json '{}'",
                                                 path(map), drive.string(), path("scores.json")));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return nlohmann::json::parse(read_text(path("scores.json")));
  }
  TemporaryFolder own_;
};

TEST_F(MergeProgram, TwoPartsOfADriveAreOneMapAgain) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  for (const auto& [name, frames] : {std::pair("a.fovea", "0:22"), {"b.fovea", "14:36"}}) {
    const ProgramRun mapped =
        run_fovea(fmt::format("map '{}' -o '{}' --cameras 2 --frames {} --hold-out 8:4",
                              drive.string(), path(name), frames));
    ASSERT_EQ(mapped.exit_code, 0) << mapped.err;
  }
  const std::string merge =
      fmt::format("merge '{}' '{}' -o '{}'", path("a.fovea"), path("b.fovea"), path("c.fovea"));
  const ProgramRun merged = run_fovea(merge);
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_THAT(merged.out, HasSubstr("submaps registered: 1 of 1"));
  const ProgramRun info = run_fovea(fmt::format("info '{}'", path("c.fovea")));
  EXPECT_THAT(info.out, HasSubstr("frames 0 to 21, in the drive 0 to 21"));
  EXPECT_THAT(info.out, HasSubstr("frames 22 to 43, in the drive 14 to 35"));

  // What each part shows well the whole shows well, and more of it. A part's figures are of the
  // frames that it has.
  const auto part = score("a.fovea", drive), whole = score("c.fovea", drive);
  EXPECT_GT(double(whole["points"]), 1.3 * double(part["points"]));
  EXPECT_LT(whole["te_gain_mean"], double(part["te_gain_mean"]) + 2);
  EXPECT_LT(whole["free_space_violations"], 0.03);
  EXPECT_GE(whole["coverage_5cm"], 0.95);

  // Written over only if asked, and never the maps that are read.
  EXPECT_THAT(run_fovea(merge).err, HasSubstr("--force"));
  EXPECT_EQ(run_fovea(merge + " --force --quiet").out, "");
  const std::string over =
      fmt::format("merge '{0}' '{1}' -o '{1}' --force", path("a.fovea"), path("b.fovea"));
  EXPECT_THAT(run_fovea(over).err, HasSubstr("a file that the command reads"));
  const ProgramRun resume =
      run_fovea(fmt::format("map '{}' -o '{}' --cameras 2 --frames 0:22 --hold-out 8:4 --resume",
                            drive.string(), path("c.fovea")));
  EXPECT_EQ(resume.exit_code, 1);
  EXPECT_THAT(resume.err, HasSubstr("of several drives"));
}

}  // namespace fovea::merge_program_test
