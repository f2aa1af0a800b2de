// Scans of every format through the program: the content decides, and what is not read is named.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <sstream>

#include "tests/kitti_writer.h"
#include "tests/program.h"
#include "tests/synthetic_drive.h"

namespace fovea::file_format_program_test {

using testing::AllOf;
using testing::HasSubstr;

/// Scans, one step apart, of a street with houses at both sides.
class FormatProgram : public testing::Test {
 protected:
  static constexpr double kStep = 0.8;  // m

  static PointCloud scan(const BoxScene& scene, int frame) {
    SyntheticDrive drive(scene, 3, kStep);
    drive.editable_info().calibration.cameras.clear();
    return std::get<Frame>(drive.load(frame)).scan;
  }
  static BoxScene street() {
    return {{{{-60, -60, -1.8}, {60, 60, 40}},
             {{-20, 5, -1.8}, {-4, 9, 4}},
             {{2, 6, -1.8}, {15, 12, 6}},
             {{-12, -14, -1.8}, {0, -7, 5}},
             {{5, -11, -1.8}, {22, -6, 3}},
             {{28, -4, -1.8}, {33, 4, 5}}}};
  }
  /// Another place: a narrow yard that is turned by half a right angle in no wall.
  static BoxScene yard() {
    return {{{{-9, -31, -1.8}, {44, 17, 40}},
             {{12, -3, -1.8}, {13, 14, 4}},
             {{-6, -25, -1.8}, {-3, -2, 2}},
             {{4, 3, -1.8}, {7, 5, 3}},
             {{20, -29, -1.8}, {39, -17, 6}}}};
  }

  std::string write(const std::string& name, const std::string& bytes) const {
    write_text(folder_ / name, bytes);
    return "'" + (folder_ / name).string() + "' ";
  }
  std::string write_bin(const std::string& name, const PointCloud& scan, bool rings = false) const {
    std::vector<float> values;
    for (std::size_t i = 0; i < scan.size(); ++i) {
      values.insert(values.end(), scan.position[i].begin(), scan.position[i].end());
      values.push_back(scan.intensity[i]);
      if (rings) values.push_back(static_cast<float>(i * 48 / scan.size()));
    }
    return write(name, {reinterpret_cast<const char*>(values.data()), 4 * values.size()});
  }
  std::string write_pcd(const std::string& name, const PointCloud& scan) const {
    std::string bytes = fmt::format(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS X Y Z\nSIZE 4 4 4\nTYPE F F F\nWIDTH {}\nHEIGHT 1\n"
        "DATA binary\n",
        scan.size());
    for (const Eigen::Vector3f& p : scan.position) {
      bytes.append(reinterpret_cast<const char*>(p.data()), 12);
    }
    // A multiple of 16 bytes, as a scan without a header has it.
    bytes.resize((bytes.size() + 15) / 16 * 16);
    return write(name, bytes);
  }

  /// Checks that `fovea register` finds the step between two scans.
  static void expect_step(const std::string& arguments) {
    const ProgramRun run = run_fovea("register " + arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    std::istringstream numbers(run.out);
    const std::vector<double> pose{std::istream_iterator<double>(numbers), {}};
    ASSERT_EQ(pose.size(), 12u);
    EXPECT_NEAR(pose[3], kStep, 0.1);
    EXPECT_NEAR(pose[7], 0, 0.1);
  }
  static void expect_error(const std::string& arguments, const std::string& says) {
    const ProgramRun run = run_fovea(arguments, "timeout 60");
    EXPECT_EQ(run.exit_code, 1) << run.err;
    EXPECT_THAT(run.err, AllOf(testing::StartsWith("fovea: error: "), HasSubstr(says)));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_EQ(run.out, "");
  }

  TemporaryFolder folder_;
};

TEST_F(FormatProgram, RegisterReadsScansByTheirContent) {
  const PointCloud a = scan(street(), 0), b = scan(street(), 1);
  expect_step(write_pcd("b.pcd", b) + write_pcd("a.pcd", a));
  expect_step(write_pcd("b.bin", b) + write_bin("a", a));
  expect_step(write_bin("b.bin", b, /*rings=*/true) + write_bin("a.BIN", a));
}

TEST_F(FormatProgram, ScansThatDoNotFitAreNoSuccess) {
  const std::string here = write_bin("here.bin", scan(street(), 0)),
                    there = write_bin("there.bin", scan(yard(), 0));
  for (const char* method : {"gicp", "plane", "icp"}) {
    for (const std::string& pair : {here + there, there + here}) {
      expect_error("register " + pair + "--method " + method,
                   "do not lie on each other's surfaces");
    }
  }
}

TEST_F(FormatProgram, OtherFormatsAreRefusedByTheirNames) {
  using namespace std::string_literals;
  const std::string bin = write_bin("a.bin", scan(street(), 0));
  const std::string e57 = write("a.e57", "ASTM-E57\1\0\0\0"s + std::string(500, 'A'));
  const std::string las = write("las.bin", "LASF" + std::string(500, '\3'));
  write_text(folder_ / "calib_cam_to_cam.txt", "");
  expect_error("register " + e57 + bin, "an E57 point cloud, no scan");
  expect_error("register " + bin + las, "a LAS point cloud, no scan");
  expect_error("evaluate " + e57 + "'" + folder_.path().string() + "'",
               "an E57 point cloud, neither a map nor a cloud");
  expect_error("info " + e57, "an E57 point cloud, not a Fovea map");
  expect_error("info " + bin, "not a Fovea map");
  expect_error("convert " + e57 + "-o '" + (folder_ / "out").string() + "'",
               "this is no recording of ROS, but an E57 point cloud");
}

TEST_F(FormatProgram, ADriveOfTwentyBytePointsIsMapped) {
  for (int i = 0; i < 3; ++i) {
    write_bin(fmt::format("drive/lidar/{:06d}.bin", i), scan(street(), i), /*rings=*/true);
  }
  write("drive/drive.toml", "version = 1\n[lidar]\ncompensated = true\nintensity_max = 1.0\n");
  const std::string map = "'" + (folder_ / "m.fovea").string() + "'";
  const ProgramRun run = run_fovea("map '" + (folder_ / "drive").string() + "' -o " + map);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("points from 3 frames"));
  EXPECT_THAT(run_fovea("info " + map).out, HasSubstr("48 rings"));
}

}  // namespace fovea::file_format_program_test
