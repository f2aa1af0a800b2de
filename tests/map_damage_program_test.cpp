// A damaged map as a user meets it: all commands refuse it with one remedy, which works.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <nlohmann/json.hpp>

#include "fovea/map/map_store.h"
#include "tests/kitti_writer.h"
#include "tests/program.h"

namespace fovea::map_damage_program_test {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class MapDamageProgram : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    const SyntheticDrive drive(street_scene(), 4, 0.8);
    drive_ = write_kitti_drive(drive, scratch_->path());
    const ProgramRun run =
        run_fovea(fmt::format("map '{}' -o '{}' --set surface.spacing_m=0.2 --hold-out 4:2 --quiet",
                              drive_.string(), whole().string()));
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  static void TearDownTestSuite() { delete scratch_; }

  static std::filesystem::path whole() { return *scratch_ / "whole.fovea"; }
  std::string path(const std::string& name) const { return "'" + (own_ / name).string() + "'"; }
  /// A copy of the map, changed by SQL.
  void damage(const std::string& sql) const {
    std::filesystem::copy_file(whole(), own_ / "m.fovea",
                               std::filesystem::copy_options::overwrite_existing);
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open((own_ / "m.fovea").c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
  }
  /// Bytes of the page on which the table `meta` begins, as `dd` writes them.
  void damage_page_of_meta() const {
    std::string bytes = read_text(whole());
    for (std::size_t i = 0; i < 200; ++i) bytes[8192 + i] = static_cast<char>(37 * i + 11);
    write_text(own_ / "m.fovea", bytes);
  }
  /// Runs all commands that read a map.
  void expect_refused_by_all(const std::string& names, bool by_tiles_on_demand = true) const {
    const std::string map = path("m.fovea"), drive = "'" + drive_.string() + "'";
    std::vector<std::string> commands = {
        "info " + map,
        "info --json " + map,
        "info --digest " + map,
        "info --check " + map,
        "export " + map + " " + path("o.ply"),
        "export " + map + " " + path("o.txt") + " --format kitti-poses",
        "crop " + map + " -o " + path("o.fovea") + " --box=-9,-9,-9,9,9,9",
        "merge '" + whole().string() + "' " + map + " -o " + path("o.fovea"),
        "recolor " + map + " " + drive + " -o " + path("o.fovea"),
        "evaluate " + map + " " + drive,
        "render " + map + " -o " + path("o.png"),
    };
    if (by_tiles_on_demand) {
      commands.push_back("view --no-browser --port 0 " + map);
      commands.push_back("localize " + drive + " " + map + " -o " + path("o.txt"));
    }
    for (const std::string& command : commands) {
      const ProgramRun run = run_fovea(command, "timeout 60 ");
      EXPECT_EQ(run.exit_code, 1) << command;
      EXPECT_THAT(run.err, StartsWith("fovea: error: ")) << command;
      EXPECT_THAT(run.err + run.out, HasSubstr(names)) << command;
      EXPECT_THAT(run.err, HasSubstr(kRestoreMap)) << command;
      EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    }
    for (const char* name : {"o.ply", "o.txt", "o.fovea", "o.png"}) {
      EXPECT_FALSE(std::filesystem::exists(own_ / name)) << name;
    }
  }
  ProgramRun repair() const {
    return run_fovea("repair " + path("m.fovea") + " -o " + path("saved.fovea") + " --force");
  }

  static TemporaryFolder* scratch_;
  static std::filesystem::path drive_;
  TemporaryFolder own_;
};
TemporaryFolder* MapDamageProgram::scratch_ = nullptr;
std::filesystem::path MapDamageProgram::drive_;

TEST_F(MapDamageProgram, ADamagedPageOfMeta) {
  damage_page_of_meta();
  expect_refused_by_all("table 'meta'");
  const ProgramRun saved = repair();
  EXPECT_EQ(saved.exit_code, 0) << saved.err;
  EXPECT_THAT(saved.out, HasSubstr("restored from other tables: cameras, "));
  EXPECT_THAT(saved.out, HasSubstr("lost: "));
  EXPECT_THAT(saved.out, HasSubstr("config, "));
  EXPECT_THAT(saved.out, HasSubstr("a corrected calibration, if the map had one"));
  EXPECT_EQ(MapReader(own_ / "saved.fovea").size(), MapReader(whole()).size());

  const ProgramRun text = run_fovea("info " + path("saved.fovea"));
  EXPECT_THAT(text.out, HasSubstr("saved.fovea (repaired"));
  EXPECT_THAT(text.out, HasSubstr("cameras 2"));
  EXPECT_THAT(text.out, HasSubstr("lost: "));
  const auto json = nlohmann::json::parse(run_fovea("info --json " + path("saved.fovea")).out);
  EXPECT_EQ(json.at("repaired"), true);
  EXPECT_EQ(json.at("cropped"), false);
  EXPECT_EQ(json.at("merged"), false);
  EXPECT_EQ(run_fovea("info --check " + path("saved.fovea")).exit_code, 0);
  EXPECT_EQ(run_fovea("export " + path("saved.fovea") + " " + path("p.ply")).exit_code, 0);
}

TEST_F(MapDamageProgram, AMissingRowAndAWrongOne) {
  damage("DELETE FROM views WHERE frame=1");
  expect_refused_by_all("table 'views'");
  EXPECT_EQ(repair().exit_code, 0);
  EXPECT_EQ(run_fovea("info --check " + path("saved.fovea")).exit_code, 0);
}

TEST_F(MapDamageProgram, ADamagedTile) {
  damage("UPDATE tiles SET color=zeroblob(length(color)) WHERE rowid=3");
  expect_refused_by_all("tile ", /*by_tiles_on_demand=*/false);
  const ProgramRun saved = repair();
  EXPECT_THAT(saved.out, AllOf(HasSubstr("left out: "), HasSubstr("tile ")));
  EXPECT_THAT(saved.out, Not(HasSubstr("lost: ")));
}

TEST_F(MapDamageProgram, EachTableIsCheckedByInfoAndExport) {
  for (const char* table : {"drives", "sensors", "frames", "submaps", "counts"}) {
    damage(std::string("UPDATE ") + table + " SET checksum=checksum+1");
    for (const std::string& command : {"info " + path("m.fovea"), "info --check " + path("m.fovea"),
                                       "export " + path("m.fovea") + " " + path("o.ply")}) {
      const ProgramRun run = run_fovea(command);
      EXPECT_EQ(run.exit_code, 1) << command;
      EXPECT_THAT(run.out + run.err, HasSubstr(std::string("table '") + table + "'")) << command;
      EXPECT_THAT(run.err, HasSubstr(kRestoreMap)) << command;
    }
    EXPECT_EQ(repair().exit_code, 0) << table;
    EXPECT_EQ(run_fovea("info --check " + path("saved.fovea")).exit_code, 0) << table;
  }
}

TEST_F(MapDamageProgram, InfoShowsWhatAMapIs) {
  const std::string map = "'" + whole().string() + "'";
  const ProgramRun info = run_fovea("info " + map);
  EXPECT_THAT(info.out, StartsWith(whole().string() + "\n"));
  EXPECT_EQ(
      run_fovea("crop " + map + " -o " + path("c.fovea") + " --box=-99,-99,-9,99,99,0").exit_code,
      0);
  EXPECT_THAT(run_fovea("info " + path("c.fovea")).out, HasSubstr("c.fovea (cropped)\n"));
  const auto cropped = nlohmann::json::parse(run_fovea("info --json " + path("c.fovea")).out);
  EXPECT_EQ(cropped.at("cropped"), true);
  EXPECT_EQ(cropped.at("complete"), true);
  EXPECT_EQ(cropped.at("repaired"), false);

  const ProgramRun merged =
      run_fovea("merge " + map + " " + path("c.fovea") + " -o " + path("m.fovea") + " --force");
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_THAT(run_fovea("info " + path("m.fovea")).out, HasSubstr("m.fovea (cropped, merged)\n"));
  const auto json = nlohmann::json::parse(run_fovea("info --json " + path("m.fovea")).out);
  EXPECT_EQ(json.at("merged"), true);
  EXPECT_EQ(json.at("drives").size(), 2u);
  EXPECT_EQ(json.at("drives").at(1).at("first_frame"), 4);
}

}  // namespace fovea::map_damage_program_test
