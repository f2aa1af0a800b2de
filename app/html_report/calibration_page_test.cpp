#include "app/html_report/calibration_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <pugixml.hpp>

#include "fovea/core/angle.h"

namespace fovea::app::calibration_page_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const double kNan = std::numeric_limits<double>::quiet_NaN();

CameraCalibration seen_camera(int number) {
  CameraCalibration camera{number, {}};
  CalibrationEstimate& e = camera.estimate;
  e.correction.rotation = Eigen::Vector3d(0.291, -0.302, 0.313) * kDegree;
  e.sigma.rotation = Eigen::Vector3d(0.014, 0.005, 0.026) * kDegree;
  e.correction.translation = {0.0123, -0.0234, 0};
  e.sigma.translation = {0.0071, 0.0082, 0};
  e.correction.delay = 0.0196;
  e.sigma.delay = 0.0003;
  e.observable = {true, true, true, true, true, false, true};
  e.pixels = 6.31;
  e.pixels_sigma = 0.24;
  e.frames = 57;
  e.edges = 4321;
  camera.lens = {.is_checked = true, .focal = 0.021, .focal_sigma = 0.002};
  camera.overlays = {{12, Image(64, 32, 3), {{5, 6, 10, true}}, {{7, 6, 10, true}}}};
  return camera;
}

ImuHandEye seen_imu() {
  ImuHandEye imu;
  imu.rotation = Eigen::Vector3d(0.51, -0.42, 0.33) * kDegree;
  imu.rotation_covariance = Eigen::Matrix3d::Identity() * 0.0021 * 0.0021;
  imu.observable_directions = 3;
  imu.delay = -0.0042;
  imu.delay_sigma = 0.0006;
  imu.delay_observable = true;
  imu.gyroscope_bias = Eigen::Vector3d(0.11, 0.12, -0.13) * kDegree;
  imu.gyroscope_bias_sigma.setConstant(0.004 * kDegree);
  imu.turns = 99;
  imu.moving_turns = 88;
  return imu;
}

class CalibrationPageTest : public testing::Test {
 protected:
  CalibrationPageTest() {
    found.frames = 120;
    add(seen_camera(2));
    found.imu = seen_imu();
    drive.imu.emplace();
  }
  void add(const CameraCalibration& camera) {
    found.cameras.push_back(camera);
    Camera given;
    given.index = camera.camera;
    given.image_delay = 0.001;
    drive.calibration.cameras.push_back(given);
  }
  CalibrationEstimate& estimate() { return found.cameras.front().estimate; }
  std::string text() const {
    return calibration_page({"street", drive, found, warnings, "street_calibrated"});
  }
  /// The page without pictures.
  pugi::xml_document document() const {
    pugi::xml_document parsed;
    const pugi::xml_parse_result result = parsed.load_string(text().c_str(), pugi::parse_full);
    EXPECT_TRUE(result) << result.description();
    return parsed;
  }
  /// The cells of a section's table, a line for each row.
  std::string rows(const std::string& section) const {
    const pugi::xml_document page = document();
    const std::string path = "//section[@id='" + section + "']//tbody/tr";
    std::string all;
    for (const auto& row : page.select_nodes(path.c_str())) {
      for (const pugi::xml_node& cell : row.node().children()) {
        all += std::string(cell.text().get()) + "|";
      }
      all += "\n";
    }
    return all;
  }

  DriveInfo drive;
  DriveCalibration found;
  std::vector<std::string> warnings;
};

TEST_F(CalibrationPageTest, StatesEachValueOfACamera) {
  EXPECT_EQ(rows("cameras"),
            "rotation about x (right)|+0.291\xC2\xB0|\xC2\xB1"
            "0.014\xC2\xB0|yes|\n"
            "rotation about y (down)|-0.302\xC2\xB0|\xC2\xB1"
            "0.005\xC2\xB0|yes|\n"
            "rotation about z (forward)|+0.313\xC2\xB0|\xC2\xB1"
            "0.026\xC2\xB0|yes|\n"
            "points to the right|+1.23 cm|\xC2\xB1"
            "0.71 cm|yes|\n"
            "points down|-2.34 cm|\xC2\xB1"
            "0.82 cm|yes|\n"
            "points forward|stays as given||no: drive at different speeds: at a steady one, a "
            "shift forward looks like a delay|\n"
            "delay of the images|+19.60 ms|\xC2\xB1"
            "0.30 ms|yes|\n");
  EXPECT_THAT(text(), AllOf(HasSubstr("6.3 pixels"), HasSubstr("in 57 frames"),
                            HasSubstr("a focal length 2.1 % longer (+-0.2 %)")));
}

TEST_F(CalibrationPageTest, StatesTheNewCalibrationToCopy) {
  const auto copies = document().select_nodes("//pre[@class='copy']/code");
  ASSERT_EQ(copies.size(), 2u);
  const std::string camera = copies[0].node().text().get(), imu = copies[1].node().text().get();
  EXPECT_THAT(camera, AllOf(HasSubstr("[calibrated.camera.2]\nT_cam_lidar = [[0.9999"),
                            HasSubstr("added_delay = 0.0196\n"), HasSubstr("taken 20.60 ms after"),
                            Not(HasSubstr("drive ="))));
  EXPECT_THAT(imu, AllOf(HasSubstr("[calibrated.imu]\nT_lidar_imu = [[0.9999"),
                         HasSubstr("added_delay = -0.0042\n")));
}

