#include "fovea/pipeline/stored_calibration.h"

#include <gtest/gtest.h>

#include "fovea/errors.h"

namespace fovea::stored_calibration_test {

std::unique_ptr<FrameSource> two_cameras() {
  class TwoCameras : public FrameSource {
   public:
    TwoCameras() {
      for (const int number : {2, 3}) {
        Camera camera;
        camera.index = number;
        camera.T_cam_lidar.translation() = Eigen::Vector3d(0.1 * number, -0.08, -0.27);
        info_.calibration.cameras.push_back(camera);
      }
    }
    const DriveInfo& info() const override { return info_; }
    LoadedFrame load(int index) const override {
      return SkippedFrame{index, SkipReason::kMissingScan, ""};
    }
    std::optional<TimeNs> stamp(int index) const override { return TimeNs(index); }

   private:
    DriveInfo info_;
  };
  return std::make_unique<TwoCameras>();
}

TEST(StoredCalibration, ComesBackExactly) {
  CameraCalibration found;
  found.camera = 3;
  found.estimate.correction.rotation = {0.0051234567890123, -0.002, 1e-9};
  found.estimate.correction.translation = {0.012, -0.1999999999, 0.25};
  found.estimate.correction.delay = 0.0199999;
  MapMeta meta;
  EXPECT_FALSE(has_stored_calibration(meta));
  store_calibration({.cameras = {found}, .imu = {}}, meta);
  EXPECT_TRUE(has_stored_calibration(meta));

  const auto drive = with_stored_calibration(two_cameras(), meta, "some.fovea");
  const auto given = two_cameras();
  const auto& cameras = drive->info().calibration.cameras;
  const auto& as_given = given->info().calibration.cameras;
  // Camera 2 has no correction.
  EXPECT_TRUE(cameras.at(0).T_cam_lidar.isApprox(as_given.at(0).T_cam_lidar, 0));
  EXPECT_EQ(cameras.at(0).image_delay, 0);
  const Camera expected = corrected(as_given.at(1), found.estimate.correction);
  EXPECT_EQ(cameras.at(1).T_cam_lidar.matrix(), expected.T_cam_lidar.matrix());
  EXPECT_EQ(cameras.at(1).image_delay, found.estimate.correction.delay);
  EXPECT_EQ(*drive->stamp(7), 7);
  EXPECT_TRUE(std::holds_alternative<SkippedFrame>(drive->load(7)));
}

TEST(StoredCalibration, NamesTheFault) {
  EXPECT_THROW(with_stored_calibration(two_cameras(), {}, "some.fovea"), InputError);
  for (const auto& [key, text] : std::vector<std::pair<std::string, std::string>>{
           {"calibration.camera_2.rotation_rad", ""},
           {"calibration.camera_2.rotation_rad", "1 2"},
           {"calibration.camera_2.rotation_rad", "1 2 x"},
           {"calibration.camera_2.rotation_rad", "1 2 3 4"},
           {"calibration.camera_2.delay_s", "1 2"},
           {"calibration.camera_2.delay_s", "x"}}) {
    EXPECT_THROW(with_stored_calibration(two_cameras(), {{key, text}}, "some.fovea"), InputError)
        << key << ' ' << text;
  }
}

}  // namespace fovea::stored_calibration_test
