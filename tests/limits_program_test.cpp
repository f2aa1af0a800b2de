// What no valid input has: special files, files of gigabytes, texts of thousands of levels, poses
// far from any drive, and control characters in names.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>

#include "fovea/map/map_store.h"
#include "fovea/map/meta_keys.h"
#include "tests/kitti_writer.h"
#include "tests/program.h"
#include "tests/sample_map.h"
#include "tests/synthetic_drive.h"

namespace fovea::limits_program_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kLimit = "timeout -s KILL 60 ";

std::string repeated(const std::string& part, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += part;
  return text;
}

class LimitsProgram : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    write_kitti_drive(SyntheticDrive(street_scene(), 3, 0.8), scratch_->path());
  }
  static void TearDownTestSuite() { delete scratch_; }

  LimitsProgram() {
    std::filesystem::copy(*scratch_ / "2011_09_26", folder_ / "2011_09_26",
                          std::filesystem::copy_options::recursive);
  }

  std::filesystem::path drive() const {
    return folder_ / "2011_09_26" / "2011_09_26_drive_0001_sync";
  }
  std::string quoted(const std::string& name) const {
    return "'" + (folder_ / name).string() + "'";
  }
  ProgramRun map(const std::string& more = "") const {
    return run_fovea("map '" + drive().string() + "' -o " + quoted("m.fovea") + " --force " + more,
                     kLimit);
  }
  static void replace_by_pipe(const std::filesystem::path& file) {
    std::filesystem::remove(file);
    ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  }
  static void expect_error(const ProgramRun& run, const std::string& says) {
    EXPECT_EQ(run.exit_code, 1) << run.err;
    EXPECT_THAT(run.err, AllOf(testing::StartsWith("fovea: error: "), HasSubstr(says)));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
  /// A map whose meta data have one value replaced. Its checksums are right.
  void write_map_with(const std::string& key, const std::string& value) const {
    std::filesystem::remove(folder_ / "crafted.fovea");
    const auto writer = MapWriter::create(folder_ / "crafted.fovea", false);
    put_sample_map(*writer, sample_tile_map());
    writer->put_meta(key, value);
    writer->commit();
  }

  static TemporaryFolder* scratch_;
  TemporaryFolder folder_;
};
TemporaryFolder* LimitsProgram::scratch_ = nullptr;

TEST_F(LimitsProgram, PipesInPlaceOfADrivesFilesDoNotHang) {
  replace_by_pipe(drive() / "image_02/data/0000000001.png");
  const ProgramRun image = map();
  EXPECT_EQ(image.exit_code, 0) << image.err;
  EXPECT_THAT(image.err, HasSubstr("skipped: 1 frame"));
  for (const char* file : {"velodyne_points/timestamps.txt", "../calib_velo_to_cam.txt"}) {
    replace_by_pipe(drive() / file);
    expect_error(map(), "it is a pipe");
    std::filesystem::remove(drive() / file);
    std::filesystem::copy(*scratch_ / "2011_09_26/2011_09_26_drive_0001_sync" / file,
                          drive() / file);
  }
  replace_by_pipe(drive() / "velodyne_points/data/0000000001.bin");
  replace_by_pipe(drive() / "oxts/data/0000000001.txt");
  const ProgramRun scan = map();
  EXPECT_EQ(scan.exit_code, 0) << scan.err;
  EXPECT_THAT(scan.err, HasSubstr("skipped: 1 frame"));
}

TEST_F(LimitsProgram, PipesAndDevicesAsArgumentsDoNotHang) {
  replace_by_pipe(folder_ / "pipe");
  const std::string pipe = quoted("pipe"), bin = "'" + (drive() / "velodyne_points/data/").string();
  for (const std::string& command : std::vector<std::string>{
           "info " + pipe, "export " + pipe + " " + quoted("o.ply"),
           "evaluate " + pipe + " '" + drive().string() + "'", "view " + pipe + " --no-browser",
           "register " + pipe + " " + bin + "0000000000.bin'",
           "merge " + pipe + " " + pipe + " -o o",
           "map '" + drive().string() + "' -o o.fovea --config " + pipe,
           "map '" + drive().string() + "' -o o.fovea --poses " + pipe,
           "convert " + pipe + " -o " + quoted("o"), "info /dev/zero",
           "register /dev/zero /dev/zero"}) {
    const ProgramRun run = run_fovea(command, "cd '" + folder_.path().string() + "'; " + kLimit);
    EXPECT_EQ(run.exit_code, 1) << command << "\n" << run.err;
    EXPECT_THAT(run.err, HasSubstr(command.find("/dev") == std::string::npos ? "it is a pipe"
                                                                             : "it is a device"))
        << command;
  }
}

