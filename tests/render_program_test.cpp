// fovea render --poses as a user meets it: a drive rendered from a map is a drive that is mapped.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/kitti_sample.h"
#include "tests/program.h"

namespace fovea::render_program_test {

using testing::HasSubstr;
namespace fs = std::filesystem;

class RenderProgram : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (own_ / name).string(); }
  void succeed(const std::string& command) const {
    const ProgramRun run = run_fovea(command);
    ASSERT_EQ(run.exit_code, 0) << command << "\n" << run.err;
  }
  TemporaryFolder own_;
};

TEST_F(RenderProgram, ARenderedDriveIsMappedAndScoresAgainstTheRealPhotographs) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  const auto score = [&](const std::string& map, const std::string& more) {
    succeed(fmt::format("evaluate '{}' '{}' --json '{}' {}", path(map), drive.string(),
                        path("scores.json"), more));
    return nlohmann::json::parse(read_text(path("scores.json")));
  };
  succeed(fmt::format("map '{}' -o '{}' --frames 0:20 --hold-out 8:4 --quiet", drive.string(),
                      path("first.fovea")));
  succeed(fmt::format("export '{}' '{}' --quiet", path("first.fovea"), path("poses.txt")) +
          " --format kitti-poses");
  const ProgramRun rendered =
      run_fovea(fmt::format("render '{}' --poses '{}' --camera '{}' --lidar hdl64 -o '{}'",
                            path("first.fovea"), path("poses.txt"), drive.string(), path("again")));
  ASSERT_EQ(rendered.exit_code, 0) << rendered.err;
  EXPECT_THAT(rendered.out, HasSubstr("20 frames, 1 images each"));
  EXPECT_TRUE(fs::exists(path("again/depth/camera_2/000019.png")));
  succeed(
      fmt::format("map '{}' -o '{}' --hold-out 8:4 --quiet", path("again"), path("second.fovea")));
  const nlohmann::json first = score("first.fovea", ""),
                       second = score("second.fovea", "--foreign");
  EXPECT_LT(second["te_gain_mean"], double(first["te_gain_mean"]) + 4);
  EXPECT_GT(second["coverage_5cm"], 0.88);
  EXPECT_LT(second["me_mean"], 0.04);
}

TEST_F(RenderProgram, ACameraIsSixNumbersOrACalibration) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  succeed(fmt::format("map '{}' -o '{}' --frames 0:3 --quiet", drive.string(), path("m.fovea")));
  std::ofstream(path("pose.txt")) << "1 0 0 2 0 1 0 0 0 0 1 0\n";
  const std::string render =
      fmt::format("render '{}' --poses '{}' ", path("m.fovea"), path("pose.txt"));
  succeed(render + "--camera 320,100,200,200,159.5,40 -o " + path("six"));
  EXPECT_TRUE(fs::exists(path("six/images/camera/000000.png")));
  EXPECT_FALSE(fs::exists(path("six/lidar/000000.bin")));
  succeed(fmt::format("render '{}' '{}' --poses '{}' --camera calib --cameras 2 -o '{}'",
                      path("m.fovea"), drive.string(), path("pose.txt"), path("calib")));
  EXPECT_TRUE(fs::exists(path("calib/images/camera_2/000000.png")));
  succeed(render + "--camera '" + drive.parent_path().string() + "' --cameras 0,3 -o " +
          path("two"));
  EXPECT_TRUE(fs::exists(path("two/images/camera_3/000000.png")));

  const auto error = [&](const std::string& rest) {
    const ProgramRun run = run_fovea(render + rest + " -o " + path("none"));
    EXPECT_NE(run.exit_code, 0) << rest;
    EXPECT_FALSE(fs::exists(path("none"))) << rest;
    return run.err;
  };
  EXPECT_THAT(error(""), HasSubstr("--camera, --lidar, or both"));
  EXPECT_THAT(error("--camera calib"), HasSubstr("named after MAP.fovea"));
  EXPECT_THAT(error("--camera 320,100,200"), HasSubstr("W,H,fx,fy,cx,cy"));
  EXPECT_THAT(error("--camera 320,100,-5,5,1,1"), HasSubstr("W,H,fx,fy,cx,cy"));
  EXPECT_THAT(error("--camera 320,100,nan,200,1,1"), HasSubstr("W,H,fx,fy,cx,cy"));
  EXPECT_THAT(error("--camera 10000,100,9,9,1,1"), HasSubstr("W,H,fx,fy,cx,cy"));
  EXPECT_THAT(error("--lidar hdl64 --rate nan"), HasSubstr("--rate"));
  EXPECT_THAT(error("--lidar hdl64 --reach nan"), HasSubstr("--reach"));
  EXPECT_THAT(error("--lidar hdl64 --cameras 2"), HasSubstr("--cameras"));
  EXPECT_THAT(error("--camera nowhere"), HasSubstr("nowhere"));
  EXPECT_THAT(error("--camera '" + drive.parent_path().string() + "' --cameras 7"),
              HasSubstr("lacks a camera"));
  EXPECT_THAT(error("--lidar hdl65"), HasSubstr("hdl65"));
  EXPECT_THAT(error("--lidar hdl64 --view above"), HasSubstr("--view"));
  EXPECT_THAT(error("--lidar hdl64 --poses none.txt"), HasSubstr("--poses"));
  EXPECT_THAT(run_fovea(render + "--lidar hdl64 -o " + path("two")).err, HasSubstr("two"));
  EXPECT_THAT(run_fovea("render '" + path("m.fovea") + "' --lidar hdl64 -o " + path("x.png")).err,
              HasSubstr("needs --poses"));
}

}  // namespace fovea::render_program_test
