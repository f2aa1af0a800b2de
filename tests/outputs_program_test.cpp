// The program's outputs: what it refuses to replace, and what it does where nothing can be written.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/program.h"
#include "tests/sample_map.h"

namespace fovea::outputs_program_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class Outputs : public testing::Test {
 protected:
  void SetUp() override {
    write_sample_map(map_);
    whole_ = read_text(map_);
    std::filesystem::create_directory(folder_ / "drive");
    std::ofstream(folder_ / "poses.txt") << "1 0 0 0 0 1 0 0 0 0 1 0\n";
    std::ofstream(folder_ / "keys.toml") << "[surface]\nspacing = 0.1\n";
  }

  /// Runs with MAP, DRIVE, POSES, KEYS and FOLDER replaced by the files of this test.
  ProgramRun run(std::string arguments, const std::string& before = "") const {
    const std::pair<const char*, std::filesystem::path> names[] = {{"MAP", map_},
                                                                   {"DRIVE", folder_ / "drive"},
                                                                   {"POSES", folder_ / "poses.txt"},
                                                                   {"KEYS", folder_ / "keys.toml"},
                                                                   {"FOLDER", folder_.path()}};
    for (const auto& [name, path] : names) {
      for (std::size_t at = 0; (at = arguments.find(name, at)) != std::string::npos;) {
        arguments.replace(at, std::string(name).size(), path.string());
        at += path.string().size();
      }
    }
    return run_fovea(arguments, before);
  }

  void expect_refusal(const std::string& arguments, const std::string& says) const {
    const std::vector<std::string> names = folder_.names();
    const ProgramRun refused = run(arguments);
    EXPECT_EQ(refused.exit_code, 1) << arguments;
    EXPECT_THAT(refused.err, StartsWith("fovea: error: ")) << arguments;
    EXPECT_THAT(refused.err, HasSubstr(says)) << arguments;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
    EXPECT_EQ(read_text(map_), whole_) << arguments;
    EXPECT_EQ(folder_.names(), names) << arguments;
  }

  const TemporaryFolder folder_;
  const std::filesystem::path map_ = folder_ / "m.fovea";
  std::string whole_;
};

TEST_F(Outputs, NoCommandReplacesItsInput) {
  for (const char* arguments :
       {"export MAP MAP --format ply --force", "export MAP MAP --format kitti-poses --force",
        "evaluate MAP DRIVE --json MAP", "evaluate MAP DRIVE --html MAP",
        "crop MAP -o MAP --box 0,0,0,1,1,1 --force", "repair MAP -o MAP --force",
        "merge MAP FOLDER/b.fovea -o MAP --force", "merge FOLDER/b.fovea MAP -o MAP --force",
        "recolor MAP DRIVE -o MAP --force", "recolor MAP DRIVE --config KEYS -o KEYS --force",
        "localize DRIVE MAP -o MAP --force", "localize DRIVE MAP -o FOLDER/p.txt --report MAP",
        "localize DRIVE MAP --guess POSES -o POSES --force", "render MAP -o MAP --force",
        "map DRIVE --config KEYS -o KEYS --force", "map DRIVE --poses POSES -o POSES --force",
        "map DRIVE --poses POSES -o FOLDER/n.fovea --report POSES",
        "upsample POSES DRIVE POSES --force"}) {
    expect_refusal(arguments, "reads");
  }
}

TEST_F(Outputs, NoCommandReplacesAFileOfAnotherKind) {
  for (const char* arguments :
       {"map DRIVE -o FOLDER/n.fovea --report MAP", "map DRIVE -o POSES --force",
        "export FOLDER/b.fovea POSES --format ply --force"}) {
    expect_refusal(arguments, "the output exists and is");
  }
  expect_refusal("map DRIVE -o FOLDER/n.ply", "ends in '.ply'");
  expect_refusal("evaluate FOLDER/c.ply DRIVE --poses FOLDER/p.txt --json MAP", "is a Fovea map");
}

TEST_F(Outputs, TwoOutputsOfACommandAreTwoFiles) {
  expect_refusal("evaluate MAP DRIVE --json FOLDER/r --html FOLDER/./r", "one file");
  expect_refusal("map DRIVE -o FOLDER/n --report FOLDER/n --force", "one file");
  expect_refusal("localize DRIVE MAP -o FOLDER/p --report FOLDER/p", "one file");
}

