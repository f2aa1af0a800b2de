// Errors of the command line and of the operating system: one line that names the cause.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "fovea/map/map_store.h"
#include "tests/background_program.h"
#include "tests/kitti_writer.h"
#include "tests/sample_map.h"

namespace fovea::error_line_program_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
namespace fs = std::filesystem;

class ErrorLine : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// One line without a call for a report.
  static void expect_line(const ProgramRun& run, int exit_code) {
    EXPECT_EQ(run.exit_code, exit_code) << run.err;
    EXPECT_THAT(run.err, StartsWith("fovea: error: "));
    EXPECT_THAT(run.err, Not(HasSubstr("report")));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_LT(run.err.size(), 700u);
  }
  TemporaryFolder folder_;
};

TEST_F(ErrorLine, NumbersThatAreNoneAreWrongUsage) {
  const std::vector<std::string> commands = {"map d -o x --threads {}",
                                             "map d -o x --memory {}",
                                             "map d -o x --rate {}",
                                             "evaluate m d --threads {}",
                                             "evaluate m d --first-frame {}",
                                             "merge a b -o x --memory {}",
                                             "merge a b -o x --threads {}",
                                             "localize d m -o x --threads {}",
                                             "recolor m d -o x --threads {}",
                                             "reproduce d -o x --threads {}",
                                             "simulate -o x --threads {}",
                                             "simulate -o x --seed {}",
                                             "simulate -o x --frames {}",
                                             "upsample a b c --rate {}",
                                             "upsample a b c --tau {}",
                                             "upsample a b c --camera {}",
                                             "register a b --voxel {}",
                                             "render m -o x --frame {}",
                                             "render m -o x --width {}",
                                             "render m -o x --poses p --rate {}",
                                             "view m --port {}",
                                             "export m x.glb --voxel {}"};
  for (const std::string& command : commands) {
    for (const char* value : {"-1", "nan", "1e400", "abc", "-inf"}) {
      const std::string line = fmt::format(fmt::runtime(command), value);
      SCOPED_TRACE(line);
      const ProgramRun run = run_fovea(line);
      expect_line(run, 2);
      EXPECT_THAT(run.err, HasSubstr(value));
      EXPECT_LT(run.err.size(), 150u);
    }
  }
}

TEST_F(ErrorLine, LoopsOfLinksAndLongNamesAreNamed) {
  fs::create_symlink("loop", folder_ / "loop");
  write_sample_map(folder_ / "a.fovea");
  const std::string name(300, 'x');
  const struct {
    std::string file, reason, remedy;
  } kinds[] = {{path("loop"), "Too many levels of symbolic links", "correct the symbolic links"},
               {path(name), "File name too long", "give a shorter"}};
  for (const auto& [file, reason, remedy] : kinds) {
    const std::vector<std::string> commands = {
        fmt::format("map '{}' -o '{}'", file, path("x")),
        fmt::format("info '{}'", file),
        fmt::format("export '{}' '{}'", file, path("x.ply")),
        fmt::format("export '{}' '{}' --format ply", path("a.fovea"), file),
        fmt::format("crop '{}' -o '{}' --box 0,0,0,1,1,1", file, path("x")),
        fmt::format("crop '{}' -o '{}' --box 0,0,0,1,1,1", path("a.fovea"), file),
        fmt::format("evaluate '{}' '{}'", path("a.fovea"), file),
        fmt::format("localize '{}' '{}' -o '{}'", file, path("a.fovea"), path("x"))};
    for (const std::string& command : commands) {
      SCOPED_TRACE(command);
      const ProgramRun run = run_fovea(command);
      expect_line(run, 1);
      EXPECT_THAT(run.err, AllOf(HasSubstr(reason), HasSubstr(remedy)));
    }
  }
  EXPECT_TRUE(fs::is_symlink(folder_ / "loop"));
}

#if !defined(FOVEA_SANITIZER)
// A limit that the program's start fits into.
TEST_F(ErrorLine, OutOfMemoryNamesTheCommandsOwnRemedy) {
  const auto writer = MapWriter::create(path("large.fovea"), false);
  put_sample_map(*writer, sample_tile_map(3'000'000));
  writer->commit();
  const std::string map = "'" + path("large.fovea") + "'";
  const std::vector<std::pair<std::string, std::string>> commands = {
      {fmt::format("evaluate {} '{}'", map, path("none")), "evaluate a part of the map"},
      {fmt::format("render {} -o '{}'", map, path("x.png")), "render a part of the map"}};
  for (const auto& [command, remedy] : commands) {
    SCOPED_TRACE(command);
    const ProgramRun run = run_fovea(command, "ulimit -v 200000; ");
    expect_line(run, 1);
    EXPECT_THAT(run.err, AllOf(HasSubstr("out of memory"), HasSubstr("ulimit -v"),
                               HasSubstr(remedy), Not(HasSubstr("map fewer frames"))));
  }
}

// A stack larger than the memory: then no thread can have one.
TEST_F(ErrorLine, ThreadsThatCannotStartAreNamed) {
  const ProgramRun run = run_fovea("info x", "ulimit -s 40000000; ulimit -v 20000000; ");
  if (run.err.find("ulimit") == std::string::npos) GTEST_SKIP() << "no such limits here";
  expect_line(run, 1);
  EXPECT_THAT(run.err, HasSubstr("no thread can be started"));
}
#endif

// The parent's memory is not the program's.
TEST_F(ErrorLine, ThePeakOfMemoryIsTheProgramsOwn) {
  constexpr std::size_t kParent = std::size_t{1} << 30;
  const auto drive = write_kitti_drive(SyntheticDrive(street_scene(), 2, 0.8), folder_.path());
  const std::vector<char> memory(kParent, 'x');
  BackgroundProgram program({"map", drive.string(), "-o", path("a.fovea")});
  const ProgramRun run = program.wait();
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const std::size_t end = run.out.find(" MB peak");
  ASSERT_NE(end, std::string::npos) << run.out;
  const double peak = std::atof(run.out.c_str() + run.out.rfind(' ', end - 1));
  EXPECT_GT(peak, 10);
  EXPECT_LT(peak, 700) << memory.back();
}

}  // namespace fovea::error_line_program_test
