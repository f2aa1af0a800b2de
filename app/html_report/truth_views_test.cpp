#include "app/html_report/truth_views.h"

#include <gtest/gtest.h>

#include "fovea/rendering/splat.h"

namespace fovea::app::truth_views_test {

Camera test_camera() {
  Camera camera;
  camera.index = 2;
  camera.width = 61;
  camera.height = 31;
  camera.fx = camera.fy = 30;
  camera.cx = 30;
  camera.cy = 15;
  return camera;
}

/// In the camera's frame.
ColoredPoints points_at(const std::vector<Eigen::Vector3f>& positions) {
  ColoredPoints points;
  points.position = positions;
  points.color.assign(positions.size(), Rgb{100, 100, 100});
  points.runs = make_runs(positions, 16);
  return points;
}

PointsInView view_of(const ColoredPoints& points) {
  const RigidMotion here = RigidMotion::Identity();
  const std::vector<float> spacing(points.position.size(), 0.02f);
  const SplatView drawn = splat(points, spacing, test_camera(), here, {.min_depth = 0.5});
  return points_in_view(points, drawn, test_camera(), here);
}

TEST(PointsInView, HasWhatTheMapShowsOneACell) {
  // In front; the same pixel behind it; beside the view; behind the camera; another cell.
  const PointsInView view =
      view_of(points_at({{0, 0, 4}, {0, 0, 6}, {9, 0, 4}, {0, 0, -4}, {1, 0, 4}}));
  ASSERT_EQ(view.index, (std::vector<std::uint32_t>{0, 4}));
  EXPECT_EQ(view.pixels[0], Eigen::Vector2d(30, 15));
  EXPECT_EQ(view.depth[0], 4);
  // Two in one cell (of pixels 30 to 35): the one next to its middle.
  EXPECT_EQ(view_of(points_at({{0, 0, 4}, {0.3f, 0, 4}})).index, (std::vector<std::uint32_t>{1}));
}

TEST(PerfectColorErrors, AreLeftAfterTheGainOfPointsOnSurfaces) {
  ColoredPoints points = points_at({{-1, 0, 4}, {0, 0, 4}, {1, 0, 4}});
  points.color = {Rgb{50, 50, 50}, Rgb{100, 100, 100}, Rgb{10, 10, 10}};
  const PointsInView view = view_of(points);
  ASSERT_EQ(view.index.size(), 3u);
  Image perfect(61, 31, 3);
  std::fill(perfect.data.begin(), perfect.data.end(), std::uint8_t{100});
  for (int y = 0; y < 31; ++y) {  // twice as bright as the map, but where the third point is
    for (int x = 25; x < 61; ++x) {
      for (int c = 0; c < 3; ++c) perfect.pixel(x, y)[c] = 200;
    }
  }
  const auto errors = perfect_color_errors(points, view, {0.001f, 0.002f, 1}, perfect);
  EXPECT_NEAR(errors[0], 0, 1e-3);
  EXPECT_NEAR(errors[1], 0, 1e-3);
  EXPECT_NEAR(errors[2], 180 * std::sqrt(3.0), 1e-3);  // a ghost does not set the exposure
}

}  // namespace fovea::app::truth_views_test
