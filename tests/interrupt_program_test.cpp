// Signals: every command ends soon, with the exit code of the signal, and leaves no partial output.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/drive/recordings/ros_messages.h"
#include "fovea/map/map_store.h"
#include "tests/background_program.h"
#include "tests/cdr_writer.h"
#include "tests/kitti_writer.h"
#include "tests/mcap_writer.h"
#include "tests/sample_map.h"

namespace fovea::interrupt_program_test {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// 2 s on an idle machine; tests run next to others.
constexpr double kLatest = 10;

/// A recording of scans alone, with as many points as real ones.
void write_recording(const fs::path& file) {
  constexpr std::uint32_t kScans = 100, kPoints = 20'000, kBytes = 12;
  std::string records = mcap::channel(1, "/points", "cdr", std::string(ros::kPointCloud));
  std::string points;
  for (std::uint32_t i = 0; i < 3 * kPoints; ++i) points += mcap::number(1 + float(i % 50));
  for (std::uint32_t scan = 0; scan < kScans; ++scan) {
    CdrWriter message;
    message.header(1'700'000'000 + int(scan), 0, "lidar").number(1u).number(kPoints).number(3u);
    std::uint32_t offset = 0;
    for (const char* name : {"x", "y", "z"}) {
      message.text(name).number(offset).number(std::uint8_t{7}).number(1u);
      offset += 4;
    }
    message.number(std::uint8_t{0}).number(kBytes).number(kBytes * kPoints).bytes(points);
    records += mcap::message(1, message.number(std::uint8_t{1}).message());
  }
  std::ofstream(file, std::ios::binary) << mcap::file_of(records);
}

/// A scan that takes long to register or upsample: a curved wall in front of the vehicle.
void write_large_scan(const fs::path& file) {
  std::string bytes;
  for (int row = 0; row < 400; ++row) {
    for (int column = 0; column < 1000; ++column) {
      const float y = 0.01f * float(column - 500), z = 0.005f * float(row - 200);
      for (const float value : {10 + 0.1f * std::sin(y), y, z, 0.5f}) bytes += mcap::number(value);
    }
  }
  std::ofstream(file, std::ios::binary) << bytes;
}

class Interrupt : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    inputs_ = new TemporaryFolder;
    drive_ = write_kitti_drive(SyntheticDrive(street_scene(), 6, 0.8), inputs_->path()).string();
    const ProgramRun run =
        run_fovea(fmt::format("map '{}' -o '{}' --hold-out 4:2", drive_, input("map.fovea")));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto writer = MapWriter::create(input("large.fovea"), false);
    put_sample_map(*writer, sample_tile_map(400'000));
    writer->commit();
    std::ofstream poses(input("poses.txt"));
    for (int i = 0; i < 2000; ++i) poses << "1 0 0 1 0 1 0 0 0 0 1 0\n";
    write_recording(input("drive.mcap"));
    write_large_scan(input("scan.bin"));
  }
  static void TearDownTestSuite() { delete inputs_; }

  static std::string input(const std::string& name) { return (*inputs_ / name).string(); }
  std::string own(const std::string& name) const { return (own_ / name).string(); }
  bool has_partial_output() const {
    for (const auto& entry : fs::recursive_directory_iterator(own_.path())) {
      if (entry.path().extension() == ".partial") return true;
    }
    return false;
  }
  /// Whether an output has contents. Commands that write at their end have none before.
  bool has_partial_contents() const {
    std::error_code ignored;  // files get other names meanwhile
    fs::recursive_directory_iterator entries(own_.path(), ignored);
    for (; !ignored && entries != end(entries); entries.increment(ignored)) {
      if (entries->is_regular_file(ignored) && entries->file_size(ignored) > 0) return true;
    }
    return false;
  }

  /// What a program has reached: it runs, its output is open, or has contents.
  enum class At { kRunning, kOpen, kContents };

  bool has_reached(At at, const BackgroundProgram& program) const {
    switch (at) {
      case At::kRunning:
        return program.waits_for_signals();
      case At::kOpen:
        return has_partial_output();
      case At::kContents:
        return has_partial_contents();
    }
    return false;
  }

  /// Sends the signal once the program has reached this. A fast command may end before: then once
  /// more.
  ProgramRun interrupted(const std::vector<std::string>& arguments, int signal, At at) const {
    ProgramRun run;
    for (int attempt = 0; attempt < 10; ++attempt) {
      BackgroundProgram program(arguments);
      if (program.wait_until([&] { return has_reached(at, program); })) {
        const Clock::time_point start = Clock::now();
        program.kill(signal);
        run = program.wait();
        EXPECT_LT(std::chrono::duration<double>(Clock::now() - start).count(), kLatest);
        if (run.exit_code != 0) return run;
      }
      run = program.wait();
      for (const std::string& name : own_.names()) fs::remove_all(own_ / name);
    }
    ADD_FAILURE() << arguments.front() << " was never interrupted: " << run.err;
    return run;
  }

  void expect_nothing_left(const std::vector<std::string>& arguments, int signal,
                           At at = At::kContents) const {
    SCOPED_TRACE(arguments.front());
    const ProgramRun run = interrupted(arguments, signal, at);
    EXPECT_EQ(run.exit_code, 128 + signal) << run.err;
    EXPECT_THAT(run.err, StartsWith("fovea: error: interrupted by SIG"));
    EXPECT_THAT(run.err, HasSubstr(at == At::kRunning ? "no output was left" : "not written: "));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_THAT(own_.names(), IsEmpty());
  }

  static TemporaryFolder* inputs_;
  static std::string drive_;
  TemporaryFolder own_;
};
TemporaryFolder* Interrupt::inputs_ = nullptr;
std::string Interrupt::drive_;

TEST_F(Interrupt, CommandsThatReadAMapLeaveNothing) {
  const std::string map = input("map.fovea"), large = input("large.fovea");
  expect_nothing_left({"export", large, own("a.ply")}, SIGINT);
  expect_nothing_left({"export", large, own("a.las")}, SIGTERM);
  expect_nothing_left({"export", large, own("tiles"), "--format", "3dtiles"}, SIGHUP);
  expect_nothing_left({"export", map, own("mesh.ply"), "--format", "mesh"}, SIGINT, At::kOpen);
  expect_nothing_left({"crop", large, "-o", own("a.fovea"), "--box", "-9,-9,-9,9,99,9"}, SIGHUP);
  expect_nothing_left({"repair", large, "-o", own("a.fovea")}, SIGTERM);
  expect_nothing_left({"merge", map, map, "-o", own("a.fovea")}, SIGINT);
}

TEST_F(Interrupt, CommandsThatReadADriveLeaveNothing) {
  const std::string map = input("map.fovea");
  expect_nothing_left({"evaluate", map, drive_, "--json", own("a.json"), "--html", own("a.html")},
                      SIGINT, At::kOpen);
  expect_nothing_left({"recolor", map, drive_, "-o", own("a.fovea")}, SIGTERM);
  expect_nothing_left({"localize", drive_, map, "-o", own("poses.txt")}, SIGHUP, At::kOpen);
  expect_nothing_left({"render", map, "--poses", input("poses.txt"), "--camera",
                       "64,32,40,40,32,16", "-o", own("rendered")},
                      SIGINT);
  expect_nothing_left({"render", map, "-o", own("a.png")}, SIGTERM, At::kOpen);
}

TEST_F(Interrupt, CommandsThatMakeADriveLeaveNothing) {
  for (const char* format : {"kitti", "generic"}) {
    expect_nothing_left(
        {"simulate", "-o", own("a"), "--frames", "1000", "--format", format, "--set",
         "camera.width=96", "--set", "camera.height=32", "--set", "lidar.columns=90"},
        SIGTERM);
  }
}

TEST_F(Interrupt, CommandsThatReadScansOrARecordingLeaveNothing) {
  const std::string scan = input("scan.bin"), calibration = input("2011_09_26");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    expect_nothing_left({"convert", input("drive.mcap"), "-o", own("a")}, signal);
    expect_nothing_left({"upsample", scan, calibration, own("a.ply")}, signal, At::kRunning);
    expect_nothing_left({"upsample", scan, calibration, own("a.ply")}, signal, At::kOpen);
  }
}

TEST_F(Interrupt, CommandsWithoutOutputEnd) {
  const std::string scan = input("scan.bin");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    expect_nothing_left({"info", input("large.fovea")}, signal, At::kRunning);
    expect_nothing_left({"register", scan, scan, "--voxel", "0"}, signal, At::kRunning);
  }
}

