#include "fovea/mapping/view_colors.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace fovea::view_colors_test {

Camera test_camera() { return {3, 621, 188, 360, 360, 310, 94, RigidMotion::Identity()}; }

Image gray(std::uint8_t value) {
  Image image(621, 188, 1);
  std::fill(image.data.begin(), image.data.end(), value);
  return image;
}

constexpr double kFootprint = 0.02;

PointCloud colored(const Image& image, const std::vector<Eigen::Vector3f>& positions,
                   const ViewLight& light = {}, const LogGain& submap_gain = LogGain::Zero()) {
  const ImagePyramid pyramid(image);
  PointCloud points;
  points.position = positions;
  color_new_points(points, ViewColors(pyramid, test_camera(), kFootprint).in_light(light),
                   test_camera(), /*depth=*/nullptr, /*frame=*/7, submap_gain);
  return points;
}

TEST(ViewColors, NewPointsHaveTheColorsOfTheViewThere) {
  Image ramp(621, 188, 3);
  for (int y = 0; y < ramp.height; ++y) {
    for (int x = 0; x < ramp.width; ++x) {
      ramp.pixel(x, y)[0] = static_cast<std::uint8_t>(x / 4 + 20);
      ramp.pixel(x, y)[1] = static_cast<std::uint8_t>(y + 20);
      ramp.pixel(x, y)[2] = 50;
    }
  }
  const PointCloud points = colored(ramp, {{0, 0, 6}, {1.5f, 0.5f, 4}, {-2, -0.3f, 10}});
  EXPECT_NO_THROW(points.check());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d pixel = *test_camera().project(points.position[i].cast<double>());
    const Eigen::Vector3f color = to_float(points.color[i]);
    EXPECT_NEAR(color.x(), (pixel.x() - 1.5) / 4 + 20, 1) << i;
    EXPECT_NEAR(color.y(), pixel.y() + 20, 1) << i;
    EXPECT_NEAR(color.z(), 50, 0.1);
    EXPECT_NEAR(points.weight[i], view_weight(points.position[i].norm()), 1);
  }
  EXPECT_EQ(points.views, std::vector<std::uint8_t>(3, 1));
  EXPECT_EQ(points.spread, std::vector<std::uint8_t>(3, 0));
  EXPECT_EQ(points.saturated, std::vector<std::uint8_t>(3, 0));
  EXPECT_EQ(points.frame, std::vector<std::int32_t>(3, 7));
  EXPECT_EQ(points.camera, std::vector<std::int8_t>(3, 3));
}

TEST(ViewColors, AGainIsTakenOut) {
  const Eigen::Vector3f color =
      to_float(colored(gray(120), {{0, 0, 6}}, {LogGain(-2, 0.5f, 1), {}}).color[0]);
  EXPECT_NEAR(color.x(), 480, 1);
  EXPECT_NEAR(color.y(), 120 / std::sqrt(2.0), 0.2);
  EXPECT_NEAR(color.z(), 60, 0.1);
}

TEST(ViewColors, TheResponseIsTakenOut) {
  const ViewLight light{LogGain::Constant(0.7f), {14, {-0.1, -0.2, 0.05}}};
  const std::vector<Eigen::Vector3f> positions{{0, 0, 6}, {4, 1, 6}, {-4.5f, -1, 6}};
  const PointCloud points = colored(gray(120), positions, light);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d pixel = *test_camera().project(positions[i].cast<double>());
    const float s = squared_distance_from_center(test_camera(), pixel);
    const Eigen::Array3f seen = image_color(to_float(points.color[i]).array(), light, s);
    EXPECT_LT((seen - 120).abs().maxCoeff(), 0.4) << i;  // a code is 0.3 %
  }
}

TEST(ViewColors, PointsAreStoredInTheExposureOfTheirSubmap) {
  const LogGain submap_gain(0.5f, 0, -1);
  const PointCloud points = colored(gray(100), {{0, 0, 6}}, {}, submap_gain);
  const Eigen::Array3f in_map = codes_of(points.color[0]) + float(kColorCodesPerStop) * submap_gain;
  EXPECT_LE((in_map - float(color_code(100))).abs().maxCoeff(), 0.5);
}

TEST(ViewColors, SaturatedAndNoisyValuesCountLittle) {
  const std::uint16_t full = view_weight(6);
  const auto weight_of = [&](std::uint8_t value) {
    return colored(gray(value), {{0, 0, 6}}).weight[0];
  };
  EXPECT_EQ(weight_of(128), full);
  EXPECT_LT(weight_of(244), full / 2);
  EXPECT_LE(weight_of(255), full / 50);
  EXPECT_LT(weight_of(4), full / 3);
  EXPECT_GE(weight_of(0), 1);
  EXPECT_EQ(colored(gray(255), {{0, 0, 6}}).saturated[0], 7);
  EXPECT_EQ(colored(gray(240), {{0, 0, 6}}).saturated[0], 0);
}

// The footprint of a near point covers many pixels: the mean of stripes. That of a far point is
// below one pixel.
TEST(ViewColors, AreMeansOverTheFootprint) {
  Image stripes(621, 188, 1);
  for (int y = 0; y < stripes.height; ++y) {
    for (int x = 0; x < stripes.width; ++x) stripes.pixel(x, y)[0] = x % 2 == 0 ? 20 : 200;
  }
  const PointCloud points = colored(stripes, {{0, 0, 3}, {0, 0, 8}});  // pixel 310 is dark
  EXPECT_EQ(to_rgb(points.color[0]), (Rgb{110, 110, 110}));
  EXPECT_EQ(to_rgb(points.color[1]), (Rgb{20, 20, 20}));
}

TEST(ViewColors, TheWeightFallsWithTheDistance) {
  EXPECT_EQ(view_weight(1), 1600);
  EXPECT_EQ(view_weight(4), 400);
  EXPECT_EQ(view_weight(16), 100);
  std::uint16_t last = view_weight(0);
  EXPECT_EQ(last, 1600);
  for (float distance = 0.1f; distance < 5000; distance *= 1.07f) {
    const std::uint16_t weight = view_weight(distance);
    ASSERT_LE(weight, last);
    ASSERT_GE(weight, 1);
    last = weight;
  }
  EXPECT_EQ(last, 1);
}

}  // namespace fovea::view_colors_test
