#include "fovea/drive/drive_description.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "../../../tests/kitti_test_drive.h"
#include "fovea/errors.h"
#include "fovea/geometry/rectified_camera.h"

namespace fovea::drive_description_test {

using test::error_of;
using testing::AllOf;
using testing::HasSubstr;

const std::string kCamera = R"(
[camera.left]
index = 3
width = 640
height = 480
K = [400, 0, 320, 0, 410, 240, 0, 0, 1]
)";
const std::string kPlace = "T_cam_lidar = [0, -1, 0, 0.5, 0, 0, -1, 0.25, 1, 0, 0, -0.125]\n";
const std::string kSmallest = "version = 1" + kCamera + kPlace;

DriveDescription parse(const std::string& text) { return parse_drive_description(text, "d.toml"); }
std::string error(const std::string& text) {
  return error_of<ConfigError>([&] { parse(text); });
}

TEST(DriveDescription, TheSmallest) {
  const DriveDescription drive = parse(kSmallest);
  EXPECT_EQ(drive.lidar.folder, "lidar");
  EXPECT_FALSE(drive.lidar.sweep_compensated);
  EXPECT_TRUE(drive.T_body_lidar.isApprox(RigidMotion::Identity()));
  ASSERT_EQ(drive.cameras.size(), 1u);
  const CameraDescription& camera = drive.cameras[0];
  EXPECT_EQ(camera.name, "left");
  EXPECT_EQ(camera.folder, "images/left");
  EXPECT_EQ(camera.index, 3);
  EXPECT_EQ(camera.optics.width, 640);
  EXPECT_EQ(camera.optics.fy, 410);
  EXPECT_EQ(camera.optics.cx, 320);
  EXPECT_EQ(camera.optics.lens.model(), LensModel::kNone);
  EXPECT_LT(
      (camera.T_cam_lidar * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(-1.5, -2.75, 0.875)).norm(),
      1e-12);
}

TEST(DriveDescription, ADriveMayHaveNoCamera) { EXPECT_TRUE(parse("version = 1").cameras.empty()); }

TEST(DriveDescription, SeveralLidarsHaveNames) {
  const std::string top = kSmallest + "[lidar.top]\nintensity_max = 255\n";
  const std::string left =
      "[lidar.left]\nfolder = \"other\"\nT_lidar_sensor = {translation = [0, 1, 0]}\n";
  const DriveDescription drive = parse(top + left);
  EXPECT_EQ(drive.lidar.name, "top");
  EXPECT_EQ(drive.lidar.folder, "lidar/top");
  EXPECT_EQ(drive.lidar.scan_format.intensity_max, 255);
  ASSERT_EQ(drive.further_lidars.size(), 1u);
  EXPECT_EQ(drive.further_lidars[0].name, "left");
  EXPECT_EQ(drive.further_lidars[0].folder, "other");
  EXPECT_EQ(drive.further_lidars[0].T_lidar_sensor.translation().y(), 1);
  const DriveDescription inverse =
      parse(top + "[lidar.left]\nT_sensor_lidar = {translation = [0, 1, 0]}\n");
  EXPECT_EQ(inverse.further_lidars.at(0).T_lidar_sensor.translation().y(), -1);

  EXPECT_THAT(error(kSmallest + left), HasSubstr("every LiDAR has a pose"));
  EXPECT_THAT(error(top + "[lidar.left]\n"), AllOf(HasSubstr("top"), HasSubstr("left")));
  EXPECT_THAT(error(top + left + "[lidar]\nintensity_max = 1\n"), HasSubstr("lidar.intensity_max"));
  EXPECT_THAT(error(top + "[lidar.left]\nstamp_phase = 2\n"), HasSubstr("lidar.left.stamp_phase"));
  EXPECT_THAT(error(kSmallest + "[lidar]\nT_lidar_sensor = {translation = [0, 1, 0]}\n"),
              HasSubstr("T_lidar_sensor"));
}

