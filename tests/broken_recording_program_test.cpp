// Recordings with pauses, gaps in their numbers, files that vanish and files that are damaged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "fovea/geometry/pose_file.h"
#include "tests/kitti_writer.h"
#include "tests/program.h"

namespace fovea::broken_recording_program_test {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr int kFrames = 8;

class BrokenRecording : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    SyntheticDrive drive(town_scene(), kFrames, 0.8);
    T_local_lidar_ = drive.T_local_lidar;
    whole_ = write_kitti_drive(drive, scratch_->path());
  }
  static void TearDownTestSuite() { delete scratch_; }

  void SetUp() override {
    const fs::path root = own_ / "date";
    fs::copy(whole_.parent_path(), root, fs::copy_options::recursive);
    drive_ = root / whole_.filename();
  }

  ProgramRun map(const std::string& more = "") const {
    return run_fovea(fmt::format("map '{}' -o '{}' {}", drive_.string(), output().string(), more));
  }
  fs::path output() const { return own_ / "out.fovea"; }
  nlohmann::json info() const {
    return nlohmann::json::parse(run_fovea("info --json '" + output().string() + "'").out);
  }
  std::string digest() const { return run_fovea("info --digest '" + output().string() + "'").out; }
  std::vector<RigidMotion> poses(int first, int end) const {
    const fs::path file = own_ / "poses.txt";
    const ProgramRun run = run_fovea(fmt::format("export '{}' '{}' --format kitti-poses --force",
                                                 output().string(), file.string()));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return read_poses(file, 0, end - first);
  }
  fs::path scan(int index) const {
    return drive_ / "velodyne_points/data" / (kitti_stem(index) + ".bin");
  }

  static TemporaryFolder* scratch_;
  static fs::path whole_;
  static std::vector<RigidMotion> T_local_lidar_;
  TemporaryFolder own_;
  fs::path drive_;
};
TemporaryFolder* BrokenRecording::scratch_ = nullptr;
fs::path BrokenRecording::whole_;
std::vector<RigidMotion> BrokenRecording::T_local_lidar_;

/// The lines of a stamp file, with almost an hour between the first four and the others.
/// @param delay  in units of 10 ms, 0 to 9, added to each
std::string paused(const std::string& stamps, char delay) {
  std::string result;
  std::istringstream lines(stamps);
  std::string line;
  for (int i = 0; std::getline(lines, line); ++i) {
    if (i >= 4) line.replace(line.find(':') + 1, 2, "59");  // minutes
    line[line.find('.') + 2] = delay;
    result += line + "\n";
  }
  return result;
}

TEST_F(BrokenRecording, APauseOfScansAndNavigationKeepsThePoses) {
  // Records lie 10 ms behind the scans: none has the time of a scan.
  for (const auto& [sensor, delay] : {std::pair("velodyne_points", '0'), std::pair("oxts", '1')}) {
    const fs::path file = drive_ / sensor / "timestamps.txt";
    write_text(file, paused(read_text(file), delay));
  }
  ASSERT_EQ(map().exit_code, 0);
  const std::vector<RigidMotion> found = poses(0, kFrames);
  ASSERT_EQ(found.size(), std::size_t(kFrames));
  for (std::size_t i = 0; i < found.size(); ++i) {
    const RigidMotion truth = T_local_lidar_[0].inverse() * T_local_lidar_[i];
    const RigidMotion moved = found[0].inverse() * found[i];
    EXPECT_LT((moved.translation() - truth.translation()).norm(), 0.05) << i;
  }
}

