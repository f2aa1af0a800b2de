// The calibration that is written is read back by the product's own reader.
#include <gtest/gtest.h>

#include <fstream>

#include "../../../tests/temporary_folder.h"
#include "fovea/drive/kitti/kitti_calibration.h"
#include "fovea/simulation/drive_texts.h"

namespace fovea::calibration_round_trip_test {

KittiCalibration read_back(const Rig& rig, const SimulationOptions& options) {
  const TemporaryFolder folder;
  const CalibrationTexts texts = calibration_texts(rig, options);
  std::ofstream(folder / "calib_cam_to_cam.txt") << texts.cam_to_cam;
  std::ofstream(folder / "calib_velo_to_cam.txt") << texts.velo_to_cam;
  std::ofstream(folder / "calib_imu_to_velo.txt") << texts.imu_to_velo;
  return read_kitti_raw_calibration(folder.path());
}

TEST(SimulatedCalibration, ReaderFindsTheRig) {
  SimulationOptions options;
  options.camera.cameras.clear();
  for (int k = 0; k < 10; ++k) options.camera.cameras.push_back({k, 0.1 * k - 0.2, k < 2});
  const Rig rig = make_rig(options);
  const KittiCalibration calibration = read_back(rig, options);
  ASSERT_EQ(calibration.cameras.size(), 10u);
  for (const Camera& expected : rig.cameras) {
    const Camera& camera = calibration.cameras.at(expected.index);
    EXPECT_EQ(camera.width, expected.width);
    EXPECT_EQ(camera.height, expected.height);
    EXPECT_EQ(camera.fx, expected.fx);
    EXPECT_EQ(camera.fy, expected.fy);
    EXPECT_EQ(camera.cx, expected.cx);
    EXPECT_EQ(camera.cy, expected.cy);
    EXPECT_LT((camera.T_cam_lidar.matrix() - expected.T_cam_lidar.matrix()).cwiseAbs().maxCoeff(),
              1e-12);
  }
  ASSERT_TRUE(calibration.T_imu_lidar);
  EXPECT_LT((calibration.T_imu_lidar->matrix() - rig.T_imu_lidar.matrix()).cwiseAbs().maxCoeff(),
            1e-12);
}

TEST(SimulatedCalibration, LeavesThePlantedRotationOut) {
  SimulationOptions options;
  options.camera.rotation_error = {0.01, -0.02, 0.03};
  const Rig rig = make_rig(options);
  const KittiCalibration calibration = read_back(rig, options);
  for (const Camera& standing : rig.cameras) {
    // The cameras turn round camera 0, which stays where it is.
    const RigidMotion T_standing_written =
        standing.T_cam_lidar * calibration.cameras.at(standing.index).T_cam_lidar.inverse();
    const Twist error = log_se3(T_standing_written);
    EXPECT_LT((error.head<3>() - options.camera.rotation_error).norm(), 1e-9);
    const Eigen::Vector3d center_cam0 = rig.t[std::size_t(standing.index == 3)];
    EXPECT_LT((T_standing_written * center_cam0 - center_cam0).norm(), 1e-9);
  }
}

TEST(SimulatedCalibration, HasAllOfKittisCameras) {
  SimulationOptions options;
  options.camera.cameras = {{5, 0.2, false}};
  const auto cameras = read_back(make_rig(options), options).cameras;
  EXPECT_EQ(cameras.size(), 5u);
  EXPECT_TRUE(cameras.contains(0) && cameras.contains(3) && cameras.contains(5));
}

}  // namespace fovea::calibration_round_trip_test
