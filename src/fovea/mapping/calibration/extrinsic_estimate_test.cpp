#include "fovea/mapping/calibration/extrinsic_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/core/parallel.h"
#include "fovea/mapping/calibration/board_drive_test_support.h"

namespace fovea::extrinsic_estimate_test {

using namespace board_drive_test;

CameraCorrection planted() {
  return {.rotation = Eigen::Vector3d(3, 3, -3) * kDegree,
          .translation = {0.15, -0.1, 0.12},
          .delay = 0.08};
}

CalibrationEstimate estimate(const BoardDrive& drive, const CameraCorrection& error) {
  return estimate_extrinsics(drive.views, given_camera(error), drive.T_local_lidar);
}

BoardDrive short_drive(int views, const Route& route = {}) {
  BoardDriveOptions options;
  options.route = route;
  options.views = views;
  return board_drive(options);
}

/// Values that are not observable stay as given.
void expect_zero_unless_observable(const CalibrationEstimate& e) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!e.observable[k]) {
      EXPECT_EQ(e.correction.rotation[Eigen::Index(k)], 0) << k;
    }
    if (!e.observable[kCamTranslation + k]) {
      EXPECT_EQ(e.correction.translation[Eigen::Index(k)], 0) << k;
    }
  }
  if (!e.observable[kCamDelay]) {
    EXPECT_EQ(e.correction.delay, 0);
  }
}

void expect_nothing(const CalibrationEstimate& e) {
  EXPECT_FALSE(e.is_any_observable());
  EXPECT_EQ(e.correction.rotation, Eigen::Vector3d(Eigen::Vector3d::Zero()));
  EXPECT_EQ(e.correction.translation, Eigen::Vector3d(Eigen::Vector3d::Zero()));
  EXPECT_EQ(e.correction.delay, 0);
  EXPECT_FALSE(e.off_by_a_pixel());
}

/// Every value is observable, and as near to the truth as the drives allow.
void expect_found(const CalibrationEstimate& e, const CameraCorrection& truth) {
  EXPECT_FALSE(e.disagrees);
  for (const bool is_observable : e.observable) EXPECT_TRUE(is_observable);
  const Eigen::Vector3d turn = e.correction.rotation - truth.rotation,
                        shift = e.correction.translation - truth.translation;
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT(std::abs(turn[k]), std::min(0.1 * kDegree, 3 * e.sigma.rotation[k])) << k;
    EXPECT_LT(std::abs(shift[k]), std::min(0.02, 3 * e.sigma.translation[k])) << k;
  }
  EXPECT_LT(std::abs(e.correction.delay - truth.delay), std::min(0.003, 3 * e.sigma.delay));
}

class ExtrinsicEstimate : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    drive_ = new BoardDrive(board_drive());
    const ThreadLimit limit(1);
    planted_ = new CalibrationEstimate(estimate(*drive_, planted()));
  }
  static void TearDownTestSuite() {
    delete drive_;
    delete planted_;
  }

  static inline const BoardDrive* drive_ = nullptr;
  static inline const CalibrationEstimate* planted_ = nullptr;
};

TEST_F(ExtrinsicEstimate, FindsALargeError) {
  expect_found(*planted_, planted());
  EXPECT_EQ(planted_->frames, int(drive_->views.size()));
  EXPECT_GT(planted_->edges, 3000u);
  EXPECT_TRUE(planted_->off_by_a_pixel());
  EXPECT_GT(planted_->pixels, 20);
}

TEST_F(ExtrinsicEstimate, IsTheSameAtAnyNumberOfThreads) {
  const ThreadLimit limit(2);
  const CalibrationEstimate e = estimate(*drive_, planted());
  EXPECT_EQ(e.correction.rotation, planted_->correction.rotation);
  EXPECT_EQ(e.correction.translation, planted_->correction.translation);
  EXPECT_EQ(e.correction.delay, planted_->correction.delay);
  EXPECT_EQ(e.sigma.rotation, planted_->sigma.rotation);
  EXPECT_EQ(e.pixels, planted_->pixels);
}

TEST_F(ExtrinsicEstimate, LeavesARightCalibration) {
  const CalibrationEstimate e = estimate(*drive_, {});
  expect_found(e, {});
  EXPECT_LT(e.pixels, 0.5);
  EXPECT_FALSE(e.off_by_a_pixel());
}

TEST_F(ExtrinsicEstimate, AStandingLidarShowsNoDelay) {
  const CameraCorrection error{.rotation = Eigen::Vector3d(1, -2, 2) * kDegree, .delay = 0.05};
  const CalibrationEstimate e = estimate(short_drive(6, {.speed = 0, .unsteady = 0}), error);
  EXPECT_FALSE(e.disagrees);
  EXPECT_FALSE(e.delay_observable());
  EXPECT_TRUE(e.rotation_observable());
  EXPECT_LT((e.correction.rotation - error.rotation).norm(), 0.15 * kDegree);
  expect_zero_unless_observable(e);
}

// Along a straight line at one speed, a delay looks like a camera further back.
TEST_F(ExtrinsicEstimate, SteadyMotionConfusesDelayAndForwardTranslation) {
  const CameraCorrection error{.rotation = Eigen::Vector3d(1, -2, 2) * kDegree};
  const CalibrationEstimate e = estimate(short_drive(8, {.speed = 8, .unsteady = 0}), error);
  EXPECT_FALSE(e.disagrees);
  EXPECT_FALSE(e.observable[kCamDelay] && e.observable[kCamTranslation + 2]);
  EXPECT_TRUE(e.rotation_observable());
  EXPECT_LT((e.correction.rotation - error.rotation).norm(), 0.15 * kDegree);
  expect_zero_unless_observable(e);
}

TEST_F(ExtrinsicEstimate, ImagesOfAnotherPlaceDisagree) {
  BoardDrive drive = short_drive(5);
  BoardDriveOptions elsewhere;
  elsewhere.views = 5;
  for (Board& board : elsewhere.boards) {
    board.center.x() += 1.3;
    board.center.y() *= -0.8;
  }
  const BoardDrive other = board_drive(elsewhere);
  for (std::size_t i = 0; i < drive.views.size(); ++i) drive.views[i].image = other.views[i].image;
  const CalibrationEstimate e = estimate(drive, {});
  EXPECT_TRUE(e.disagrees);
  expect_nothing(e);
}

// No edge of such an image is clear, so none contradicts an estimate.
TEST_F(ExtrinsicEstimate, NoiseShowsNothing) {
  BoardDrive drive = short_drive(5);
  Random random(1);
  for (CalibrationView& view : drive.views) {
    for (std::uint8_t& gray : view.image.data) gray = static_cast<std::uint8_t>(random.below(256));
  }
  expect_nothing(estimate(drive, {}));
}

TEST_F(ExtrinsicEstimate, FewViewsOrEdgesShowNothing) {
  BoardDrive few_views = *drive_, few_edges = *drive_, no_poses = *drive_;
  few_views.views.resize(4);
  for (CalibrationView& view : few_edges.views) {
    for (LidarEdges& edges : view.edges_lidar) {
      for (PointCloud* cloud : {&edges.inside, &edges.outside}) cloud->position.resize(20);
      edges.between_rings.resize(20);
    }
  }
  no_poses.T_local_lidar = PoseSpline({});
  for (const BoardDrive& drive : {BoardDrive{}, few_views, few_edges, no_poses}) {
    const CalibrationEstimate e = estimate(drive, planted());
    expect_nothing(e);
    EXPECT_FALSE(e.disagrees);
    EXPECT_FALSE(e.is_any_observable());
  }
}

}  // namespace fovea::extrinsic_estimate_test
