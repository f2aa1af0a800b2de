// Maps of format 6. tests/data/format_6.fovea is the map of a simulated drive of four frames, one
// of them held out and one missing. The expected values are those that the program printed and
// exported which wrote it. It did not export intensities: these are as the present program has
// them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>

#include "fovea/errors.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/map_store.h"
#include "tests/program.h"

namespace fovea::format_6_test {

using ::testing::HasSubstr;

/// FNV-1a, 64 bits, of a file but for the line that names the version of the program.
std::uint64_t hash_of(const std::filesystem::path& path) {
  std::string text = read_text(path);
  const std::size_t begin = text.find("comment fovea ");
  if (begin != std::string::npos) text.erase(begin, text.find('\n', begin) + 1 - begin);
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 0x100000001b3;
  }
  return hash;
}

class Format6 : public testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::copy_file(FOVEA_SOURCE_DIR "/tests/data/format_6.fovea", old_);
  }
  ProgramRun run(const std::string& command, const std::filesystem::path& map,
                 const std::string& more = "") const {
    return run_fovea(command + " '" + map.string() + "' " + more);
  }
  void expect_points_and_poses(const std::filesystem::path& map) const {
    const auto points = folder_ / "points.ply", poses = folder_ / "poses.txt";
    EXPECT_EQ(run("export", map, "'" + points.string() + "' --force").exit_code, 0);
    EXPECT_EQ(hash_of(points), 0x359d874ab4c707adu);
    EXPECT_EQ(run("export", map, "'" + poses.string() + "' --force --format kitti-poses").exit_code,
              0);
    EXPECT_EQ(hash_of(poses), 0x6adbe37e170737fcu);
    const MapReader reader(map);
    EXPECT_EQ(reader.size(), 2817u);
    EXPECT_EQ(reader.tile_sizes().size(), 29u);
    const std::vector<FrameRecord> frames = reader.frames();
    ASSERT_EQ(frames.size(), 4u);
    EXPECT_EQ(frames[1].status, FrameStatus::kHeldOut);
    EXPECT_EQ(frames[2].note, "missing scan: no scan 2 in the drive");
    EXPECT_TRUE(frames[0].views.empty());
    const MapMeta meta = reader.meta();
    EXPECT_EQ(map_tile_size(meta), 4);
    EXPECT_EQ(meta.at("origin.latitude_deg"), "49.009998432578236");
    EXPECT_FALSE(meta.contains("schema_version"));
    const std::vector<DriveRecord> drives = reader.drives();
    ASSERT_EQ(drives.size(), 1u);
    EXPECT_EQ(drives[0].name, "2026_01_01_drive_0001_sync");
    EXPECT_EQ(drives[0].end_frame, 4);
    ASSERT_TRUE(drives[0].origin);
    EXPECT_EQ(drives[0].origin->altitude, 113.91671746355868);
    EXPECT_FALSE(drives[0].calibration_fingerprint);
  }

  TemporaryFolder folder_;
  std::filesystem::path old_ = folder_ / "old.fovea", new_ = folder_ / "new.fovea";
};

TEST_F(Format6, IsReadAsItWasWritten) {
  expect_points_and_poses(old_);
  const ProgramRun check = run("info --check", old_);
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("only the tiles have checksums"));
}

TEST_F(Format6, RepairRewritesIt) {
  const ProgramRun repair = run("repair", old_, "-o '" + new_.string() + "'");
  ASSERT_EQ(repair.exit_code, 0) << repair.err;
  EXPECT_THAT(repair.out, HasSubstr("2817 points; 0 parts could not be read"));
  EXPECT_THAT(repair.out, HasSubstr("rewritten from format 6 in format 7"));
  EXPECT_EQ(MapReader(new_).format_version(), 7);
  expect_points_and_poses(new_);
  EXPECT_EQ(MapReader(new_).digest(), MapReader(old_).digest());
  EXPECT_EQ(run("info --check", new_).exit_code, 0);
}

TEST_F(Format6, IsNotWritten) {
  try {
    MapWriter::open(old_);
    FAIL() << "a map of format 6 was opened for writing";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("format version 6, which is only read"));
    EXPECT_THAT(error.what(), HasSubstr("fovea repair " + old_.string() + " -o OUT"));
  }
}

}  // namespace fovea::format_6_test
