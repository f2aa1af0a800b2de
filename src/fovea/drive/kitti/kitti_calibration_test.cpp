#include "fovea/drive/kitti/kitti_calibration.h"

#include <gtest/gtest.h>

#include "../../../../tests/kitti_test_drive.h"
#include "fovea/errors.h"

namespace fovea::kitti_calibration_test {

using test::edit;
using test::error_of;
using test::TemporaryFolder;
using test::write_text;

// Numbers of the drives of 2011-09-26.
constexpr const char* kCamToCam =
    "calib_time: 09-Jan-2012 13:57:47\n"
    "corner_dist: 9.950000e-02\n"
    "S_rect_00: 1.242000e+03 3.750000e+02\n"
    "R_rect_00: 9.999239e-01 9.837760e-03 -7.445048e-03 -9.869795e-03 9.999421e-01 -4.278459e-03 "
    "7.402527e-03 4.351614e-03 9.999631e-01\n"
    "P_rect_00: 7.215377e+02 0.000000e+00 6.095593e+02 0.000000e+00 0.000000e+00 7.215377e+02 "
    "1.728540e+02 0.000000e+00 0.000000e+00 0.000000e+00 1.000000e+00 0.000000e+00\n"
    "S_rect_02: 1.242000e+03 3.750000e+02\n"
    "R_rect_02: 9.998817e-01 1.511453e-02 -2.841595e-03 -1.511724e-02 9.998853e-01 -9.338510e-04 "
    "2.827154e-03 9.766976e-04 9.999955e-01\n"
    "P_rect_02: 7.215377e+02 0.000000e+00 6.095593e+02 4.485728e+01 0.000000e+00 7.215377e+02 "
    "1.728540e+02 2.163791e-01 0.000000e+00 0.000000e+00 1.000000e+00 2.745884e-03\n"
    "S_rect_03: 1.242000e+03 3.750000e+02\n"
    "P_rect_03: 7.215377e+02 0.000000e+00 6.095593e+02 -3.395242e+02 0.000000e+00 7.215377e+02 "
    "1.728540e+02 2.199936e+00 0.000000e+00 0.000000e+00 1.000000e+00 2.729905e-03\n";
constexpr const char* kVeloToCam =
    "calib_time: 15-Mar-2012 11:37:16\n"
    "R: 7.533745e-03 -9.999714e-01 -6.166020e-04 1.480249e-02 7.280733e-04 -9.998902e-01 "
    "9.998621e-01 7.523790e-03 1.480755e-02\n"
    "T: -4.069766e-03 -7.631618e-02 -2.717806e-01\n"
    "delta_f: 0.000000e+00 0.000000e+00\n";
constexpr const char* kImuToVelo =
    "R: 9.999976e-01 7.553071e-04 -2.035826e-03 -7.854027e-04 9.998898e-01 -1.482298e-02 "
    "2.024406e-03 1.482454e-02 9.998881e-01\n"
    "T: -8.086759e-01 3.195559e-01 -7.997231e-01\n";

class KittiCalibrationTest : public testing::Test {
 protected:
  KittiCalibrationTest() {
    write_text(cam_to_cam_, kCamToCam);
    write_text(velo_to_cam_, kVeloToCam);
    write_text(imu_to_velo_, kImuToVelo);
  }
  KittiCalibration read() const { return read_kitti_raw_calibration(folder_.path()); }
  std::string message() const {
    return error_of<InputError>([&] { read(); });
  }
  bool fails_with(const std::string& text) const {
    return message().find(text) != std::string::npos;
  }

  TemporaryFolder folder_;
  test::fs::path cam_to_cam_ = folder_.path() / "calib_cam_to_cam.txt";
  test::fs::path velo_to_cam_ = folder_.path() / "calib_velo_to_cam.txt";
  test::fs::path imu_to_velo_ = folder_.path() / "calib_imu_to_velo.txt";
};

TEST_F(KittiCalibrationTest, ProjectsAPointAsTheMatricesDo) {
  // p = P_rect_02 * R_rect_00 * [R | T] * X, with awk over the files: X = (12, -1.5, 0.4).
  const Camera camera = read().cameras.at(2);
  const auto pixel = camera.project(camera.T_cam_lidar * Eigen::Vector3d(12, -1.5, 0.4));
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 705.2130, 0.01);
  EXPECT_NEAR(pixel->y(), 150.3557, 0.01);
}

TEST_F(KittiCalibrationTest, CamerasStandAsideOfCamera0) {
  const KittiCalibration calibration = read();
  ASSERT_EQ(calibration.cameras.size(), 3u);  // no camera 1 in the file
  const auto center_in_cam0 = [&](int k) {
    return Eigen::Vector3d(calibration.T_cam0_lidar * calibration.cameras.at(k).center_lidar());
  };
  EXPECT_LT(center_in_cam0(0).norm(), 1e-12);
  EXPECT_LT((center_in_cam0(2) - Eigen::Vector3d(-0.0598, 0.0004, -0.0027)).norm(), 1e-4);
  EXPECT_LT((center_in_cam0(3) - Eigen::Vector3d(0.4729, -0.0024, -0.0027)).norm(), 1e-4);
  const Camera& camera = calibration.cameras.at(3);
  EXPECT_EQ(camera.index, 3);
  EXPECT_EQ(camera.width, 1242);
  EXPECT_EQ(camera.height, 375);
  EXPECT_EQ(camera.fx, 721.5377);
  EXPECT_EQ(camera.fy, 721.5377);
  EXPECT_EQ(camera.cx, 609.5593);
  EXPECT_EQ(camera.cy, 172.854);
  EXPECT_TRUE(is_rotation(camera.T_cam_lidar.rotation(), 1e-12));
}