TEST(DriveDescription, SweepKeysAreAbsentUnlessStated) {
  const SweepDescription absent = parse(kSmallest).lidar.sweep;
  EXPECT_FALSE(absent.period || absent.direction || absent.start_azimuth || absent.stamp_phase);
  const auto sweep = [](const std::string& lines) { return kSmallest + "[lidar]\n" + lines; };
  const SweepDescription stated = parse(sweep("sweep_period_s = 0.2\nrotation = "
                                              "\"counterclockwise\"\nsweep_start_deg = -90\n"
                                              "stamp_phase = 1\n"))
                                      .lidar.sweep;
  EXPECT_EQ(stated.period, 0.2);
  EXPECT_EQ(stated.direction, SweepDirection::kCounterclockwise);
  EXPECT_NEAR(stated.start_azimuth.value(), -std::numbers::pi / 2, 1e-15);
  EXPECT_EQ(stated.stamp_phase, 1);
  EXPECT_THAT(error(sweep("sweep_period_s = 100\n")), HasSubstr("give 0.01 to 1"));
  EXPECT_THAT(error(sweep("rotation = \"left\"\n")), HasSubstr("'clockwise'"));
  EXPECT_THAT(error(sweep("sweep_start_deg = nan\n")), HasSubstr("lidar.sweep_start_deg"));
  EXPECT_THAT(error(sweep("stamp_phase = 1.5\n")), HasSubstr("give 0 to 1"));
}

TEST(DriveDescription, UnitsAreRecognizedUnlessStated) {
  for (const char* keys :
       {"", "[lidar]\ntime_unit = \"auto\"\nlength_unit = \"auto\"\ntime_reference = \"auto\"\n"}) {
    const StatedScanFormat format = parse(std::string(kSmallest) + keys).lidar.scan_format;
    EXPECT_FALSE(format.intensity_max || format.length_unit || format.time_unit);
    EXPECT_FALSE(format.time_reference);
  }
  EXPECT_THAT(error(std::string(kSmallest) + "[lidar]\nlength_unit = \"ft\"\n"), HasSubstr("'mm'"));
}

TEST(DriveDescription, CoordinatesAreAbsentUnlessStated) {
  const CoordinateReference absent = parse(kSmallest).coordinates;
  EXPECT_FALSE(absent.datum || absent.epoch_year || absent.heights);
  const auto georeference = [](const std::string& lines) {
    return kSmallest + "[georeference]\n" + lines;
  };
  const CoordinateReference stated =
      parse(georeference("datum = \"ITRF2014\"\nepoch_year = 2020.5\nheights = \"orthometric\"\n"))
          .coordinates;
  EXPECT_EQ(stated.datum, "ITRF2014");
  EXPECT_EQ(stated.epoch_year, 2020.5);
  EXPECT_EQ(stated.heights, HeightType::kOrthometric);
  EXPECT_THAT(error(georeference("datum = \"\"\n")), HasSubstr("georeference.datum"));
  EXPECT_THAT(error(georeference("epoch_year = 20\n")), HasSubstr("georeference.epoch_year"));
  EXPECT_THAT(error(georeference("heights = \"sea\"\n")), HasSubstr("'ellipsoidal'"));
}