TEST_F(Outputs, NoFolderIsMadeInAnInput) {
  expect_refusal("convert DRIVE -o DRIVE/out", "lies in");
  expect_refusal("reproduce DRIVE -o DRIVE", "lies in");
  expect_refusal("render MAP DRIVE --poses POSES -o DRIVE/out", "lies in");
  expect_refusal("export MAP FOLDER --format 3dtiles --force", "contains");
}

TEST_F(Outputs, AnOutputReplacesOneOfItsKind) {
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(run("export MAP FOLDER/p.txt --format kitti-poses --force").exit_code, 0);
    EXPECT_EQ(run("export MAP FOLDER/p.ply --force --quiet").exit_code, 0);
    EXPECT_EQ(run("crop MAP -o FOLDER/c.fovea --box=-99,-99,-99,99,99,99 --force").exit_code, 0);
  }
}

// run_fovea() redirects standard output after the shell's words, so each is run by a shell here.
int exit_code_of(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST_F(Outputs, OutputThatIsLostIsAnError) {
  const std::string err = (folder_ / "err").string(), full = (folder_ / "full").string();
  std::ofstream(full) << std::string(4096, ' ');
  const std::pair<std::string, std::string> losses[] = {
      {"", ">/dev/full"}, {"", ">&-"}, {"ulimit -f 4;", fmt::format(">>'{}'", full)}};
  for (const std::string& command :
       {fmt::format("info '{}'", map_.string()), fmt::format("info --json '{}'", map_.string()),
        fmt::format("info --digest '{}'", map_.string()), std::string("--help"),
        std::string("--version")}) {
    for (const auto& [before, target] : losses) {
      const int code = exit_code_of(
          fmt::format("{} '" FOVEA_PROGRAM "' {} {} 2>'{}'", before, command, target, err));
      EXPECT_EQ(code, 1) << command << target;
      EXPECT_THAT(read_text(err),
                  testing::AllOf(StartsWith("fovea: error: "), HasSubstr("standard output")))
          << command << target;
    }
  }
}

TEST_F(Outputs, AClosedPipeIsAnError) {
  const std::string err = (folder_ / "err").string(), code = (folder_ / "code").string();
  // The program starts when the reader of the pipe has ended.
  exit_code_of(fmt::format("{{ sleep 0.2; '" FOVEA_PROGRAM
                           "' info --json '{}' 2>'{}'; echo $? >'{}'; "
                           "}} | true",
                           map_.string(), err, code));
  EXPECT_EQ(read_text(code), "1\n");
  EXPECT_THAT(read_text(err), HasSubstr("standard output"));
}

// A file that took the number of the closed standard output would get its text.
TEST_F(Outputs, AClosedStandardOutputDoesNotEndUpInAFile) {
  const auto page = folder_ / "p.ply", other = folder_ / "q.ply";
  exit_code_of(fmt::format("'" FOVEA_PROGRAM "' export '{}' '{}' >&- 2>/dev/null <&-",
                           map_.string(), page.string()));
  EXPECT_EQ(run("export MAP FOLDER/q.ply").exit_code, 0);
  EXPECT_TRUE(read_text(page).empty() || read_text(page) == read_text(other));
}

TEST_F(Outputs, ALimitOnFileSizesIsAnErrorAndLeavesNothing) {
  for (const char* arguments :
       {"export MAP FOLDER/out.ply", "export MAP FOLDER/out.pcd", "export MAP FOLDER/out.las",
        "export MAP FOLDER/out.png", "export MAP FOLDER/out --format 3dtiles",
        "crop MAP -o FOLDER/out --box=-99,-99,-99,99,99,99", "repair MAP -o FOLDER/out"}) {
    const std::vector<std::string> names = folder_.names();
    const ProgramRun limited = run(arguments, "ulimit -f 8;");
    EXPECT_EQ(limited.exit_code, 1) << arguments << limited.err;
    EXPECT_THAT(limited.err, StartsWith("fovea: error: ")) << arguments;
    EXPECT_THAT(limited.err, HasSubstr("full")) << arguments;
    EXPECT_EQ(folder_.names(), names) << arguments;
  }
}

TEST_F(Outputs, AStepOfAJobEngineTellsAFullDiskFromBadInputs) {
  const std::string step = "export MAP FOLDER/out.ply --if-missing";
  EXPECT_EQ(run(step, "ulimit -f 8;").exit_code, 74);
  EXPECT_EQ(run("export FOLDER/none FOLDER/out.ply --if-missing").exit_code, 1);
}

}  // namespace fovea::outputs_program_test
