#include "fovea/mapping/calibration/lens_check.h"

#include <gtest/gtest.h>

#include "fovea/mapping/calibration/board_drive_test_support.h"

namespace fovea::lens_check_test {

using namespace board_drive_test;

class LensCheckTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { drive_ = new BoardDrive(board_drive()); }
  static void TearDownTestSuite() { delete drive_; }

  static LensCheck check(const BoardDrive& drive, const Camera& camera) {
    return check_lens(profiles_of_views(drive.views, camera, drive.T_local_lidar), camera);
  }

  static inline const BoardDrive* drive_ = nullptr;
};

TEST_F(LensCheckTest, ARightLensIsNotOdd) {
  for (const double sign : {0, 1}) {  // 1: small errors, as an estimate leaves them
    const Camera camera =
        given_camera({.rotation = sign * Eigen::Vector3d(0.1, -0.1, 0.1) * kDegree,
                      .translation = sign * Eigen::Vector3d(0.01, 0.01, -0.02),
                      .delay = sign * 0.002});
    const LensCheck lens = check(*drive_, camera);
    EXPECT_TRUE(lens.is_checked);
    EXPECT_FALSE(lens.has_odd_focal());
    EXPECT_FALSE(lens.has_odd_distortion());
    EXPECT_LT(std::abs(lens.focal), 3 * lens.focal_sigma);
    EXPECT_LT(std::abs(lens.radial), 3 * lens.radial_sigma);
    EXPECT_LT(std::abs(lens.focal), 0.002);
    EXPECT_LT(std::abs(lens.radial), 0.005);
  }
}

TEST_F(LensCheckTest, FindsAWrongFocalLength) {
  for (const double longer : {0.03, -0.03}) {
    Camera camera = true_camera();
    camera.fx /= 1 + longer;
    camera.fy /= 1 + longer;
    const LensCheck lens = check(*drive_, camera);
    EXPECT_TRUE(lens.has_odd_focal());
    EXPECT_FALSE(lens.has_odd_distortion());
    EXPECT_NEAR(lens.focal, longer, 0.003);
    EXPECT_NEAR(lens.focal, longer, 3 * lens.focal_sigma);
  }
}

TEST_F(LensCheckTest, FindsRadialDistortion) {
  for (const double radial : {0.05, -0.05}) {
    BoardDriveOptions options;
    options.views = 8;
    options.radial = radial;
    const LensCheck lens = check(board_drive(options), true_camera());
    EXPECT_TRUE(lens.has_odd_distortion());
    EXPECT_FALSE(lens.has_odd_focal());
    EXPECT_NEAR(lens.radial, radial, 0.01);
    EXPECT_NEAR(lens.radial, radial, 3 * lens.radial_sigma);
  }
}

TEST_F(LensCheckTest, FewEdgesAreNotChecked) {
  Camera camera = true_camera();
  camera.fx *= 1.05;
  camera.fy *= 1.05;
  auto profiles = profiles_of_views(drive_->views, camera, drive_->T_local_lidar);
  EXPECT_TRUE(check_lens(profiles, camera).has_odd_focal());
  profiles.resize(400);
  for (const auto& few : {profiles, std::vector<EdgeProfile>{}}) {
    const LensCheck lens = check_lens(few, camera);
    EXPECT_FALSE(lens.is_checked);
    EXPECT_FALSE(lens.has_odd_focal());
    EXPECT_FALSE(lens.has_odd_distortion());
  }
}

// The image of a standing LiDAR does not change, and delays move nothing.
TEST_F(LensCheckTest, AStandingLidarIsEnough) {
  BoardDriveOptions options;
  options.route = {.speed = 0, .unsteady = 0};
  options.views = 4;
  Camera camera = true_camera();
  camera.fx /= 1.03;
  camera.fy /= 1.03;
  const LensCheck lens = check(board_drive(options), camera);
  EXPECT_TRUE(lens.is_checked);
  EXPECT_NEAR(lens.focal, 0.03, 0.01);
  EXPECT_TRUE(std::isfinite(lens.focal_sigma) && std::isfinite(lens.radial_sigma));
}

}  // namespace fovea::lens_check_test