TEST_F(KittiCalibrationTest, ImuIsWhereTheFileSaysInTheLidarFrame) {
  const RigidMotion T_imu_lidar = read().T_imu_lidar.value();
  EXPECT_LT(
      (T_imu_lidar.inverse().translation() - Eigen::Vector3d(-0.8086759, 0.3195559, -0.7997231))
          .norm(),
      1e-9);
  test::fs::remove(imu_to_velo_);
  EXPECT_FALSE(read().T_imu_lidar);
}

TEST_F(KittiCalibrationTest, ErrorsNameFileAndLine) {
  edit(cam_to_cam_, "P_rect_02: 7.215377e+02", "P_rect_02:");
  EXPECT_TRUE(fails_with("P_rect_02 has 11 numbers, not 12")) << message();
  EXPECT_TRUE(fails_with("calib_cam_to_cam.txt:8,")) << message();
}

TEST_F(KittiCalibrationTest, NumbersMustBeNumbers) {
  edit(cam_to_cam_, "P_rect_02: 7.215377e+02", "P_rect_02: 7.2I5377e+02");
  EXPECT_TRUE(fails_with("no number")) << message();
  write_text(cam_to_cam_, kCamToCam);
  edit(velo_to_cam_, "-2.717806e-01", "nan");
  EXPECT_TRUE(fails_with("not finite")) << message();
  EXPECT_TRUE(fails_with("calib_velo_to_cam.txt:3")) << message();
}

TEST_F(KittiCalibrationTest, RotationsMustBeRotations) {
  edit(velo_to_cam_, "R: 7.533745e-03", "R: 7.533745e-01");
  EXPECT_TRUE(fails_with("R is not a rotation")) << message();
  EXPECT_TRUE(fails_with("calib_velo_to_cam.txt:2")) << message();
}

TEST_F(KittiCalibrationTest, ProjectionsAndSizesMustBeOnes) {
  edit(cam_to_cam_, "P_rect_02: 7.215377e+02 0.000000e+00", "P_rect_02: 7.215377e+02 3.0");
  EXPECT_TRUE(fails_with("not the projection of a rectified camera")) << message();
  write_text(cam_to_cam_, kCamToCam);
  edit(cam_to_cam_, "S_rect_02: 1.242000e+03", "S_rect_02: 1.242000e+08");
  EXPECT_TRUE(fails_with("no image size")) << message();
}

TEST_F(KittiCalibrationTest, SensorsAreNotFartherApartThanOnAVehicle) {
  edit(velo_to_cam_, "T: -4.069766e-03", "T: -4.069766e+03");
  EXPECT_TRUE(fails_with("T has a translation of 4069.77 m, over 20 m")) << message();
  EXPECT_TRUE(fails_with("give it in meters: these are likely millimeters")) << message();
  EXPECT_FALSE(fails_with("archive")) << message();
  EXPECT_TRUE(fails_with("calib_velo_to_cam.txt:3")) << message();
  write_text(velo_to_cam_, kVeloToCam);
  // The inverse of such a focal length is infinite, and the translation not a number.
  edit(cam_to_cam_, "P_rect_02: 7.215377e+02", "P_rect_02: 1e-320");
  EXPECT_TRUE(fails_with("P_rect_02 has a translation of")) << message();
  EXPECT_FALSE(fails_with("millimeters")) << message();
}

TEST_F(KittiCalibrationTest, FocalLengthsInMillimetersAreRefused) {
  edit(cam_to_cam_, "P_rect_02: 7.215377e+02", "P_rect_02: 3.2e+00");
  EXPECT_TRUE(fails_with("P_rect_02 is wrong: a focal length of 3.2 for a width of 1242 pixels"))
      << message();
  EXPECT_TRUE(fails_with("give fx and fy in pixels")) << message();
  EXPECT_FALSE(fails_with("archive")) << message();
}

TEST_F(KittiCalibrationTest, MissingKeysAndFiles) {
  edit(cam_to_cam_, "S_rect_03:", "S_xxxx_03:");
  EXPECT_TRUE(fails_with("S_rect_03 is missing")) << message();
  edit(cam_to_cam_, "R_rect_00:", "R_xxxx_00:");
  EXPECT_TRUE(fails_with("R_rect_00 is missing")) << message();
  test::fs::remove(velo_to_cam_);
  write_text(cam_to_cam_, kCamToCam);
  EXPECT_TRUE(fails_with("the calibration file is missing")) << message();
  EXPECT_TRUE(fails_with("calib_velo_to_cam.txt")) << message();
}

TEST(KittiOdometryCalibration, ReadsProjectionsAndTr) {
  const TemporaryFolder folder;
  const auto file = test::write_odometry_sequence(folder.path(), 1) / "calib.txt";
  const KittiCalibration calibration = read_kitti_odometry_calibration(file);
  ASSERT_EQ(calibration.cameras.size(), 4u);
  // 10 m ahead of the LiDAR, 9.75 m ahead of camera 0; camera 1 is 0.5 m to the right.
  const Camera& camera = calibration.cameras.at(1);
  const auto pixel = camera.project(camera.T_cam_lidar * Eigen::Vector3d(10, 0, 0));
  ASSERT_TRUE(pixel);
  EXPECT_NEAR(pixel->x(), 11.5 - 20 * 0.5 / 9.75, 1e-12);
  EXPECT_NEAR(pixel->y(), 4.5, 1e-12);
  edit(file, "Tr:", "Xr:");
  EXPECT_NE(
      error_of<InputError>([&] { read_kitti_odometry_calibration(file); }).find("Tr is missing"),
      std::string::npos);
}

}  // namespace fovea::kitti_calibration_test
