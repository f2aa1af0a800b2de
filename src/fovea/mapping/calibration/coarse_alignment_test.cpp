#include "fovea/mapping/calibration/coarse_alignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/core/parallel.h"
#include "fovea/mapping/calibration/board_drive_test_support.h"

namespace fovea::coarse_alignment_test {

using namespace board_drive_test;

CameraCorrection error(double pitch, double yaw, double roll, double ms) {
  return {.rotation = Eigen::Vector3d(pitch, yaw, roll) * kDegree, .delay = 1e-3 * ms};
}

class CoarseAlignment : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    BoardDriveOptions options;
    options.views = 8;
    drive_ = new BoardDrive(board_drive(options));
  }
  static void TearDownTestSuite() { delete drive_; }

  static std::vector<CameraCorrection> found(const CameraCorrection& truth) {
    return coarse_corrections(drive_->views, given_camera(truth), drive_->T_local_lidar);
  }

  static inline const BoardDrive* drive_ = nullptr;
};

TEST_F(CoarseAlignment, FindsLargeErrors) {
  for (const CameraCorrection& truth : {error(5, 0, 0, 0), error(0, -4, 0, 0), error(0, 0, 5, 0),
                                        error(0, 0, 0, 100), error(-3, 3, -3, -60)}) {
    const std::vector<CameraCorrection> candidates = found(truth);
    const bool is_found =
        std::any_of(candidates.begin(), candidates.end(), [&](const CameraCorrection& c) {
          return (c.rotation - truth.rotation).cwiseAbs().maxCoeff() < 0.5 * kDegree &&
                 c.translation.norm() < 0.12 && std::abs(c.delay - truth.delay) < 0.015;
        });
    EXPECT_TRUE(is_found) << truth.rotation.transpose() / kDegree << " " << truth.delay;
  }
}

TEST_F(CoarseAlignment, TheFirstOfARightCalibrationIsNearAtAnyNumberOfThreads) {
  std::vector<CameraCorrection> one, two;
  {
    const ThreadLimit limit(1);
    one = found({});
  }
  {
    const ThreadLimit limit(2);
    two = found({});
  }
  ASSERT_FALSE(one.empty());
  EXPECT_LT(one.front().rotation.norm(), 0.3 * kDegree);
  EXPECT_LT(one.front().translation.norm(), 0.12);
  EXPECT_LT(std::abs(one.front().delay), 0.006);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].rotation, two[i].rotation);
    EXPECT_EQ(one[i].translation, two[i].translation);
    EXPECT_EQ(one[i].delay, two[i].delay);
  }
}

TEST_F(CoarseAlignment, GivesNothingWithoutEdgesImagesOrPoses) {
  const auto is_empty = [](const std::vector<CalibrationView>& views, const PoseSpline& poses) {
    return coarse_corrections(views, true_camera(), poses).empty();
  };
  std::vector<CalibrationView> no_edges = drive_->views, no_images = drive_->views;
  for (CalibrationView& view : no_edges) view.edges_lidar.clear();
  for (CalibrationView& view : no_images) view.image = Image();
  EXPECT_TRUE(is_empty({}, drive_->T_local_lidar));
  EXPECT_TRUE(is_empty(no_edges, drive_->T_local_lidar));
  EXPECT_TRUE(is_empty(no_images, drive_->T_local_lidar));
  EXPECT_TRUE(is_empty(drive_->views, PoseSpline({})));
}

}  // namespace fovea::coarse_alignment_test