// The rows that are done stay; the map of the row at hand does not.
TEST_F(Interrupt, ReproduceKeepsTheRowsThatAreDone) {
  BackgroundProgram program(
      {"reproduce", drive_, "-o", own("a"), "--rows", "E0,E1,E2,E3,E4,E5,E6", "--quiet"});
  const fs::path rows = own_ / "a" / ("rows-" + fs::path(drive_).filename().string());
  ASSERT_TRUE(program.wait_until(
      [&] { return fs::exists(rows / "E0.json") && fs::exists(rows / "E1.fovea"); }));
  program.kill(SIGINT);
  const ProgramRun run = program.wait();
  EXPECT_EQ(run.exit_code, 130);
  EXPECT_THAT(run.err, HasSubstr("E0.json"));
  for (const auto& entry : fs::directory_iterator(rows)) {
    EXPECT_EQ(entry.path().extension(), ".json") << entry.path();
  }
}

TEST_F(Interrupt, AnOutputToReplaceStaysAsItWas) {
  const std::string map = input("map.fovea");
  ASSERT_EQ(run_fovea("export " + map + " " + own("a.ply")).exit_code, 0);
  const std::string before = read_text(own("a.ply"));
  BackgroundProgram program({"export", input("large.fovea"), own("a.ply"), "--force"});
  ASSERT_TRUE(program.wait_until([&] { return has_partial_output(); }));
  program.kill(SIGINT);
  EXPECT_EQ(program.wait().exit_code, 130);
  EXPECT_EQ(read_text(own("a.ply")), before);
  EXPECT_THAT(own_.names(), ElementsAre("a.ply"));
}