TEST_F(CalibrationPageTest, StatesEachValueOfAnImu) {
  EXPECT_EQ(rows("imu"),
            "rotation about the LiDAR's x axis|+0.510\xC2\xB0|\xC2\xB1"
            "0.120\xC2\xB0|yes|\n"
            "rotation about the LiDAR's y axis|-0.420\xC2\xB0|\xC2\xB1"
            "0.120\xC2\xB0|yes|\n"
            "rotation about the LiDAR's z axis|+0.330\xC2\xB0|\xC2\xB1"
            "0.120\xC2\xB0|yes|\n"
            "delay of the IMU|-4.20 ms|\xC2\xB1"
            "0.60 ms|yes|\n"
            "bias of the gyroscope, x axis of the IMU|+0.110\xC2\xB0/s|\xC2\xB1"
            "0.004\xC2\xB0/s|yes|\n"
            "bias of the gyroscope, y axis of the IMU|+0.120\xC2\xB0/s|\xC2\xB1"
            "0.004\xC2\xB0/s|yes|\n"
            "bias of the gyroscope, z axis of the IMU|-0.130\xC2\xB0/s|\xC2\xB1"
            "0.004\xC2\xB0/s|yes|\n");
}

TEST_F(CalibrationPageTest, OfTurnsAboutOneAxisTheRotationAboutItStaysAsGiven) {
  ImuHandEye& imu = *found.imu;
  imu.observable_directions = 2;
  imu.rotation.z() = 0;
  imu.rotation_covariance(2, 2) = 1;
  EXPECT_THAT(
      rows("imu"),
      HasSubstr("z axis|stays as given||no: turn about another axis than (0.00 0.00 1.00)"));
}

TEST_F(CalibrationPageTest, EdgesThatNeverMeetLeaveTheCalibrationAsGiven) {
  CameraCalibration camera = seen_camera(2);
  camera.estimate = {};
  camera.estimate.disagrees = true;
  found.cameras = {camera};
  EXPECT_EQ(rows("cameras"), "");
  EXPECT_THAT(text(), AllOf(HasSubstr("Camera and LiDAR do not agree under any correction"),
                            HasSubstr("stays as given"), Not(HasSubstr("calibrated.camera.2"))));
}

TEST_F(CalibrationPageTest, ACameraWithoutEdgesLacksEdges) {
  estimate() = {};
  EXPECT_EQ(rows("cameras").find("yes"), std::string::npos);
  EXPECT_THAT(text(), AllOf(HasSubstr("no value is observable"), HasSubstr("record more edges")));
}

TEST_F(CalibrationPageTest, AnImuThatDisagreesHasALikelyCause) {
  found.imu = ImuHandEye{};
  found.imu->agrees = false;
  found.imu->turn_ratio = 56.8;
  EXPECT_THAT(text(), AllOf(HasSubstr("IMU and LiDAR do not agree"),
                            HasSubstr("its rates are in degrees per second")));
  EXPECT_EQ(rows("imu"), "");
  found.imu->turn_ratio = 1.01;
  found.imu->mirrored = true;
  EXPECT_THAT(text(), HasSubstr("An axis of the IMU has the wrong sign"));
}

TEST_F(CalibrationPageTest, EscapesNames) {
  warnings = {"a < b & c"};
  const std::string page = calibration_page({"<b>&\"\xFF", drive, found, warnings, "<out>"});
  pugi::xml_document parsed;
  EXPECT_TRUE(parsed.load_string(page.c_str()));
  EXPECT_THAT(page, AllOf(HasSubstr("&lt;b&gt;&amp;&quot;\xEF\xBF\xBD"), Not(HasSubstr("<out>")),
                          HasSubstr("a &lt; b &amp; c"), HasSubstr("1 warning<")));
}

TEST_F(CalibrationPageTest, ADriveWithoutCameraAndImuHasAPage) {
  found = {};
  drive = {};
  EXPECT_THAT(rows("cameras"), "");
  EXPECT_THAT(text(), AllOf(HasSubstr("No camera was calibrated"), HasSubstr("no pictures"),
                            Not(HasSubstr("id=\"imu\""))));
}

TEST_F(CalibrationPageTest, EachOverlayHasAPictureBeforeAndOneAfter) {
  add(seen_camera(3));
  found.cameras[1].overlays.push_back(found.cameras[1].overlays.front());
  found.cameras[1].overlays.push_back({});  // its image is missing
  const pugi::xml_document page = document();
  EXPECT_EQ(page.select_nodes("//div[@class='compare']/img").size(), 2 * 3u);
  EXPECT_EQ(page.select_nodes("//figure/img").size(), 2 * 3u);
  EXPECT_EQ(page.select_nodes("//div[@class='picker']/button").size(), 3u);
  EXPECT_EQ(text(), text());
}

TEST_F(CalibrationPageTest, ValuesThatAreNotFiniteAreNone) {
  estimate().sigma.rotation.x() = kNan;
  EXPECT_THAT(rows("cameras"), HasSubstr("+0.291\xC2\xB0|none|yes"));
}

}  // namespace fovea::app::calibration_page_test
