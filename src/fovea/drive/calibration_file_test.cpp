#include "fovea/drive/calibration_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/temporary_folder.h"
#include "fovea/drive/drive_description.h"
#include "fovea/errors.h"

namespace fovea::calibration_file_test {

using testing::AllOf;
using testing::HasSubstr;

const char* const kCamchain =
    "cam0:\n  camera_model: pinhole\n  distortion_model: radtan\n  intrinsics: [400, 410, 320, "
    "240]\n"
    "  distortion_coeffs: [-0.3, 0.1, 0.001, -0.002]\n  resolution: [640, 480]\n"
    "cam1:\n  camera_model: pinhole\n  distortion_model: equidistant\n"
    "  intrinsics: [300, 301, 319, 239]\n  distortion_coeffs: [0.01, 0.002, 0.0003, 0]\n"
    "  resolution: [640, 480]\n  T_cn_cnm1: [[1, 0, 0, 0.1], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, "
    "1]]\n";

class CalibrationFileTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    std::ofstream(folder_ / "c.yaml", std::ios::binary) << text;
    return folder_ / "c.yaml";
  }
  std::string error_of(const std::string& text, const std::string& camera = "") {
    try {
      read_calibration_file(write(text), camera);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  TemporaryFolder folder_;
};

TEST_F(CalibrationFileTest, ReadsCamchainsOfKalibr) {
  const LensCamera first = read_calibration_file(write(kCamchain), "cam0");
  EXPECT_EQ(first.width, 640);
  EXPECT_EQ(first.fy, 410);
  EXPECT_EQ(first.cx, 320);
  EXPECT_EQ(first.lens.model(), LensModel::kPlumbBob);
  EXPECT_EQ(first.lens.coefficients()[3], -0.002);
  EXPECT_EQ(read_calibration_file(write(kCamchain), "cam1").lens.model(), LensModel::kEquidistant);
}

TEST_F(CalibrationFileTest, ReadsRosAndSensorsCalibration) {
  const LensCamera ros = read_calibration_file(
      write("image_width: 640\nimage_height: 480\ncamera_name: a\ncamera_matrix:\n  rows: 3\n  "
            "cols: 3\n"
            "  data: [400, 0, 320, 0, 410, 240, 0, 0, 1]\ndistortion_model: plumb_bob\n"
            "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: [-0.3, 0.1, 0, 0, 0.05]\n"),
      "");
  EXPECT_EQ(ros.fx, 400);
  EXPECT_EQ(ros.lens.coefficients()[4], 0.05);
  const LensCamera json = read_calibration_file(
      write(R"({"center_camera-intrinsic": {"sensor_name": "center_camera", "param": {)"
            R"("img_dist_w": 1920, "img_dist_h": 1080,)"
            R"("cam_K": {"rows": 3, "cols": 3, "data": [[900, 0, 960], [0, 910, 540], [0, 0, 1]]},)"
            R"("cam_dist": {"cols": 4, "data": [[-0.3, 0.1, 0.001, 0]]}}}})"),
      "");
  EXPECT_EQ(json.width, 1920);
  EXPECT_EQ(json.fy, 910);
  EXPECT_EQ(json.lens.coefficients()[2], 0.001);
}

TEST_F(CalibrationFileTest, RefusesOtherModelsByName) {
  const auto with = [](const char* camera, const char* distortion) {
    return std::string("cam0:\n  camera_model: ") + camera + "\n  distortion_model: " + distortion +
           "\n  intrinsics: [1, 2, 3, 4]\n  distortion_coeffs: [0]\n  resolution: [640, 480]\n";
  };
  EXPECT_THAT(error_of(with("ds", "none")), AllOf(HasSubstr("'ds'"), HasSubstr("c.yaml")));
  EXPECT_THAT(error_of(with("omni", "radtan")), HasSubstr("'omni'"));
  EXPECT_THAT(error_of(with("pinhole", "fov")), HasSubstr("'fov'"));
  EXPECT_THAT(error_of(with("pinhole", "equidistant")), HasSubstr("coefficients"));
  EXPECT_THAT(error_of(kCamchain), AllOf(HasSubstr("2 cameras"), HasSubstr("camchain.yaml:cam0")));
  EXPECT_THAT(error_of(kCamchain, "cam7"), HasSubstr("'cam7'"));
  for (const char* other :
       {"", "a text", "[1, 2]", "a: {b: 1}", "a: [1", "cam0: {camera_model: pinhole}"}) {
    EXPECT_THAT(error_of(other), HasSubstr("c.yaml")) << other;
  }
}

TEST_F(CalibrationFileTest, ACameraOfADriveNamesItsFile) {
  write(kCamchain);
  const std::string camera =
      "index = 0\nT_cam_lidar = [[0, -1, 0, 0], [0, 0, -1, 0], [1, 0, 0, 0]]\n";
  const auto describe = [&](const std::string& keys) {
    std::ofstream(folder_ / "drive.toml") << "version = 1\n[camera.front]\n" + camera + keys;
    return read_drive_description(folder_ / "drive.toml");
  };
  const DriveDescription drive = describe("calibration = \"c.yaml:cam0\"\n");
  EXPECT_EQ(drive.cameras[0].optics.fx, 400);
  EXPECT_EQ(drive.cameras[0].optics.height, 480);
  EXPECT_THROW(describe("calibration = \"c.yaml:cam0\"\nwidth = 640\n"), ConfigError);
  EXPECT_THROW(describe("calibration = \"c.yaml\"\n"), InputError);
  EXPECT_THROW(describe("calibration = \"other.yaml\"\n"), InputError);
}

}  // namespace fovea::calibration_file_test
