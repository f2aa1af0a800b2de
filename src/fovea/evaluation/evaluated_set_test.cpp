#include "fovea/evaluation/evaluated_set.h"

#include <gtest/gtest.h>

#include "fovea/evaluation/test_scene.h"

namespace fovea::evaluated_set_test {

class EvaluatedSetTest : public testing::Test {
 protected:
  /// Evaluates points of the LiDAR frame; `measured` where they differ before compensation.
  EvaluatedView evaluate(const std::vector<Eigen::Vector3f>& compensated,
                         const std::vector<Eigen::Vector3f>& measured = {}) const {
    PointCloud scan, raw;
    scan.position = compensated;
    raw.position = measured.empty() ? compensated : measured;
    return evaluated_view(raw, scan, placed_, camera_, image_, origin_);
  }

  Camera camera_ = forward_camera();
  PlacedFrame placed_;
  Image image_{200, 100, 3};
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
};

TEST_F(EvaluatedSetTest, TakesRangesBetween3And15Metres) {
  EXPECT_EQ(evaluate({{2.99f, 0, 0}, {3, 0, 0}, {3.01f, 0, 0}, {14.99f, 0, 0}, {15, 0, 0}})
                .position.size(),
            2u);
}

TEST_F(EvaluatedSetTest, GatesTheRangeAsMeasuredNotAsCompensated) {
  const EvaluatedView view =
      evaluate({{15.5f, 0, 0}, {14.5f, 0, 0}}, {{14.9f, 0, 0}, {15.1f, 0, 0}});
  ASSERT_EQ(view.position.size(), 1u);
  EXPECT_EQ(view.position[0], Eigen::Vector3f(15.5f, 0, 0));
}

TEST_F(EvaluatedSetTest, NeverTakesPointsBehindOrBesideTheCamera) {
  EXPECT_TRUE(evaluate({{-5, 0, 0}, {0, 5, 0}, {0.4f, 0, -4}}).position.empty());
}

TEST_F(EvaluatedSetTest, NeedsHalfAMetreBeforeTheCamera) {
  camera_.T_cam_lidar = RigidMotion(Eigen::Translation3d(0, 0, -5)) * camera_.T_cam_lidar;
  EXPECT_EQ(evaluate({{5.49f, 0, 0}, {5.5f, 0, 0}, {5.51f, 0, 0}}).position.size(), 1u);
}

TEST_F(EvaluatedSetTest, ImageIsHalfOpenAtItsLastPixels) {
  const auto at_pixel = [&](double u, double v) {
    return Eigen::Vector3f(6, float(-(u - camera_.cx) / camera_.fx * 6),
                           float(-(v - camera_.cy) / camera_.fy * 6));
  };
  EXPECT_EQ(evaluate({at_pixel(0.01, 0.01), at_pixel(198.99, 98.99)}).position.size(), 2u);
  EXPECT_TRUE(evaluate({at_pixel(-0.01, 50), at_pixel(199.01, 50), at_pixel(50, -0.01),
                        at_pixel(50, 99.01)})
                  .position.empty());
  EXPECT_FALSE(scored_pixel(camera_, Eigen::Vector3d((199 - camera_.cx) / camera_.fx, 0, 1)));
}

TEST_F(EvaluatedSetTest, ColorIsBilinearAtTheProjection) {
  image_.pixel(100, 50)[0] = 100;
  image_.pixel(101, 50)[1] = 200;
  // Pixel (100.25, 50).
  const EvaluatedView view = evaluate({{5, -0.75f / 150 * 5, -0.5f / 150 * 5}});
  ASSERT_EQ(view.color.size(), 1u);
  EXPECT_TRUE(view.color[0].isApprox(Eigen::Vector3f(75, 50, 0), 1e-3f));
  EXPECT_FALSE(view.grey);
}

TEST_F(EvaluatedSetTest, PointsArePlacedByThePoseRelativeToTheOrigin) {
  placed_.T_local_lidar = Eigen::Translation3d(1000, 0, 0) *
                          Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ());
  origin_ = {1000, 0, -2};
  const EvaluatedView view = evaluate({{5, 0, 0}});
  ASSERT_EQ(view.position.size(), 1u);
  EXPECT_TRUE(view.position[0].isApprox(Eigen::Vector3f(0, 5, 2), 1e-6f));
}

TEST_F(EvaluatedSetTest, GreyImagesAreMarked) {
  image_ = Image(200, 100, 1);
  image_.data.assign(image_.data.size(), 77);
  const EvaluatedView view = evaluate({{5, 0, 0}});
  EXPECT_TRUE(view.grey);
  EXPECT_EQ(view.color.at(0), Eigen::Vector3f(77, 77, 77));
}

TEST_F(EvaluatedSetTest, SizesMustFit) {
  EXPECT_THROW(evaluate({{5, 0, 0}}, {{5, 0, 0}, {6, 0, 0}}), std::invalid_argument);
  image_ = Image(10, 10, 3);
  EXPECT_THROW(evaluate({{5, 0, 0}}), std::invalid_argument);
}

TEST(CompensatedScan, MovesPointsUnlessTheDriveHasDoneSo) {
  PointCloud scan;
  scan.position = {{0, 5, 0}};  // a quarter turn to the left: a quarter period before the stamp
  PlacedFrame placed;
  DriveInfo drive;
  EXPECT_EQ(compensated_scan(scan, placed, drive).position[0], scan.position[0]);
  placed.motion = SweepMotion();
  placed.motion->velocity(3) = 10;  // forwards: the vehicle was 0.25 m further back
  EXPECT_TRUE(compensated_scan(scan, placed, drive)
                  .position[0]
                  .isApprox(Eigen::Vector3f(-0.25f, 5, 0), 1e-4f));
  drive.sweep_compensated = true;
  EXPECT_EQ(compensated_scan(scan, placed, drive).position[0], scan.position[0]);
}

}  // namespace fovea::evaluated_set_test
