// fovea check, and the same output of `fovea map` for drives that are odd.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "fovea/drive/images/image_decode.h"
#include "tests/program.h"
#include "tests/temporary_folder.h"

namespace fovea::check_program_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class CheckProgram : public testing::Test {
 protected:
  CheckProgram() {
    const ProgramRun run = run_fovea(
        "simulate -o " + drive() +
        " --format generic --frames 4 --quiet --set lidar.columns=900 --set camera.width=480 --set "
        "camera.height=160 --set camera.focal=270 --set camera.cx=238.5 --set camera.cy=72.25");
    EXPECT_EQ(run.exit_code, 0) << run.err;
  }
  std::string quoted(const std::string& name) const {
    return "'" + (folder_ / name).string() + "'";
  }
  std::string drive() const { return quoted("drive"); }

  TemporaryFolder folder_;
};

TEST_F(CheckProgram, PrintsTheContentsAndDrawsAnOverlay) {
  const ProgramRun run = run_fovea("check " + drive() + " --overlay " + quoted("o.png"));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("frames       4"), HasSubstr("64 rings"),
                             HasSubstr("480 x 160 pixels"), HasSubstr("would do this"),
                             Not(HasSubstr("Look at this first"))));
  const Image overlay = read_image(folder_ / "o.png");
  EXPECT_EQ(overlay.width, 480);
  const ProgramRun again = run_fovea("check " + drive() + " --overlay " + quoted("o.png"));
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.err, HasSubstr("--force"));
  const ProgramRun other =
      run_fovea("check " + drive() + " --camera 7 --overlay " + quoted("p.png"));
  EXPECT_THAT(other.err, HasSubstr("--camera 7"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "p.png"));
}

TEST_F(CheckProgram, MapPrintsTheContentsOfAnOddDrive) {
  const std::string map = " -o " + quoted("m.fovea") + " --force";
  EXPECT_THAT(run_fovea("map " + drive() + map).out, Not(HasSubstr("Look at this first")));
  for (const auto& image :
       std::filesystem::recursive_directory_iterator(folder_ / "drive" / "images")) {
    if (image.path().filename() == "000001.png") std::filesystem::remove(image.path());
  }
  const ProgramRun run = run_fovea("map " + drive() + map);
  EXPECT_THAT(run.out, AllOf(HasSubstr("Look at this first"), HasSubstr("frames read")));
  EXPECT_THAT(run_fovea("map " + drive() + map + " --quiet").out, testing::IsEmpty());
}

}  // namespace fovea::check_program_test
