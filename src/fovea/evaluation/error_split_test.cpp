#include "fovea/evaluation/error_split.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::error_split_test {

Camera small_camera() { return {0, 20, 10, 10, 10, 10, 5, RigidMotion::Identity()}; }

/// Red grows by 10 a column.
Image ramp() {
  Image image(20, 10, 3);
  for (int i = 0; i < 20 * 10; ++i) image.data[std::size_t(3 * i)] = std::uint8_t(10 * (i % 20));
  return image;
}

Eigen::Vector3d at_pixel(double x, double y, double depth) {
  return {(x - 10) / 10 * depth, (y - 5) / 10 * depth, depth};
}

TEST(ErrorSplit, PlaceAndColourApart) {
  EvaluatedView view;
  view.color = {{50, 0, 0}, {100, 0, 0}, {30, 0, 0}};  // pixels 5, 10 and 3
  // Three columns aside and 4 too red; the same place and 8 too dark; outside the image.
  const std::vector<Eigen::Vector3d> nearest = {at_pixel(8, 4, 2), at_pixel(10, 4, 3),
                                                at_pixel(-3, 4, 2)};
  const std::vector<Eigen::Vector3f> colors = {{84, 0, 0}, {92, 0, 0}, {0, 0, 0}};
  const ErrorSplit split = split_errors(view, nearest, colors, small_camera(), ramp());
  EXPECT_EQ(split.points, 2u);
  EXPECT_NEAR(split.mean(split.total), (34 + 8) / 2.0, 1e-4);
  EXPECT_NEAR(split.mean(split.sampling), (30 + 0) / 2.0, 1e-4);
  EXPECT_NEAR(split.mean(split.same_place), (4 + 8) / 2.0, 1e-4);
}

TEST(ErrorSplit, Adds) {
  ErrorSplit sum{1, 10, 5, 6};
  sum.append({3, 30, 15, 6});
  EXPECT_EQ(sum.points, 4u);
  EXPECT_EQ(sum.mean(sum.total), 10);
  EXPECT_EQ(sum.mean(sum.same_place), 3);
  EXPECT_TRUE(std::isnan(ErrorSplit().mean(0)));
}

}  // namespace fovea::error_split_test
