#include "fovea/pipeline/view_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/errors.h"

namespace fovea::view_check_test {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A camera at the LiDAR, directed ahead or up.
Camera camera(int index, bool looks_up) {
  Camera camera;
  camera.index = index;
  camera.width = camera.height = 100;
  camera.fx = camera.fy = 100;
  camera.cx = camera.cy = 49.5;
  if (!looks_up) camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return camera;
}

DriveInfo drive_with(std::vector<Camera> cameras) {
  DriveInfo drive;
  drive.path = "the/drive";
  drive.calibration.cameras = std::move(cameras);
  return drive;
}

PointCloud scan_of(const Eigen::Vector3f& p_lidar) {
  PointCloud scan;
  scan.position = {Eigen::Vector3f(-5, 1, 0), p_lidar};
  return scan;
}

const Eigen::Vector3f kAhead(10, 0, 0), kBehind(-10, 0, 0);

std::string error_of(const ViewCheck& check) {
  try {
    check.require_view();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ViewCheck, OnePointInOneViewIsEnough) {
  const DriveInfo drive = drive_with({camera(0, true), camera(3, false)});
  ViewCheck check(drive);
  check.add(scan_of(kBehind));
  check.add(scan_of(kAhead));
  EXPECT_TRUE(check.passed());
  EXPECT_EQ(error_of(check), "");
  EXPECT_THAT(check.notes(), ElementsAre(HasSubstr("camera 0 sees no point of 2 scans")));
}

TEST(ViewCheck, NoPointInAnyViewIsAnErrorThatNamesTheLikelyCause) {
  const DriveInfo drive = drive_with({camera(0, true), camera(1, true)});
  ViewCheck check(drive);
  check.add(scan_of(kAhead));
  EXPECT_FALSE(check.passed());
  EXPECT_THAT(error_of(check), AllOf(HasSubstr("no camera sees a point of 1 scan,"),
                                     HasSubstr("the/drive"), HasSubstr("T_cam_lidar")));
}

TEST(ViewCheck, LongDrivesEndEarly) {
  const DriveInfo drive = drive_with({camera(0, true)});
  ViewCheck check(drive);
  for (int i = 1; i < ViewCheck::kMaxScans; ++i) EXPECT_NO_THROW(check.add(scan_of(kAhead)));
  EXPECT_THROW(check.add(scan_of(kAhead)), InputError);
}

TEST(ViewCheck, DrivesWithoutCamerasAndResumedOnesPass) {
  const DriveInfo scans_only = drive_with({});
  ViewCheck none(scans_only);
  none.add(scan_of(kAhead));
  EXPECT_TRUE(none.passed());
  const DriveInfo drive = drive_with({camera(0, true)});
  ViewCheck resumed(drive);
  resumed.skip();
  EXPECT_TRUE(resumed.passed());
  EXPECT_THAT(resumed.notes(), IsEmpty());
}

}  // namespace fovea::view_check_test
