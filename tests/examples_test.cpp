// Examples in C++ whose results are files.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "fovea/drive/frame_source.h"
#include "fovea/drive/writers/png_encode.h"
#include "fovea/map/map_store.h"
#include "tests/program.h"

namespace fovea::examples_test {

constexpr int kFrames = 14;

TEST(LiveExample, MapsADrive) {
  const TemporaryFolder folder;
  const std::string drive = (folder / "drive").string(), map = (folder / "map.fovea").string();
  const ProgramRun simulated = run_fovea(fmt::format(
      "simulate -o '{}' --format generic --quiet --frames {} --set camera.numbers=[2] --set "
      "camera.width=414 --set camera.height=125 --set camera.focal=240.5 --set camera.cx=203.2 "
      "--set camera.cy=57.6",
      drive, kFrames));
  ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
  const std::string command =
      fmt::format("timeout 120 '{}' '{}' '{}' > /dev/null", FOVEA_LIVE_EXAMPLE, drive, map);
  ASSERT_EQ(std::system(command.c_str()), 0);

  const MapReader reader(map);
  const std::vector<FrameRecord> frames = reader.frames();
  // The machine may be slow: the example lets late data go.
  ASSERT_GE(frames.size(), std::size_t(kFrames / 2));
  EXPECT_GT(reader.size(), 1000u);
  EXPECT_GT(frames.back().T_local_lidar.translation().norm(), 3);  // m, at 9 m/s
  for (const FrameRecord& frame : frames) {
    ASSERT_TRUE(frame.T_local_lidar_navigation.has_value());
    EXPECT_LT(
        (frame.T_local_lidar.translation() - frame.T_local_lidar_navigation->translation()).norm(),
        1)
        << frame.index;
  }
}

TEST(LiveExample, ThePageShowsIt) {
  const std::string page = read_text(FOVEA_SOURCE_DIR "/docs/live.md");
  const std::string code = read_text(FOVEA_SOURCE_DIR "/examples/live_mapping.cpp");
  EXPECT_NE(page.find(code.substr(code.find('\n') + 1)), std::string::npos);
}

void write(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

TEST(WriteDriveExample, WritesADriveOfItsOwnFormat) {
  const TemporaryFolder folder;
  std::string frames;
  for (int i = 0; i < 3; ++i) {
    const std::string name = std::to_string(i);
    write(folder / (name + ".txt"), fmt::format("{} 1 2 0.5\n{} 0 0 0.25\n", 5 + i, 6 + i));
    const std::vector<std::uint8_t> png = encode_png(Image(64, 48, 3));
    write(folder / (name + ".png"), std::string(png.begin(), png.end()));
    frames += fmt::format("{} {} 0 0\n", 1'000'000'000 + 100'000'000 * i, i);
  }
  write(folder / "frames.txt", frames);
  const std::string command = fmt::format("'{}' '{}' '{}' > /dev/null", FOVEA_WRITE_EXAMPLE,
                                          folder.path().string(), (folder / "drive").string());
  ASSERT_EQ(std::system(command.c_str()), 0);

  const auto drive = open_drive(folder / "drive", {});
  ASSERT_EQ(drive->info().frame_indices().size(), 3u);
  const Frame last = std::get<Frame>(drive->load(2));
  EXPECT_EQ(last.scan.position[0], Eigen::Vector3f(7, 1, 2));
  EXPECT_EQ(last.images.front().width, 64);
}

}  // namespace fovea::examples_test