TEST(DriveDescription, EveryKey) {
  const DriveDescription drive = parse(R"(
version = 1
[lidar]
folder = "scans"
compensated = true
intensity_max = 255
length_unit = "mm"
time_unit = "us"
time_reference = "absolute"
[images]
tolerance = 0.02
[body]
T_lidar_body = [[1, 0, 0, -1], [0, 1, 0, 0], [0, 0, 1, 0.5], [0, 0, 0, 1]]
T_body_imu = {translation = [0, 0, 1], rotation = [0, 0, 1, 0]}
antenna = [0.5, 0, 1]
[camera.b]
index = 1
folder = "b"
width = 64
height = 48
K = [[40, 0, 32], [0, 41, 24], [0, 0, 1]]
distortion_model = "equidistant"
D = [0.1, 0.2, 0.3, 0.4]
field_of_view = 120
delay = -0.01
T_lidar_cam = {rotation = [0, 0, 0, 1], translation = [1, 2, 3]}
[camera.0]
index = 0
width = 64
height = 48
K = [40, 0, 32, 0, 41, 24, 0, 0, 1]
distortion_model = "rational_polynomial"
D = [0.3, 0.1, 0.001, 0.002, 0.01, 0.5, 0.2, 0.008, 0, 0, 0, 0]
T_cam_lidar = {translation = [0, 0, 0.1]}
)");
  EXPECT_EQ(drive.lidar.folder, "scans");
  EXPECT_TRUE(drive.lidar.sweep_compensated);
  EXPECT_EQ(drive.lidar.scan_format.intensity_max, 255);
  EXPECT_EQ(drive.lidar.scan_format.length_unit, 1e-3);
  EXPECT_EQ(drive.lidar.scan_format.time_unit, 1e-6);
  EXPECT_EQ(drive.lidar.scan_format.time_reference, TimeReference::kAbsolute);
  EXPECT_EQ(drive.image_tolerance, 0.02);
  EXPECT_LT((drive.T_body_lidar.translation() - Eigen::Vector3d(1, 0, -0.5)).norm(), 1e-12);
  EXPECT_EQ(drive.antenna_body, Eigen::Vector3d(0.5, 0, 1));
  // Half a turn about z.
  EXPECT_LT((drive.T_body_imu * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(-1, -2, 4)).norm(),
            1e-12);
  ASSERT_EQ(drive.cameras.size(), 2u);
  EXPECT_EQ(drive.cameras[0].name, "0");  // by index
  EXPECT_EQ(drive.cameras[0].optics.lens.model(), LensModel::kRationalPolynomial);
  EXPECT_EQ(drive.cameras[0].optics.lens.coefficients()[7], 0.008);
  const CameraDescription& b = drive.cameras[1];
  EXPECT_EQ(b.folder, "b");
  EXPECT_EQ(b.optics.fy, 41);
  EXPECT_EQ(b.optics.lens.model(), LensModel::kEquidistant);
  EXPECT_EQ(b.optics.lens.coefficients()[3], 0.4);
  EXPECT_NEAR(b.max_field_of_view, 2 * std::numbers::pi / 3, 1e-12);
  EXPECT_EQ(b.delay, -0.01);
  EXPECT_LT((b.T_cam_lidar.translation() + Eigen::Vector3d(1, 2, 3)).norm(), 1e-12);
}

TEST(DriveDescription, ErrorsNameFileLineAndKey) {
  EXPECT_THAT(error(kSmallest + "colour = 1\n"),
              AllOf(HasSubstr("unknown key"), HasSubstr("d.toml:8, key 'camera.left.colour'")));
  EXPECT_THAT(error(kSmallest + "[lidar]\nfolder = 3\n"),
              AllOf(HasSubstr("wrong type"), HasSubstr("d.toml:9, key 'lidar.folder'")));
  EXPECT_THAT(error("version = 1" + kCamera),
              AllOf(HasSubstr("a key is missing"), HasSubstr("d.toml:2"),
                    HasSubstr("camera.left.T_cam_lidar")));
  EXPECT_THAT(error(kCamera + kPlace),
              AllOf(HasSubstr("d.toml, key 'version'"), HasSubstr("write version = 1")));
  EXPECT_THAT(error("version = 2" + kCamera + kPlace), HasSubstr("has version 2"));
  EXPECT_THAT(error("version = 1\n[[camera]]\n"), HasSubstr("write [camera.NAME]"));
  EXPECT_THAT(error("version = \n"), HasSubstr("d.toml:1"));
}

/// The smallest drive with one line of it replaced.
std::string with(const std::string& line, const std::string& by) {
  std::string text = kSmallest;
  return text.replace(text.find(line), line.size(), by);
}

