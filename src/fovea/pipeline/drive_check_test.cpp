#include "fovea/pipeline/drive_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "../../../tests/synthetic_drive.h"
#include "fovea/errors.h"

namespace fovea::drive_check_test {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

/// A street with a post at the right, 0.5 m wide.
BoxScene scene() { return {{{{-30, -9, -1.7}, {40, 9, 8}}, {{9, -3.25, -1.7}, {9.5, -2.75, 3}}}}; }

SyntheticDrive drive() { return {scene(), 12, 0.5}; }

TEST(DriveCheck, TellsWhatADriveContains) {
  const SyntheticDrive drive = drive_check_test::drive();
  const DriveCheck check = check_drive(drive, 4);
  EXPECT_EQ(check.frames, 12u);
  EXPECT_EQ(check.sampled, 4u);
  EXPECT_NEAR(*check.duration, 1.1, 1e-9);
  EXPECT_NEAR(*check.period, 0.1, 1e-9);
  EXPECT_THAT(check.gaps, IsEmpty());
  EXPECT_GT(check.points_per_scan, 10'000);
  EXPECT_GT(check.near_range, 1.7);
  EXPECT_LT(check.far_range, 40);
  EXPECT_EQ(check.lidars.front().profile.ring_elevations.size(), 48u);
  ASSERT_EQ(check.cameras.size(), 1u);
  EXPECT_EQ(check.cameras[0].number, 2);
  EXPECT_EQ(check.cameras[0].missing, 0u);
  EXPECT_EQ(check.navigation_poses, 12u);
  EXPECT_THAT(check.plan, Contains(HasSubstr("camera 2 colors the map")));
  EXPECT_THAT(check.plan, Contains(HasSubstr("undone already")));
  EXPECT_THAT(check.oddities, IsEmpty());
}

TEST(DriveCheck, PointsOutOddities) {
  SyntheticDrive drive = drive_check_test::drive();
  drive.paused_frame = 7;
  drive.pause = 4 * kNsPerSecond;
  const DriveCheck check = check_drive(drive, 20);
  ASSERT_EQ(check.gaps.size(), 1u);
  EXPECT_EQ(check.gaps[0].frame, 6);
  EXPECT_NEAR(check.gaps[0].seconds, 4.1, 1e-9);
  EXPECT_THAT(check.oddities, Contains(HasSubstr("4.1 s after frame 6")));
}

/// Skips or spoils the frames of a drive.
class SpoiledDrive : public SyntheticDrive {
 public:
  using SyntheticDrive::SyntheticDrive;
  int skipped_from = 0;  ///< frames from here on have no scan

  LoadedFrame load(int index) const override {
    if (index >= skipped_from) return SkippedFrame{index, SkipReason::kMissingScan, "no file"};
    auto frame = std::get<Frame>(SyntheticDrive::load(index));
    frame.dropped_points.not_finite = frame.scan.size();
    frame.images[0] = Image();
    frame.missing_images.push_back({2, SkipReason::kMissingImage, "no file"});
    return frame;
  }
};

TEST(DriveCheck, CountsWhatCannotBeUsed) {
  SpoiledDrive drive(scene(), 6, 0.5);
  drive.skipped_from = 4;
  const DriveCheck check = check_drive(drive, 6);
  EXPECT_EQ(check.skipped.at(to_string(SkipReason::kMissingScan)), 2u);
  EXPECT_EQ(check.cameras[0].missing, 4u);
  EXPECT_EQ(check.dropped.not_finite, check.points);
  EXPECT_THAT(check.oddities, Contains(HasSubstr("2 of 6 frames")));
  EXPECT_THAT(check.oddities, Contains(HasSubstr("camera 2 has no image for 4 of 6")));
  EXPECT_THAT(check.oddities, Contains(HasSubstr("not finite")));
  EXPECT_THROW(calibration_overlay(drive, 0, 0), InputError);
  drive.skipped_from = 0;
  EXPECT_THROW(check_drive(drive, 6), InputError);
}

// The edges of the scan lie on those of the post in the image, and beside them if the calibration
// is wrong.
TEST(DriveCheck, TheOverlayHasTheEdgesWhereTheImageHasThem) {
  SyntheticDrive drive = drive_check_test::drive();
  drive.beams = 64, drive.columns = 2000;  // edges need beams as close as an HDL-64's
  const auto share_at_post = [&] {
    const Image overlay = calibration_overlay(drive, 0, 0);
    const Image photograph = std::get<Frame>(drive.load(0)).images[0];
    const SyntheticDrive right = drive_check_test::drive();
    const Camera& camera = right.info().calibration.cameras[0];
    const auto column = [&](double x, double y) {
      return camera.project(camera.T_cam_lidar * Eigen::Vector3d(x, y, 0))->x();
    };
    std::size_t drawn = 0, at_post = 0;
    for (int v = 0; v < overlay.height; ++v) {
      for (int u = 0; u < overlay.width; ++u) {
        const bool is_drawn = overlay.pixel(u, v)[0] != photograph.pixel(u, v)[0] / 2;
        drawn += is_drawn;
        at_post += is_drawn &&
                   std::min(std::abs(u - column(9.5, -2.75)), std::abs(u - column(9, -3.25))) < 4;
      }
    }
    EXPECT_GT(drawn, 100u);
    return double(at_post) / double(drawn);
  };
  EXPECT_GT(share_at_post(), 0.9);
  Camera& camera = drive.editable_info().calibration.cameras[0];
  camera.T_cam_lidar.prerotate(Eigen::AngleAxisd(0.03, Eigen::Vector3d::UnitY()));
  EXPECT_LT(share_at_post(), 0.2);
}

}  // namespace fovea::drive_check_test
