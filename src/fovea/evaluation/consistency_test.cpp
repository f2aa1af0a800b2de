#include "fovea/evaluation/consistency.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/evaluation/test_scene.h"

namespace fovea::consistency_test {

Image even(int width, int height, std::uint8_t value, int channels = 3) {
  Image image(width, height, channels);
  std::fill(image.data.begin(), image.data.end(), value);
  return image;
}

SplatView drawn(Image image) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  return {std::move(image), std::vector<float>(pixels, 8), std::vector<std::uint8_t>(pixels, 1)};
}

TEST(Roughness, IsWhatThePhotographHasNot) {
  Image rough = even(32, 16, 100);
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 32; ++x) {
      std::fill_n(rough.pixel(x, y), 3, std::uint8_t((x + y) % 2 == 0 ? 90 : 110));
    }
  }
  const RoughnessSums sums = compare_roughness(drawn(rough), even(32, 16, 50));
  EXPECT_EQ(sums.patches, 8u);
  EXPECT_NEAR(sums.roughness(), 10, 1e-3);
  EXPECT_NEAR(compare_roughness(drawn(even(32, 16, 9)), even(32, 16, 50)).roughness(), 0, 1e-2);
  EXPECT_EQ(compare_roughness(drawn(even(32, 16, 9)), rough).patches, 0u);  // not smooth there
  SplatView holed = drawn(rough);
  holed.covered[0] = 0;
  EXPECT_EQ(compare_roughness(holed, even(32, 16, 50, 1)).patches, 7u);
}

TEST(CrossView, StatesTheErrorOfTheMapAndTheFloor) {
  // Photographs 100 and 120 of a map of 105.
  PointCloud points = WallScene::map(0.1);
  for (LogColor& color : points.color) color = {105, 105, 105};
  const ColoredPoints map = colored_points(points);
  const Camera camera = forward_camera();
  const SplatView view = drawn(even(camera.width, camera.height, 105));
  const Eigen::Vector3f one = Eigen::Vector3f::Ones();
  CrossViewTest test(map);
  test.add_view(view, camera, camera.T_cam_lidar, even(camera.width, camera.height, 100), one);
  EXPECT_EQ(test.result().points, 0u);
  EXPECT_TRUE(std::isnan(test.result().map));
  test.add_view(view, camera, camera.T_cam_lidar, even(camera.width, camera.height, 120), one);
  EXPECT_GT(test.result().points, 500u);
  const double a = std::log(100.0 / 105), b = std::log(120.0 / 105);
  EXPECT_NEAR(test.result().map, std::sqrt((a * a + b * b) / 2), 0.003);  // a code is 0.27 %
  EXPECT_NEAR(test.result().floor, (b - a) / 2, 0.003);
  // Two photographs in one exposure after their gains; a saturated one does not count.
  CrossViewTest exposed(map);
  for (const float gain : {0.5f, 2.0f, 2.5f}) {
    const float value = std::min(105 * gain, 255.0f);
    exposed.add_view(view, camera, camera.T_cam_lidar,
                     even(camera.width, camera.height, static_cast<std::uint8_t>(value)),
                     gain * one);
  }
  EXPECT_LT(exposed.result().map, 0.01);

  SplatView before = view;  // something stands before the wall
  std::fill(before.depth.begin(), before.depth.end(), 7.5f);
  CrossViewTest hidden(map);
  for (int i = 0; i < 2; ++i) {
    hidden.add_view(before, camera, camera.T_cam_lidar, even(camera.width, camera.height, 100),
                    one);
  }
  EXPECT_EQ(hidden.result().points, 0u);
}

}  // namespace fovea::consistency_test