TEST_F(BrokenRecording, AStrayScanIsOneFrame) {
  fs::copy(scan(5), scan(999'999));
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(map().exit_code, 0);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
  EXPECT_EQ(info().at("frames"), kFrames);
  EXPECT_EQ(info().at("frames_skipped"), 1);
}

TEST_F(BrokenRecording, NumbersMayHaveGaps) {
  ASSERT_EQ(map("--poses navigation").exit_code, 0);
  const std::vector<RigidMotion> without_gap = poses(0, kFrames);
  // Frames 4 to 7 become 1004 to 1007.
  const auto rename = [&](const fs::path& folder, const std::string& ending) {
    for (int i = 4; i < kFrames; ++i) {
      const auto name = [&](int index) { return drive_ / folder / (kitti_stem(index) + ending); };
      fs::rename(name(i), name(1000 + i));
    }
  };
  rename("velodyne_points/data", ".bin");
  rename("image_02/data", ".png");
  rename("oxts/data", ".txt");
  for (const char* sensor : {"velodyne_points", "oxts"}) {
    const fs::path file = drive_ / sensor / "timestamps.txt";
    std::string stamps = read_text(file);
    std::size_t fourth = 0;
    for (int i = 0; i < 4; ++i) fourth = stamps.find('\n', fourth) + 1;
    write_text(file, stamps.insert(fourth, std::string(1000, '\n')));
  }
  ASSERT_EQ(map("--poses navigation --force").exit_code, 0);
  EXPECT_EQ(info().at("frames"), kFrames);
  EXPECT_EQ(info().at("frames_skipped"), 0);
  const std::vector<RigidMotion> with_gap = poses(0, 1008);  // a line for every number
  ASSERT_EQ(with_gap.size(), 1008u);
  for (std::size_t i = 0; i < without_gap.size(); ++i) {
    EXPECT_TRUE(with_gap[i < 4 ? i : 1000 + i].isApprox(without_gap[i], 1e-9)) << i;
  }
  EXPECT_TRUE(
      with_gap[504].isApprox(interpolate(without_gap[3], without_gap[4], 501.0 / 1001), 1e-6));
}

TEST_F(BrokenRecording, ADriveThatVanishesIsResumedWhereItWasLost) {
  ASSERT_EQ(map().exit_code, 0);
  const std::string undisturbed = digest();
  // Links to files that are gone: listed when the drive is opened, and not readable afterwards.
  const fs::path gone = own_ / "gone";
  fs::create_directory(gone);
  for (int i = 5; i < kFrames; ++i) {
    fs::rename(scan(i), gone / scan(i).filename());
    fs::create_symlink(own_ / "elsewhere" / scan(i).filename(), scan(i));
  }
  const ProgramRun lost = map("--force");
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_THAT(lost.err, HasSubstr("the drive cannot be read from frame 5 on"));
  EXPECT_THAT(lost.err, HasSubstr("--resume"));
  EXPECT_EQ(info().at("frames"), 5);
  EXPECT_EQ(info().at("frames_skipped"), 0);
  fs::rename(gone, own_ / "elsewhere");
  ASSERT_EQ(map("--resume").exit_code, 0);
  EXPECT_EQ(digest(), undisturbed);
}

TEST_F(BrokenRecording, ImagesThatVanishAreALostDriveToo) {
  for (int i = 5; i < kFrames; ++i) {
    const fs::path image = drive_ / "image_02/data" / (kitti_stem(i) + ".png");
    fs::remove(image);
    fs::create_symlink(own_ / "nowhere.png", image);
  }
  const ProgramRun lost = map();
  EXPECT_EQ(lost.exit_code, 1);
  EXPECT_THAT(lost.err, HasSubstr("the drive cannot be read from frame 5 on"));
  EXPECT_EQ(info().at("frames"), 5);
}

TEST_F(BrokenRecording, OneFileThatCannotBeReadIsSkipped) {
  fs::remove(scan(5));
  fs::create_symlink(own_ / "nowhere.bin", scan(5));
  ASSERT_EQ(map().exit_code, 0);
  EXPECT_EQ(info().at("frames"), kFrames - 1);
  EXPECT_EQ(info().at("frames_skipped"), 1);
}

TEST_F(BrokenRecording, ADriveOfDamagedScansIsAnError) {
  for (int i = 1; i < 6; ++i) write_text(scan(i), "odd");
  const ProgramRun run = map();
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("5 of 8 frames are damaged (the first: damaged scan:"));
  EXPECT_THAT(run.err, HasSubstr("input.max_damaged_share"));
  EXPECT_EQ(info().at("frames"), 3);  // kept
  EXPECT_EQ(map("--force --set input.max_damaged_share=0.7").exit_code, 0);
}

}  // namespace fovea::broken_recording_program_test
