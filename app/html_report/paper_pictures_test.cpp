// The parts of the paper's pictures that can be wrong without looking so.
#include <gtest/gtest.h>

#include "app/html_report/close_ups.h"
#include "app/html_report/scan_pair.h"

namespace fovea::app::paper_pictures_test {

Rgb at(const Image& image, int x, int y) {
  const std::uint8_t* p = image.pixel(x, y);
  return {p[0], p[1], p[2]};
}

TEST(DrawPair, EachCloudItsColourAndWhiteWhereBothAre) {
  const Window window{{10, 5}, 0.1f, 40, 20};
  const Image image =
      draw_pair({{10, 5, 0}, {11, 5, 3}}, {{10, 5, 1}, {10, 5.9f, 0}, {30, 5, 0}}, window);
  ASSERT_EQ(image.width, 40);
  ASSERT_EQ(image.height, 20);
  const Rgb both = at(image, 20, 10), first = at(image, 30, 10), second = at(image, 20, 1);
  EXPECT_EQ(both, (Rgb{255, 255, 255}));
  EXPECT_GT(first.b, first.r) << "x to the right";
  EXPECT_GT(second.r, second.b) << "y upwards";
  EXPECT_EQ(at(image, 5, 15), at(image, 39, 0)) << "the rest is background";
}

SplatView flat(int width, int height, std::uint8_t value, float depth) {
  SplatView view{Image(width, height, 3), {}, {}};
  std::fill(view.image.data.begin(), view.image.data.end(), value);
  view.depth.assign(static_cast<std::size_t>(width) * height, depth);
  view.covered.assign(view.depth.size(), 1);
  return view;
}

TEST(NearDepthEdges, BothSidesOfAStepAndNothingElse) {
  SplatView view = flat(60, 20, 100, 10);
  for (int y = 0; y < 20; ++y) {
    for (int x = 30; x < 60; ++x) view.depth[static_cast<std::size_t>(y) * 60 + x] = 12;
  }
  const auto marks = near_depth_edges(view);
  EXPECT_EQ(marks[10 * 60 + 21], 0);
  EXPECT_EQ(marks[10 * 60 + 22], 1);
  EXPECT_EQ(marks[10 * 60 + 37], 1);
  EXPECT_EQ(marks[10 * 60 + 38], 0);
}

TEST(NearDepthEdges, ASlantIsNoEdgeNorIsAHole) {
  SplatView view = flat(60, 20, 100, 10);
  for (std::size_t i = 0; i < view.depth.size(); ++i) {
    view.depth[i] = 10 + 0.01f * static_cast<float>(i % 60);
  }
  view.covered[500] = 0;
  view.depth[500] = std::numeric_limits<float>::infinity();
  const auto marks = near_depth_edges(view);
  EXPECT_EQ(std::count(marks.begin(), marks.end(), 1), 0);
}

TEST(MostExtreme, FindsTheLargestSumOfEitherSign) {
  constexpr int kWidth = 50, kHeight = 40;
  std::vector<float> values(kWidth * kHeight, 0);
  const auto paint = [&](int left, int top, float value) {
    for (int y = top; y < top + 6; ++y) {
      for (int x = left; x < left + 6; ++x) values[y * kWidth + x] = value;
    }
  };
  EXPECT_FALSE(most_extreme(values, kWidth, 6, 6));
  paint(5, 5, 30);
  auto found = most_extreme(values, kWidth, 6, 6);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->x, 5);
  EXPECT_EQ(found->y, 5);
  EXPECT_DOUBLE_EQ(found->sum, 36 * 30);
  paint(30, 20, -60);
  found = most_extreme(values, kWidth, 6, 6);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->x, 30);
  EXPECT_EQ(found->y, 20);
  EXPECT_DOUBLE_EQ(found->sum, -36 * 60);
  EXPECT_FALSE(most_extreme(values, kWidth, 51, 6));
}

}  // namespace fovea::app::paper_pictures_test
