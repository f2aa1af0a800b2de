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

TEST(ColorCloudExample, ColorsWhatTheCameraSees) {
  const TemporaryFolder folder;
  // One camera 64 pixels wide that looks along x, red on its left half and blue on its right one.
  Image image(64, 48, 3);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) image.pixel(x, y)[x < 32 ? 0 : 2] = 200;
  }
  const std::vector<std::uint8_t> png = encode_png(image);
  write(folder / "image.png", std::string(png.begin(), png.end()));
  write(folder / "camera.txt", "32 32 31.5 23.5\n0 -1 0 0\n0 0 -1 0\n1 0 0 0\n");
  const std::vector<float> points{5, 1, 0, 0.5f, 5, -1, 0, 0.25f, -5, 0, 0, 1};
  write(folder / "scan.bin",
        std::string(reinterpret_cast<const char*>(points.data()), points.size() * sizeof(float)));
  const auto run = [&](const std::string& camera) {
    return std::system(fmt::format("cd '{}' && '{}' scan.bin image.png {} out.ply > said.txt 2>&1",
                                   folder.path().string(), FOVEA_COLOR_EXAMPLE, camera)
                           .c_str());
  };
  ASSERT_EQ(run("camera.txt"), 0);
  EXPECT_EQ(read_text(folder / "said.txt"), "2 of 3 points have a color\n");
  const std::string ply = read_text(folder / "out.ply"), end = "end_header\n";
  const std::string rows = ply.substr(ply.find(end) + end.size());
  constexpr std::size_t kRow = 19;  // x y z, red green blue, intensity
  ASSERT_EQ(rows.size(), 3 * kRow);
  const auto color = [&](std::size_t i) { return rows.substr(i * kRow + 12, 3); };
  EXPECT_EQ(color(0), (std::string{'\xc8', '\0', '\0'}));
  EXPECT_EQ(color(1), (std::string{'\0', '\0', '\xc8'}));
  EXPECT_EQ(color(2), "\x80\x80\x80");

  write(folder / "scaled.txt", "32 32 31.5 23.5\n0 -2 0 0\n0 0 -2 0\n2 0 0 0\n");
  EXPECT_NE(run("scaled.txt"), 0);
  EXPECT_NE(read_text(folder / "said.txt").find("has no camera"), std::string::npos);
}

}  // namespace fovea::examples_test
