#include "fovea/mapping/calibration/color_consistency.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "fovea/core/parallel.h"
#include "fovea/mapping/calibration/board_drive_test_support.h"

namespace fovea::color_consistency_test {

using namespace board_drive_test;

constexpr double kBlur = 2;

/// A drive to a textured wall. Only points of the wall are compared, since the ground is seen at
/// grazing angles: its smoothed images differ by the distance.
class ColorConsistencyTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    BoardDriveOptions options;
    options.boards = {Board{.center = {18, 0, 0}, .half_width = 14, .half_height = 6, .gray = 120}};
    options.views = 12;
    drive_ = new BoardDrive(board_drive(options));
    for (CalibrationView& view : drive_->views) {
      std::erase_if(view.surface_lidar, [](const Eigen::Vector3f& p) { return p.z() < -1; });
    }
  }
  static void TearDownTestSuite() { delete drive_; }

  static ColorConsistency colors(const CameraCorrection& error, double blur = kBlur) {
    return colors_of(drive_->views, error, blur);
  }
  static ColorConsistency colors_of(const std::vector<CalibrationView>& views,
                                    const CameraCorrection& error = {}, double blur = kBlur) {
    return color_consistency(views, given_camera(error), drive_->T_local_lidar, blur);
  }
  static void expect_no_term(const ColorConsistency& colors) {
    EXPECT_EQ(colors.comparisons, 0u);
    EXPECT_EQ(colors.difference, 0);
    EXPECT_EQ(
        colors.term.gradient.norm() + colors.term.curvature.norm() + colors.term.scatter.norm(), 0);
  }

  static inline BoardDrive* drive_ = nullptr;
};

/// The maximum of a term, in calibration_unit()s.
CalibrationVector maximum_of(const QuadraticTerm& term) {
  return term.curvature.completeOrthogonalDecomposition().solve(term.gradient);
}

TEST_F(ColorConsistencyTest, AtTheTruthTheGradientIsZero) {
  for (const double blur : {1.5, 2.0, 4.0}) {
    const ColorConsistency truth = colors({}, blur);
    EXPECT_GT(truth.comparisons, 3000u);
    for (int k = 0; k < kCalibrationSize; ++k) {
      EXPECT_LT(std::abs(truth.term.gradient[k]), 3 * std::sqrt(truth.term.scatter(k, k))) << k;
    }
    EXPECT_LT(maximum_of(truth.term).head<3>().cwiseAbs().maxCoeff(), 0.25 * blur) << blur;
  }
}

TEST_F(ColorConsistencyTest, ColorsDifferLeastAtTheTruth) {
  const double truth = colors({}).difference;
  EXPECT_LT(truth, 0.004);
  for (const double units : {-1.5, 1.5}) {
    CameraCorrection roll;
    roll.rotation.z() = units * calibration_unit()[2];
    EXPECT_GT(colors(roll).difference, 1.15 * truth);
  }
}

TEST_F(ColorConsistencyTest, PointsToTheTruth) {
  for (const int axis : {0, 1, 2}) {  // pitch, yaw, roll
    for (const double units : {-0.7, 0.7}) {
      CameraCorrection error;
      error.rotation[axis] = units * calibration_unit()[axis];
      const QuadraticTerm term = colors(error).term;
      EXPECT_GT(term.gradient[axis] * (units > 0 ? 1 : -1), 2 * std::sqrt(term.scatter(axis, axis)))
          << axis;
      EXPECT_NEAR(term.gradient[axis] / term.curvature(axis, axis), units, 0.25) << axis;
      EXPECT_NEAR(maximum_of(term)[axis], units, 0.25) << axis;
    }
  }
}

TEST_F(ColorConsistencyTest, TheTermIsConcaveAndSymmetric) {
  CameraCorrection error;
  error.rotation = {1e-3, -2e-3, 5e-3};
  const QuadraticTerm term = colors(error).term;
  const Eigen::SelfAdjointEigenSolver<CalibrationMatrix> eigen(term.curvature);
  EXPECT_LT((term.curvature - term.curvature.transpose()).norm(), 1e-9 * term.curvature.norm());
  EXPECT_GT(eigen.eigenvalues()[0], -1e-9 * eigen.eigenvalues()[8]);
  // The shifts are no part of it.
  EXPECT_LT(term.curvature.rightCols<2>().norm() + term.gradient.tail<2>().norm(), 1e-9);
}

TEST_F(ColorConsistencyTest, TheExposureOfAnImageDoesNotMatter) {
  std::vector<CalibrationView> views = drive_->views;
  for (std::uint8_t& gray : views[4].image.data) gray = static_cast<std::uint8_t>(0.6 * gray);
  CameraCorrection error;
  error.rotation.y() = 0.7 * calibration_unit()[1];
  const ColorConsistency same = colors(error), dark = colors_of(views, error);
  EXPECT_EQ(dark.comparisons, same.comparisons);
  EXPECT_NEAR(dark.difference, same.difference, 0.3 * same.difference);
  EXPECT_NEAR(maximum_of(dark.term)[1], 0.7, 0.25);
}

TEST_F(ColorConsistencyTest, IsTheSameAtAnyNumberOfThreads) {
  QuadraticTerm one, two;
  {
    const ThreadLimit limit(1);
    one = colors({}).term;
  }
  {
    const ThreadLimit limit(2);
    two = colors({}).term;
  }
  EXPECT_EQ(one.gradient, two.gradient);
  EXPECT_EQ(one.curvature, two.curvature);
  EXPECT_EQ(one.scatter, two.scatter);
}

TEST_F(ColorConsistencyTest, WithoutOverlapThereIsNoTerm) {
  const std::vector<CalibrationView>& views = drive_->views;
  expect_no_term(colors_of({}));
  expect_no_term(colors_of({views[0]}));
  expect_no_term(colors_of({views[0], views[0], views[0]}));  // one place
  expect_no_term(colors_of({views[0], views[11]}));           // 9 m apart
  std::vector<CalibrationView> no_images = views, no_points = views;
  for (CalibrationView& view : no_images) view.image = Image();
  for (CalibrationView& view : no_points) view.surface_lidar.clear();
  expect_no_term(colors_of(no_images));
  expect_no_term(colors_of(no_points));
  expect_no_term(color_consistency(views, true_camera(), PoseSpline({}), kBlur));
  EXPECT_GT(colors_of({views[0], views[2]}).comparisons, 100u);
}

}  // namespace fovea::color_consistency_test
