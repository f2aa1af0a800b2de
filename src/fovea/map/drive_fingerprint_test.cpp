#include "fovea/map/drive_fingerprint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace fovea::drive_fingerprint_test {

Calibration two_cameras() {
  Calibration calibration;
  for (const int index : {2, 3}) {
    Camera camera;
    camera.index = index;
    camera.width = 1242;
    camera.height = 375;
    camera.fx = camera.fy = 721.5;
    camera.T_cam_lidar.translation() = Eigen::Vector3d(0.1 * index, 0, 0);
    calibration.cameras.push_back(camera);
  }
  calibration.T_imu_lidar = RigidMotion::Identity();
  return calibration;
}

TEST(CalibrationFingerprint, ChangesWithEachNumber) {
  std::set<std::string> fingerprints = {calibration_fingerprint(two_cameras(), {})};
  const auto expect_new = [&](auto&& change) {
    Calibration calibration = two_cameras();
    change(calibration);
    EXPECT_TRUE(fingerprints.insert(calibration_fingerprint(calibration, {})).second);
  };
  expect_new([](Calibration& c) { c.cameras[0].width = 1241; });
  expect_new([](Calibration& c) { c.cameras[1].fy += 1e-6; });
  expect_new([](Calibration& c) { c.cameras[1].image_delay = 0.001; });
  expect_new([](Calibration& c) { c.cameras[0].T_cam_lidar.translation().x() = 0.2001; });
  expect_new([](Calibration& c) { c.T_imu_lidar.reset(); });
  expect_new([](Calibration& c) { c.cameras.pop_back(); });
}

TEST(CalibrationFingerprint, RoundingChangesNothing) {
  Calibration calibration = two_cameras();
  calibration.cameras[0].fx = std::nextafter(calibration.cameras[0].fx, 1e9);
  calibration.cameras[0].T_cam_lidar.translation().y() = -1e-17;
  EXPECT_EQ(calibration_fingerprint(calibration, {}), calibration_fingerprint(two_cameras(), {}));
}

// The same camera has the same hash, whatever cameras are in use next to it.
TEST(CalibrationFingerprint, NamesEachCamera) {
  Calibration one = two_cameras();
  one.cameras.erase(one.cameras.begin());
  const std::string both = calibration_fingerprint(two_cameras(), {});
  const std::string single = calibration_fingerprint(one, {});
  ASSERT_EQ(both.size(), 20u + 1 + 18 + 1 + 18);
  EXPECT_EQ(single.substr(0, 20), both.substr(0, 20));
  EXPECT_EQ(single.substr(0, 4), "imu:");
  EXPECT_EQ(single.substr(21), both.substr(40));
  EXPECT_EQ(single.substr(21, 2), "3:");
}

TEST(CalibrationFingerprint, DifferencesAreNamed) {
  const std::string before = "imu:1 2:3 3:4";
  EXPECT_EQ(calibration_difference(before, before), std::nullopt);
  EXPECT_EQ(calibration_difference(before, "imu:1 2:5 3:4"), "camera 2");
  EXPECT_EQ(calibration_difference(before, "imu:2 2:3 3:4"), "the place of the IMU");
  EXPECT_EQ(calibration_difference(before, "2:3"), "camera 3, the place of the IMU");
  EXPECT_EQ(calibration_difference("", ""), std::nullopt);
}

TEST(StampsFingerprint, ChangesWithEachStampAndItsFrame) {
  using Stamps = std::vector<std::optional<TimeNs>>;
  const std::set<std::string> fingerprints = {
      stamps_fingerprint(0, Stamps{1, 2, 3}),     stamps_fingerprint(1, Stamps{1, 2, 3}),
      stamps_fingerprint(0, Stamps{1, 2, 4}),     stamps_fingerprint(0, Stamps{1, 2}),
      stamps_fingerprint(0, Stamps{1, {}, 3}),    stamps_fingerprint(0, Stamps{}),
      stamps_fingerprint(0, Stamps{1, 2, 3, {}}),
  };
  EXPECT_EQ(fingerprints.size(), 7u);
  EXPECT_EQ(fingerprints.begin()->size(), 32u);
}

TEST(CalibrationFingerprint, HasThePosesOfFurtherLidars) {
  std::vector<MountedLidar> lidars(2);
  const std::string before = calibration_fingerprint(two_cameras(), lidars);
  lidars[1].T_lidar_sensor.translation().x() = 0.01;
  const std::string after = calibration_fingerprint(two_cameras(), lidars);
  EXPECT_EQ(calibration_difference(before, after), "the pose of LiDAR 1");
  EXPECT_EQ(calibration_difference(calibration_fingerprint(two_cameras(), {}), after),
            "the pose of LiDAR 1");
}

}  // namespace fovea::drive_fingerprint_test