TEST_F(LimitsProgram, FilesOfGigabytesAreNamedAndTakeNoMemory) {
  const auto scan = drive() / "velodyne_points/data/0000000001.bin";
  std::filesystem::resize_file(scan, 6'000'000'000);  // sparse
  const std::string report = quoted("r.json");
  const ProgramRun run =
      run_fovea("map '" + drive().string() + "' -o " + quoted("m.fovea") + " --report " + report,
                std::string("ulimit -v 3000000; ") + kLimit);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err + run.out,
              AllOf(HasSubstr("skipped: 1 frame"), HasSubstr("more than any scan"),
                    HasSubstr("0000000001.bin")));
  expect_error(run_fovea("register '" + scan.string() + "' '" + scan.string() + "'", kLimit),
               "6000000000 bytes, more than any scan");
  write_text(folder_ / "c.toml", "");
  std::filesystem::resize_file(folder_ / "c.toml", 5'000'000);
  expect_error(map("--config " + quoted("c.toml")), "more than any configuration");
}

TEST_F(LimitsProgram, TextsOfThousandsOfLevelsAreRefused) {
  for (const std::string& text : {repeated("a.", 50'000) + "a = 1", "a = " + repeated("[", 50'000),
                                  repeated("a = {", 50'000)}) {
    write_text(folder_ / "c.toml", text);
    expect_error(map("--config " + quoted("c.toml")), "over 32 levels deep");
    write_map_with(meta_key::kConfig, text);
    const std::string crafted = quoted("crafted.fovea");
    for (const std::string& command :
         {"merge " + crafted + " " + crafted + " -o " + quoted("o.fovea"),
          "recolor " + crafted + " '" + drive().string() + "' -o " + quoted("o.fovea")}) {
      const ProgramRun run = run_fovea(command, kLimit);
      EXPECT_EQ(run.exit_code, 1) << command << "\n" << run.err.substr(0, 500);
    }
  }
}

TEST_F(LimitsProgram, APoseFarFromAnyDriveIsRefused) {
  std::string poses = repeated("1 0 0 0 0 1 0 0 0 0 1 0\n", 2);
  write_text(folder_ / "p.txt", poses + "1 0 0 1e300 0 1 0 0 0 0 1 0\n");
  expect_error(map("--poses " + quoted("p.txt")), "p.txt:3");
}

TEST_F(LimitsProgram, ControlCharactersFromFilesDoNotReachTheTerminal) {
  const std::string evil =
      "x\x1b]0;pwned\x07\x1b[2J\xc2\x9b"
      "2Jy\r\nfovea: error: forged";
  for (const char* key : {meta_key::kDriveName, meta_key::kNotes, meta_key::kVariant,
                          meta_key::kConfig, meta_key::kCrop, meta_key::kHoldOut}) {
    write_map_with(key, evil);
    const ProgramRun text = run_fovea("info " + quoted("crafted.fovea"));
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_THAT(text.out, AllOf(HasSubstr("x?]0;pwned??[2J?2Jy?"), Not(HasSubstr("\x1b")),
                                Not(HasSubstr("\xc2\x9b")), Not(HasSubstr("\r"))))
        << key;
    const ProgramRun json = run_fovea("info --json " + quoted("crafted.fovea"));
    EXPECT_THAT(json.out, AllOf(Not(HasSubstr("\x1b")), Not(HasSubstr("\xc2\x9b")))) << key;
    EXPECT_EQ(nlohmann::json::parse(json.out).at("meta").at(key), evil);
  }
  const std::string name = "a\x1b[31m\xc2\x9b.fovea";
  const ProgramRun missing = run_fovea("info " + quoted(name));
  EXPECT_EQ(missing.exit_code, 1);
  EXPECT_THAT(missing.err, AllOf(HasSubstr("a [31m .fovea"), Not(HasSubstr("\x1b")),
                                 Not(HasSubstr("\xc2\x9b"))));
  const auto renamed = folder_ / "2011_09_26" / "d\x1b[31m\n_sync";
  std::filesystem::rename(drive(), renamed);
  std::filesystem::remove(renamed / "oxts/timestamps.txt");  // a note names the drive
  const ProgramRun run =
      run_fovea("map '" + renamed.string() + "' -o " + quoted("m.fovea") + " --force");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("d?[31m?_sync"), Not(HasSubstr("\x1b"))));
}

}  // namespace fovea::limits_program_test
