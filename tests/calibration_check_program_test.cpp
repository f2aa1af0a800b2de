// Cameras that do not agree with the LiDAR, and those that do: what `fovea map` reports.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "fovea/simulation/simulate.h"
#include "tests/half_size_street.h"
#include "tests/kitti_sample.h"
#include "tests/program.h"

namespace fovea::calibration_check_program_test {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kDisagrees = "warning: camera 2: camera and LiDAR do not agree";

/// A street of 16 frames with images of half of KITTI's size.
class CalibrationCheck : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    simulate(half_size_street(16), *scratch_ / "street");
  }
  static void TearDownTestSuite() { delete scratch_; }

  /// The street with another drive.toml.
  fs::path street_with(const std::string& toml) const {
    fs::create_directories(own_ / "drive");
    for (const char* name : {"lidar", "images"}) {
      fs::create_directory_symlink(*scratch_ / "street" / name, own_ / "drive" / name);
    }
    fs::copy(*scratch_ / "street/gnss.csv", own_ / "drive");
    std::ofstream(own_ / "drive/drive.toml") << toml;
    return own_ / "drive";
  }
  static std::string toml() { return read_text(*scratch_ / "street/drive.toml"); }

  /// What `fovea map` prints; its report is in `report_`.
  std::string map(const fs::path& drive, const std::string& more = "") {
    const ProgramRun run = run_fovea(fmt::format("map '{}' -o '{}' --force --report '{}' {}",
                                                 drive.string(), (own_ / "map.fovea").string(),
                                                 (own_ / "report.json").string(), more));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    if (run.exit_code == 0) {
      report_ =
          nlohmann::json::parse(read_text(own_ / "report.json")).at("map").at("calibration").at(0);
    }
    return run.out + run.err;
  }

  static TemporaryFolder* scratch_;
  TemporaryFolder own_;
  nlohmann::json report_;
};
TemporaryFolder* CalibrationCheck::scratch_ = nullptr;

/// The description with its camera turned about its own axis.
std::string turned(const std::string& toml, double degrees, const Eigen::Vector3d& axis) {
  const std::size_t camera = toml.find("T_lidar_cam"), key = toml.find("rotation = [", camera),
                    begin = toml.find('[', key), end = toml.find(']', begin);
  std::istringstream numbers(toml.substr(begin + 1, end - begin - 1));
  double q[4];
  char comma = 0;
  numbers >> q[0] >> comma >> q[1] >> comma >> q[2] >> comma >> q[3];
  EXPECT_TRUE(camera != std::string::npos && numbers);
  const Eigen::Quaterniond right(q[3], q[0], q[1], q[2]);
  const Eigen::Quaterniond wrong =
      right * Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis);
  return toml.substr(0, begin) +
         fmt::format("[{}, {}, {}, {}", wrong.x(), wrong.y(), wrong.z(), wrong.w()) +
         toml.substr(end);
}

TEST_F(CalibrationCheck, TheRightCalibrationGivesNoWarning) {
  EXPECT_THAT(map(*scratch_ / "street"), Not(HasSubstr("do not agree")));
  EXPECT_EQ(report_.at("disagrees"), false);
  EXPECT_EQ(report_.at("off_by_a_pixel"), false);
}

class TurnedCamera : public CalibrationCheck, public testing::WithParamInterface<double> {};

TEST_P(TurnedCamera, DoesNotAgreeWithTheLidar) {
  const std::string out = map(street_with(turned(toml(), GetParam(), Eigen::Vector3d::UnitY())));
  EXPECT_THAT(out, HasSubstr("warning: camera 2: "));
  EXPECT_THAT(out, HasSubstr("camera and LiDAR do not agree"));
  EXPECT_THAT(out, Not(HasSubstr("not observable")));
  EXPECT_THAT(out, HasSubstr("--calibrate corrects"));
  if (std::abs(GetParam()) < 3) return;  // may be within reach of the estimate
  EXPECT_THAT(out, HasSubstr("check its T_cam_lidar"));
  EXPECT_EQ(report_.at("disagrees"), true);
  EXPECT_EQ(report_.at("off_by_a_pixel"), false);
  EXPECT_TRUE(report_.at("rotation_deg").is_null());
}
INSTANTIATE_TEST_SUITE_P(Degrees, TurnedCamera, testing::Values(2.0, 5.0, -10.0));

// With GPS/INS and without.
TEST_F(CalibrationCheck, TheRemedyIsOneThatWorks) {
  const fs::path drive = street_with(turned(toml(), 2, Eigen::Vector3d::UnitY()));
  for (const bool with_gnss : {true, false}) {
    if (!with_gnss) fs::remove(drive / "gnss.csv");
    EXPECT_THAT(map(drive), HasSubstr("--calibrate corrects"));
    EXPECT_THAT(map(drive, "--calibrate"), Not(HasSubstr("do not agree")));
    EXPECT_EQ(report_.at("applied"), true);
    EXPECT_NEAR(std::abs(report_.at("rotation_deg").at(1).get<double>()), 2, 0.15);
  }
}

TEST_F(CalibrationCheck, AnInverseExtrinsicDoesNotAgree) {
  std::string swapped = toml();
  swapped.replace(swapped.find("T_lidar_cam"), std::strlen("T_lidar_cam"), "T_cam_lidar");
  EXPECT_THAT(map(street_with(swapped)), HasSubstr(kDisagrees));
}

/// Copies the sample with the rings whose number leaves `rest` when divided by `divisor`.
fs::path with_some_rings(const fs::path& drive, const fs::path& root, int divisor, int rest) {
  const fs::path date = root / drive.parent_path().filename(), copy = date / drive.filename();
  fs::create_directories(copy / "velodyne_points/data");
  for (const auto& file : fs::directory_iterator(drive.parent_path())) {
    if (file.is_regular_file()) fs::create_symlink(file, date / file.path().filename());
  }
  for (const auto& part : fs::directory_iterator(drive)) {
    if (part.path().filename() != "velodyne_points") {
      fs::create_directory_symlink(part, copy / part.path().filename());
    }
  }
  for (const auto& file : fs::directory_iterator(drive / "velodyne_points")) {
    if (file.is_regular_file()) {
      fs::create_symlink(file, copy / "velodyne_points" / file.path().filename());
    }
  }
  for (const auto& scan : fs::directory_iterator(drive / "velodyne_points/data")) {
    const std::string bytes = read_text(scan);
    std::vector<std::array<float, 4>> points(bytes.size() / 16);
    std::memcpy(points.data(), bytes.data(), 16 * points.size());
    std::ofstream out(copy / "velodyne_points/data" / scan.path().filename(), std::ios::binary);
    int ring = 0;
    double before = 0;
    for (const auto& point : points) {
      // Each ring begins ahead and turns to the left.
      double azimuth = std::atan2(point[1], point[0]);
      if (azimuth < 0) azimuth += 2 * std::numbers::pi;
      if (azimuth < before - std::numbers::pi) ++ring;
      before = azimuth;
      if (ring % divisor == rest) out.write(reinterpret_cast<const char*>(point.data()), 16);
    }
  }
  return copy;
}

// Sixteen of the sample's rings: its calibration is as right as with all of them.
TEST_F(CalibrationCheck, SixteenRingsGiveNoFalseWarning) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  const fs::path sparse = with_some_rings(drive, own_.path(), 4, 1);
  EXPECT_THAT(map(sparse), Not(HasSubstr("warning: camera")));
  EXPECT_EQ(report_.at("disagrees"), false);
  EXPECT_EQ(report_.at("off_by_a_pixel"), false);
}

}  // namespace fovea::calibration_check_program_test
