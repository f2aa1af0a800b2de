#include "fovea/exporting/orthophoto/top_view.h"

#include <gtest/gtest.h>

#include <string>

namespace fovea::top_view_test {

constexpr Rgb kRed{200, 0, 0}, kBlue{0, 0, 100};

/// A picture by its opaque pixels: '#'. The rows have points where they have 'o'.
std::vector<std::string> filled(const std::vector<std::string>& points) {
  const int width = int(points[0].size()), height = int(points.size());
  TopView view(width, height);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      if (points[std::size_t(row)][std::size_t(column)] == 'o') view.add(column, row, 0, kRed);
    }
  }
  std::vector<std::string> picture;
  std::vector<std::uint8_t> rgba(4 * std::size_t(width));
  for (int row = 0; row < height; ++row) {
    view.render_row(row, rgba);
    picture.emplace_back();
    for (std::size_t i = 3; i < rgba.size(); i += 4) picture.back() += rgba[i] == 255 ? '#' : '.';
  }
  return picture;
}

std::vector<std::uint8_t> row_of(const TopView& view, int row, int width) {
  std::vector<std::uint8_t> rgba(4 * std::size_t(width));
  view.render_row(row, rgba);
  return rgba;
}

using Rows = std::vector<std::string>;

TEST(TopView, FillsGapsOfOneAndTwoPixels) {
  EXPECT_EQ(filled({"o.o"}), (Rows{"###"}));
  EXPECT_EQ(filled({"o..o"}), (Rows{"####"}));
  EXPECT_EQ(filled({"o...o"}), (Rows{"#...#"}));
  EXPECT_EQ(filled({"o", ".", ".", "o"}), (Rows{"#", "#", "#", "#"}));
  EXPECT_EQ(filled({"o..", "...", "..o"}), (Rows{"#..", ".#.", "..#"}));
}

TEST(TopView, GrowsNoBorder) {
  EXPECT_EQ(filled({".....", ".ooo.", ".ooo.", "....."}),
            (Rows{".....", ".###.", ".###.", "....."}));
}

// Filled pixels do not help to fill others: a hole of three pixels stays.
TEST(TopView, FillsNoWiderHole) {
  const Rows points{"ooooooo", "ooooooo", "oo...oo", "oo...oo", "oo...oo", "ooooooo", "ooooooo"};
  const Rows picture = filled(points);
  EXPECT_EQ(picture[3][3], '.');
}

TEST(TopView, AGapHasTheColorsAroundIt) {
  TopView view(4, 1);
  view.add(0, 0, 0, {90, 0, 0});
  view.add(3, 0, 0, {0, 0, 90});
  const std::vector<std::uint8_t> expected{90, 0, 0,  255, 60, 0, 30, 255,
                                           30, 0, 60, 255, 0,  0, 90, 255};
  EXPECT_EQ(row_of(view, 0, 4), expected);
}

TEST(TopView, ShowsTheHighestSurfaceInAnyOrder) {
  for (const bool low_first : {true, false}) {
    TopView view(1, 1);
    if (low_first) view.add(0, 0, 1, kBlue);
    view.add(0, 0, 5, kRed);
    if (!low_first) view.add(0, 0, 1, kBlue);
    EXPECT_EQ(row_of(view, 0, 1), (std::vector<std::uint8_t>{200, 0, 0, 255}));
  }
}

TEST(TopView, TheColorIsTheMeanOfTheSurface) {
  TopView view(1, 1);
  view.add(0, 0, -30.02, kRed);
  view.add(0, 0, -30.05, kBlue);
  view.add(0, 0, -30.3, {0, 255, 0});  // below the surface
  EXPECT_EQ(row_of(view, 0, 1), (std::vector<std::uint8_t>{100, 0, 50, 255}));
}

}  // namespace fovea::top_view_test