TEST(DriveDescription, WhatIsNoCalibrationIsRefused) {
  EXPECT_THAT(error(with("index = 3", "index = 10")), HasSubstr("give 0 to 9"));
  EXPECT_THAT(error(with("index = 3", "")), HasSubstr("camera.left.index"));
  EXPECT_THAT(error(with("width = 640", "width = 100000000")), HasSubstr("camera.left.width"));
  EXPECT_THAT(error(with("width = 640", "width = 640.5")), HasSubstr("whole number"));
  EXPECT_THAT(error(with("[400, 0,", "[400, 1,")), HasSubstr("no camera's matrix"));
  EXPECT_THAT(error(with("[400, 0,", "[nan, 0,")), HasSubstr("no camera's matrix"));
  EXPECT_THAT(error(with("[400, 0,", "[1e300, 0,")), HasSubstr("no camera's matrix"));
  EXPECT_THAT(error(with("[400, 0,", "[400,")), HasSubstr("8 numbers, not 9"));
  EXPECT_THAT(error(with("[0, -1, 0, 0.5", "[0, -2, 0, 0.5")), HasSubstr("not a rotation"));
  EXPECT_THAT(error(with("[0, -1, 0, 0.5", "[0, -1, nan, 0.5")), HasSubstr("not a rotation"));
  EXPECT_THAT(error(with("[0, -1, 0, 0.5", "[0, -1, 0, 5e3")), HasSubstr("over 20 m"));
  EXPECT_THAT(error(with("[0, -1, 0, 0.5", "[0, -1, 0")), HasSubstr("11 numbers, not 12 or 16"));
  EXPECT_THAT(error(kSmallest + "T_lidar_cam = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]\n"),
              HasSubstr("both ways"));
  EXPECT_THAT(error(kSmallest + "[body]\nT_body_imu = {rotation = [0, 0, 0, 2]}\n"),
              HasSubstr("not of length 1"));
  EXPECT_THAT(error(kSmallest + "[body]\nantenna = [1, 2]\n"), HasSubstr("body.antenna"));
  EXPECT_THAT(error(kSmallest + "[body]\nantenna = [0, 0, nan]\n"), HasSubstr("body.antenna"));
  EXPECT_THAT(error(kSmallest + "[images]\ntolerance = -1\n"), HasSubstr("give 0 to 1"));
  EXPECT_THAT(error(kSmallest + "[lidar]\nintensity_max = 0\n"), HasSubstr("intensity_max"));
  EXPECT_THAT(error(kSmallest + "[lidar]\ntime_unit = \"h\"\n"), HasSubstr("'auto', 's', 'ms'"));
  std::string twice = kSmallest + kCamera + kPlace;
  twice.replace(twice.rfind("[camera.left]"), 13, "[camera.right]");
  EXPECT_THAT(error(twice), HasSubstr("the same index"));
}

TEST(DriveDescription, LeverArmsOver20MetersAreRefused) {
  const auto has_length = [](const std::string& key, const std::string& length) {
    return AllOf(HasSubstr(key), HasSubstr("the distance is " + length + " m, over 20 m"),
                 HasSubstr("millimeters"));
  };
  EXPECT_THAT(error(with("[0, -1, 0, 0.5, 0, 0, -1, 0.25, 1, 0, 0, -0.125]",
                         "[0, -1, 0, 57.5, 0, 0, -1, -78.2, 1, 0, 0, 266.1]")),
              has_length("camera.left.T_cam_lidar", "283.25"));
  const auto body = [](const std::string& line) { return kSmallest + "[body]\n" + line + "\n"; };
  EXPECT_THAT(error(body("T_lidar_body = {translation = [0, 30, 0]}")),
              has_length("body.T_lidar_body", "30"));
  EXPECT_THAT(error(body("T_body_imu = {translation = [0, 0, -21]}")),
              has_length("body.T_body_imu", "21"));
  EXPECT_THAT(error(body("antenna = [-300, 0, 400]")), has_length("body.antenna", "500"));
  EXPECT_NO_THROW(parse(body("antenna = [12, 0, 16]")));
}

