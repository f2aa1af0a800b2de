#include "app/html_report/calibration_overlay.h"

#include <gtest/gtest.h>

#include <limits>

namespace fovea::app::calibration_overlay_test {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr ImageWindow kWhole{0, 0, 40, 20};

Image gray_image(int channels) {
  Image image(40, 20, channels);
  std::fill(image.data.begin(), image.data.end(), std::uint8_t(100));
  return image;
}

Rgb at(const Image& image, int x, int y) {
  const std::uint8_t* pixel = image.pixel(x, y);
  return {pixel[0], pixel[1], pixel[2]};
}

TEST(PictureWithPoints, NearPointsAreRedFarPointsAreBlueEdgesAreWhite) {
  const Image picture = picture_with_points(
      gray_image(3), {{10, 5, 3, false}, {20, 5, 40, false}, {30, 5, 8, true}}, kWhole, 1);
  EXPECT_EQ(picture.width, 40);
  EXPECT_EQ(picture.height, 20);
  const Rgb near = at(picture, 10, 5), far = at(picture, 20, 5);
  EXPECT_GT(near.r, 200);
  EXPECT_LT(near.b, 100);
  EXPECT_GT(far.b, 200);
  EXPECT_LT(far.r, 100);
  EXPECT_EQ(at(picture, 30, 5), (Rgb{255, 255, 255}));
}

TEST(PictureWithPoints, EdgesAreLarger) {
  const auto pixels_of = [](bool is_edge) {
    const Image image(1280, 20, 1);
    const Image picture = picture_with_points(image, {{600, 10, 5, is_edge}}, {0, 0, 1280, 20}, 1);
    int pixels = 0;
    for (int x = 0; x < picture.width; ++x) {
      for (int y = 0; y < picture.height; ++y) pixels += at(picture, x, y) == Rgb{} ? 0 : 1;
    }
    return pixels;
  };
  EXPECT_EQ(pixels_of(false), 5);
  EXPECT_EQ(pixels_of(true), 13);
}

TEST(PictureWithPoints, AGrayImageGivesTheSamePicture) {
  const std::vector<OverlayPoint> points{{10, 5, 7, false}};
  EXPECT_EQ(picture_with_points(gray_image(1), points, kWhole, 1).data,
            picture_with_points(gray_image(3), points, kWhole, 1).data);
}

TEST(PictureWithPoints, PointsOutsideAreNotDrawn) {
  const Image image = gray_image(3);
  std::vector<OverlayPoint> points{{kNan, 5, 5, true}, {5, kNan, 5, true}, {5, 5, kNan, true}};
  for (const float far : {-1.0f, 1e30f, -1e30f, kInfinity}) {
    points.push_back({far, 5, 5, true});
    points.push_back({5, far, 5, false});
  }
  EXPECT_EQ(picture_with_points(image, points, kWhole, 1).data,
            picture_with_points(image, {}, kWhole, 1).data);
}

TEST(PictureWithPoints, NearPointsCoverFarOnesInAnyOrder) {
  const OverlayPoint near{9, 9, 4, false}, far{9, 9, 30, false}, edge{9, 9, 35, true};
  const Image image = gray_image(3);
  EXPECT_EQ(picture_with_points(image, {near, far}, kWhole, 1).data,
            picture_with_points(image, {near}, kWhole, 1).data);
  EXPECT_EQ(picture_with_points(image, {edge, far, near}, kWhole, 1).data,
            picture_with_points(image, {edge}, kWhole, 1).data);
}

TEST(PictureWithPoints, AWindowIsMagnified) {
  const Image picture = picture_with_points(gray_image(3), {{12, 6, 5, true}}, {10, 5, 10, 5}, 4);
  EXPECT_EQ(picture.width, 40);
  EXPECT_EQ(picture.height, 20);
  EXPECT_EQ(at(picture, 10, 6), (Rgb{255, 255, 255}));  // the center of pixel (2, 1) of the window
  EXPECT_NE(at(picture, 20, 6), (Rgb{255, 255, 255}));
}

TEST(WindowWithMostEdges, HoldsTheMostEdges) {
  const Image image = gray_image(3);
  const std::vector<OverlayPoint> points{{2, 2, 5, true},  {34, 15, 5, true}, {35, 16, 5, true},
                                         {3, 2, 5, false}, {4, 2, 5, false},  {5, 2, 5, false}};
  const ImageWindow window = window_with_most_edges(image, points, {0, 0, 10, 5});
  EXPECT_EQ(window.width, 10);
  EXPECT_LE(window.left, 34);
  EXPECT_GT(window.left + window.width, 35);
  EXPECT_LE(window.top, 15);
  EXPECT_GT(window.top + window.height, 16);
  EXPECT_EQ(window_with_most_edges(image, {{2, 2, 5, false}}, {0, 0, 10, 5}).width, 0);
}

TEST(OverlaySection, PassesOverImagesThatCannotBeDrawn) {
  CameraCalibration camera{2, {}};
  EXPECT_NE(overlay_section({camera}).find("no pictures"), std::string::npos);
  Image short_image(8, 8, 3);
  short_image.data.pop_back();
  camera.overlays = {{1, {}, {}, {}}, {2, short_image, {}, {}}, {3, Image(8, 8, 2), {}, {}}};
  EXPECT_NE(overlay_section({camera}).find("no pictures"), std::string::npos);
  camera.overlays.push_back({4, Image(1, 1, 1), {{0, 0, 5, true}}, {}});
  EXPECT_NE(overlay_section({camera}).find("Frame 4, camera 2"), std::string::npos);
}

}  // namespace fovea::app::calibration_overlay_test
