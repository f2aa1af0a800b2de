#include "fovea/texture.h"

#include <gmock/gmock.h>

#include <stdexcept>

namespace fovea::texture_test {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(Texture, ColorIsTheImageAtTheProjection) {
  Camera camera;
  camera.index = 3;
  camera.width = 100;
  camera.height = 50;
  camera.fx = camera.fy = 80;
  camera.cx = 49.5;
  camera.cy = 24.5;
  Image image(100, 50, 3);
  for (int y = 0; y < 50; ++y) {
    for (int x = 0; x < 100; ++x) {
      image.pixel(x, y)[0] = std::uint8_t(2 * x);
      image.pixel(x, y)[1] = std::uint8_t(4 * y);
      image.pixel(x, y)[2] = 7;
    }
  }
  PointCloud cloud;
  cloud.position = {{0, 0, 8}, {1, 0.5f, 8}, {0, 0, -8}, {100, 0, 8}};
  color_points(cloud, {image, camera, 17});
  EXPECT_EQ(cloud.color[0], (Rgb{99, 98, 7}));    // 2 * 49.5, 4 * 24.5
  EXPECT_EQ(cloud.color[1], (Rgb{119, 118, 7}));  // u = 59.5, v = 29.5
  EXPECT_EQ(cloud.camera, (std::vector<std::int8_t>{3, 3, kNoCamera, kNoCamera}));
  EXPECT_EQ(cloud.frame, (std::vector<std::int32_t>{17, 17, 17, 17}));
}

TEST(Texture, NearestSamplingUsesTheNearestPixelCenter) {
  Camera camera;
  camera.width = 4;
  camera.height = 1;
  camera.fx = camera.fy = 1;
  Image image(4, 1, 1);
  image.data = {0, 100, 200, 255};
  PointCloud cloud;
  cloud.position = {{1.4f, 0, 1}, {1.6f, 0, 1}};
  color_points(cloud, {image, camera, 0}, ImageSampling::kNearest);
  EXPECT_EQ(to_rgb(cloud.color[0]).r, 100);
  EXPECT_EQ(to_rgb(cloud.color[1]).r, 200);
  color_points(cloud, {image, camera, 0});
  EXPECT_EQ(to_rgb(cloud.color[0]).r, 140);
}

TEST(Texture, AnEmptyImageColorsNothing) {
  Camera camera;
  camera.width = camera.height = 10;
  camera.fx = camera.fy = 10;
  PointCloud cloud;
  cloud.position = {{1, 1, 4}};
  const Image none;
  color_points(cloud, {none, camera, 5});
  EXPECT_EQ(cloud.camera[0], kNoCamera);
  EXPECT_EQ(cloud.views[0], 0);
  EXPECT_EQ(cloud.frame[0], 5);
}

TEST(Texture, GrayImagesGiveThreeEqualChannels) {
  Camera camera;
  camera.width = camera.height = 10;
  camera.fx = camera.fy = 10;
  Image image(10, 10, 1);
  image.data.assign(image.data.size(), 90);
  PointCloud cloud;
  cloud.position = {{1, 1, 4}};
  color_points(cloud, {image, camera, 0});
  EXPECT_EQ(cloud.color[0], (Rgb{90, 90, 90}));
}

TEST(Texture, WrongArgumentsAreNamed) {
  Camera camera;
  camera.width = 4;
  camera.height = 2;
  camera.fx = camera.fy = 1;
  const Image image(4, 2, 3);
  PointCloud cloud;
  cloud.position = {{0, 0, 1}};
  const auto coloring = [&](const Image& pixels, const Camera& seeing,
                            const ImageMask* mask = nullptr) {
    return [&cloud, &pixels, seeing, mask] { color_points(cloud, {pixels, seeing, 0, mask}); };
  };
  const auto names = [](const char* text) {
    return ThrowsMessage<std::invalid_argument>(HasSubstr(text));
  };
  const Image wide(5, 2, 3);
  EXPECT_THAT(coloring(wide, camera), names("the image has 5 x 2 pixels, the camera 4 x 2"));
  const ImageMask mask(wide);
  EXPECT_THAT(coloring(image, camera, &mask), names("the mask has 5 x 2 pixels"));
  Image cut = image;
  cut.data.pop_back();
  EXPECT_THAT(coloring(cut, camera), names("the image has 23 bytes"));
  Image two = image;
  two.channels = 2;
  EXPECT_THAT(coloring(two, camera), names("not 1 or 3 channels"));

  Camera wrong = camera;
  wrong.fx = 0;
  EXPECT_THAT(coloring(image, wrong), names("no focal length"));
  for (const int number : {-1, 128}) {
    wrong = camera;
    wrong.index = number;
    EXPECT_THAT(coloring(image, wrong), names("beyond 0 to 127"));
  }
  color_points(cloud, {Image(), wrong});  // without an image there may be no camera
  EXPECT_EQ(cloud.camera[0], kNoCamera);
  cloud.origin.x() = 1;
  EXPECT_THAT(coloring(image, camera), names("origin"));
}

}  // namespace fovea::texture_test
