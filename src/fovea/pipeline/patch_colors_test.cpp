#include "fovea/pipeline/patch_colors.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fovea/pipeline/visible_map_test_support.h"

namespace fovea::patch_colors_test {

using namespace visible_map_test;

TEST(NewColors, AreThoseOfTheViewAtThePoints) {
  Image ramp(621, 188, 3);
  for (int y = 0; y < ramp.height; ++y) {
    for (int x = 0; x < ramp.width; ++x) {
      ramp.pixel(x, y)[0] = static_cast<std::uint8_t>(x / 4);
      ramp.pixel(x, y)[1] = static_cast<std::uint8_t>(y);
      ramp.pixel(x, y)[2] = 50;
    }
  }
  const TestView view(ramp);
  PointCloud points;
  points.position = {{0, 0, 6}, {1.5f, 0.5f, 4}, {-2, -0.3f, 10}};
  color_new_points(points, view.view);
  EXPECT_NO_THROW(points.check());
  const Camera camera = test_camera();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d pixel = *camera.project(points.position[i].cast<double>());
    EXPECT_NEAR(to_rgb(points.color[i]).r, (pixel.x() - 1.5) / 4, 1) << i;
    EXPECT_NEAR(to_rgb(points.color[i]).g, pixel.y(), 1) << i;
    EXPECT_EQ(to_rgb(points.color[i]).b, 50);
    EXPECT_EQ(points.weight[i], view_weight(points.position[i].norm()));
  }
  EXPECT_EQ(points.views, std::vector<std::uint8_t>(3, 1));
  EXPECT_EQ(points.spread, std::vector<std::uint8_t>(3, 0));
  EXPECT_EQ(points.frame, std::vector<std::int32_t>(3, 7));
  EXPECT_EQ(points.camera, std::vector<std::int8_t>(3, 3));
}

TEST(NewColors, AreMarkedIfTheirExposureWasMatched) {
  Image gray(621, 188, 3);
  std::fill(gray.data.begin(), gray.data.end(), 80);
  TestView view(gray);
  PointCloud points;
  points.position = {{0, 0, 6}, {1.5f, 0.5f, 4}};
  points.reason = {reason_of(PointRule::kMeasured), reason_of(PointRule::kPlanar)};
  color_new_points(points, view.view);
  EXPECT_EQ(points.reason, (std::vector<std::uint8_t>{0, 2}));
  view.view.gain = Eigen::Array3f(1.5f, 1.5f, 1.5f);
  color_new_points(points, view.view);
  EXPECT_EQ(points.reason, (std::vector<std::uint8_t>{0x10, 0x12}));
  EXPECT_EQ(points.color[0], (Rgb{120, 120, 120}));
}

// The footprint of a near point covers many pixels: the mean of stripes. That of a far point is
// below one pixel.
TEST(NewColors, AreMeansOverTheFootprint) {
  Image stripes(621, 188, 1);
  for (int y = 0; y < stripes.height; ++y) {
    for (int x = 0; x < stripes.width; ++x) stripes.pixel(x, y)[0] = x % 2 == 0 ? 0 : 200;
  }
  const TestView view(stripes);
  PointCloud points;
  points.position = {{0, 0, 3}, {0, 0, 8}};  // pixel 310 is black
  color_new_points(points, view.view);
  EXPECT_EQ(points.color[0], (Rgb{100, 100, 100}));
  EXPECT_EQ(points.color[1], (Rgb{0, 0, 0}));
}

}  // namespace fovea::patch_colors_test
