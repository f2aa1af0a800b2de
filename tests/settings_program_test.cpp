// `fovea settings`: what the program lists and converts, it reads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/map/map_store.h"
#include "tests/kitti_writer.h"
#include "tests/program.h"
#include "tests/synthetic_drive.h"

namespace fovea::settings_program_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string quoted(const std::filesystem::path& path) { return "'" + path.string() + "'"; }

TEST(SettingsProgram, ListsTheFilesOfTheRepository) {
  const std::filesystem::path source(FOVEA_SOURCE_DIR);
  EXPECT_EQ(run_fovea("settings list").out, read_text(source / "config/default.toml"));
  EXPECT_THAT(run_fovea("settings list --mapper paper").out, HasSubstr("\nmapper = \"paper\"\n"));
  EXPECT_EQ(run_fovea("settings docs").out, read_text(source / "docs/settings.md"));
}

TEST(SettingsProgram, MapsWithAConvertedFile) {
  const TemporaryFolder folder;
  const auto drive = write_kitti_drive(SyntheticDrive(street_scene(), 3, 0.8), folder.path());
  write_text(folder / "old.toml", "[surface]\nspacing = 0.3\n[moving]\nremove = false\n");
  const std::string map = "map " + quoted(drive) + " -o " + quoted(folder / "m.fovea") +
                          " --quiet --config " + quoted(folder / "old.toml");
  const ProgramRun refused = run_fovea(map);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, AllOf(HasSubstr("old.toml:"), HasSubstr("settings convert")));

  const ProgramRun converted = run_fovea("settings convert " + quoted(folder / "old.toml"));
  ASSERT_EQ(converted.exit_code, 0) << converted.err;
  write_text(folder / "old.toml", converted.out);
  const ProgramRun mapped = run_fovea(map);
  ASSERT_EQ(mapped.exit_code, 0) << mapped.err;
  EXPECT_THAT(MapReader(folder / "m.fovea").meta().at("config"),
              AllOf(HasSubstr("spacing_m = 0.3"), HasSubstr("remove = false")));
}

TEST(SettingsProgram, RefusesAFileOfOtherKeys) {
  const TemporaryFolder folder;
  write_text(folder / "other.toml", "[a]\nb = 1\n");
  const ProgramRun run = run_fovea("settings convert " + quoted(folder / "other.toml"));
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(run.err, AllOf(StartsWith("fovea: error: "), HasSubstr("other.toml:2")));
  EXPECT_EQ(run_fovea("settings").exit_code, 2);
  EXPECT_EQ(run_fovea("settings convert").exit_code, 2);
}

}  // namespace fovea::settings_program_test
