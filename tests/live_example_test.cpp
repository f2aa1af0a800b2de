// The C++ example of docs/live.md maps a small drive.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "fovea/map/map_store.h"
#include "tests/program.h"

namespace fovea::live_example_test {

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

}  // namespace fovea::live_example_test