TEST(DriveDescription, LensesOfNoCameraAreRefused) {
  // In millimeters; of a sensor in meters; of another image's size.
  EXPECT_THAT(error(with("[400, 0, 320, 0, 410", "[2.5, 0, 320, 0, 2.5")),
              AllOf(HasSubstr("camera.left.K"), HasSubstr("field of view of 179.")));
  EXPECT_THAT(error(with("[400, 0, 320, 0, 410", "[90000, 0, 320, 0, 90000")),
              HasSubstr("field of view of 0.4"));
  EXPECT_THAT(error(with("[400, 0, 320, 0, 410", "[400, 0, 320, 0, 41")), HasSubstr("differ"));
  EXPECT_THAT(error(with("0, 320, 0", "0, 6500, 0")), HasSubstr("principal point at 6500"));
  EXPECT_NO_THROW(parse(with("0, 320, 0", "0, 1300, 0")));  // a part of a larger image
  const auto distorted = [](const std::string& model, const std::string& D) {
    return kSmallest + "distortion_model = \"" + model + "\"\nD = [" + D + "]\n";
  };
  EXPECT_THAT(error(distorted("plumb_bob", "-312, 150, 0, 0, 0")),
              AllOf(HasSubstr("camera.left.D"), HasSubstr("no inverse on")));
  EXPECT_THAT(error(distorted("plumb_bob", "312, 0, 0, 0, 0")), HasSubstr("narrows the view"));
  EXPECT_THAT(error(distorted("plumb_bob", "0, 0, 1e6, 1e6, 0")), HasSubstr("no inverse on"));
  // Corners without an inverse are usual.
  EXPECT_NO_THROW(parse(distorted("plumb_bob", "-0.4, 0, 0, 0, 0")));
  // A fisheye of 220 degrees across.
  EXPECT_NO_THROW(parse(with("[400, 0, 320, 0, 410", "[166, 0, 320, 0, 166") +
                        "distortion_model = \"equidistant\"\nD = [0, 0, 0, 0]\n"));
}

TEST(DriveDescription, DistortionIsChecked) {
  const auto distorted = [](const std::string& lines) { return kSmallest + lines; };
  EXPECT_THAT(error(distorted("distortion_model = \"thin_prism\"\n")),
              AllOf(HasSubstr("thin_prism"), HasSubstr("'plumb_bob', 'rational_polynomial'")));
  EXPECT_THAT(error(distorted("distortion_model = \"plumb_bob\"\nD = [1, 2, 3]\n")),
              HasSubstr("3 coefficients are not those of 'plumb_bob'"));
  EXPECT_THAT(error(distorted("distortion_model = \"equidistant\"\n")),
              HasSubstr("0 coefficients are not those of 'equidistant'"));
  EXPECT_THAT(error(distorted("D = [0.1]\n")), HasSubstr("1 coefficients are not those of 'none'"));
  EXPECT_THAT(error(distorted("distortion_model = \"plumb_bob\"\nD = [inf, 0, 0, 0]\n")),
              HasSubstr("4 coefficients"));
  EXPECT_THAT(error(distorted("field_of_view = 175\n")), HasSubstr("10 to 170 degrees"));
  EXPECT_NO_THROW(parse(distorted("D = [0, 0, 0, 0, 0]\n")));  // as ROS has rectified cameras
  EXPECT_NO_THROW(parse(distorted("distortion_model = \"plumb_bob\"\nD = [0.1, 0, 0, 0]\n")));
}

TEST(DriveDescription, TheDocumentationsExampleIsOne) {
  const std::string document = test::read_text(FOVEA_SOURCE_DIR "/docs/drives.md");
  const std::size_t begin = document.find("```toml\n") + 8, end = document.find("```", begin);
  ASSERT_NE(end, std::string::npos);
  const DriveDescription drive = parse(document.substr(begin, end - begin));
  ASSERT_EQ(drive.cameras.size(), 2u);
  // The left camera looks to the left, its x axis forward.
  const RigidMotion T_lidar_cam = drive.cameras[1].T_cam_lidar.inverse();
  EXPECT_LT((T_lidar_cam.linear() * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitY()).norm(),
            1e-6);
  EXPECT_LT((T_lidar_cam.linear() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitX()).norm(),
            1e-6);
  for (const CameraDescription& camera : drive.cameras) {
    const auto rectified = rectified_camera(camera.optics, camera.max_field_of_view, 8192);
    ASSERT_TRUE(rectified);
    EXPECT_GT(rectified->width, 1000);
  }
}

TEST(DriveDescription, AFileThatCannotBeReadIsAnInputError) {
  EXPECT_THAT(error_of<InputError>([] { read_drive_description("/nonexistent/drive.toml"); }),
              HasSubstr("/nonexistent/drive.toml"));
}

}  // namespace fovea::drive_description_test