// With little memory each frame is committed at once.
TEST_F(Interrupt, MapKeepsTheFramesMappedAndResumesThem) {
  const auto map_info = [&](const std::string& name) {
    return nlohmann::json::parse(run_fovea("info --json '" + own(name) + "'").out);
  };
  const auto digest = [&](const std::string& name) {
    return run_fovea("info --digest '" + own(name) + "'").out;
  };
  ASSERT_EQ(run_fovea("map '" + drive_ + "' -o '" + own("whole.fovea") + "'").exit_code, 0);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const std::string name = fmt::format("{}.fovea", signal);
    BackgroundProgram program({"map", drive_, "-o", own(name), "--rate", "5", "--memory", "1MiB",
                               "--report", own("report.json")});
    ASSERT_TRUE(program.wait_until([&] { return fs::exists(own(name)); }));
    program.kill(signal);
    const ProgramRun run = program.wait();
    EXPECT_EQ(run.exit_code, 128 + signal);
    EXPECT_THAT(run.out, HasSubstr("--resume"));
    EXPECT_EQ(map_info(name)["meta"]["complete"], "0");
    EXPECT_GT(map_info(name)["frames"], 0);
    EXPECT_EQ(nlohmann::json::parse(read_text(own("report.json")))["map"]["interrupted"], true);
    const ProgramRun resumed =
        run_fovea(fmt::format("map '{}' -o '{}' --resume", drive_, own(name)));
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_EQ(digest(name), digest("whole.fovea"));
  }
  EXPECT_THAT(own_.names(),
              ElementsAre("1.fovea", "15.fovea", "2.fovea", "report.json", "whole.fovea"));
}

TEST_F(Interrupt, MapWithoutAFrameLeavesNothing) {
  for (const char* more : {"--quiet", "--calibrate"}) {
    BackgroundProgram program({"map", drive_, "-o", own("a.fovea"), "--report", own("report.json"),
                               "--rate", "0.01", more});
    ASSERT_TRUE(program.wait_until([&] { return fs::exists(own("report.json.partial")); }));
    program.kill(SIGINT);
    const ProgramRun run = program.wait();
    EXPECT_EQ(run.exit_code, 130) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_THAT(run.err, StartsWith("fovea: error: interrupted"));
    EXPECT_THAT(own_.names(), IsEmpty()) << more;
  }
}

TEST_F(Interrupt, ViewEndsWithTheSignalsExitCode) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    BackgroundProgram program({"view", input("map.fovea"), "--no-browser", "--port", "0"});
    ASSERT_TRUE(program.wait_until(
        [&] { return program.printed().find("is shown at") != std::string::npos; }));
    program.kill(signal);
    EXPECT_EQ(program.wait().exit_code, 128 + signal);
  }
}

TEST_F(Interrupt, ALiveMapIsWholeWhenItsViewEnds) {
  BackgroundProgram program({"map", drive_, "-o", own("a.fovea"), "--live=0"});
  ASSERT_TRUE(program.wait_until(
      [&] { return program.printed().find("is still shown") != std::string::npos; }));
  program.kill(SIGTERM);
  EXPECT_EQ(program.wait().exit_code, 143);
  EXPECT_THAT(own_.names(), ElementsAre("a.fovea"));
}

// nohup(1) makes a program ignore hang-ups.
TEST_F(Interrupt, AnIgnoredHangUpIsIgnored) {
  BackgroundProgram program({"map", drive_, "-o", own("a.fovea"), "--rate", "20"}, SIGHUP);
  ASSERT_TRUE(program.wait_until([&] { return has_partial_output(); }));
  program.kill(SIGHUP);
  EXPECT_EQ(program.wait().exit_code, 0);
  EXPECT_THAT(own_.names(), ElementsAre("a.fovea"));
}

}  // namespace fovea::interrupt_program_test
