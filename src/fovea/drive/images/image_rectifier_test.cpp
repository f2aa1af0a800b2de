#include "fovea/drive/images/image_rectifier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "fovea/geometry/rectified_camera.h"

namespace fovea::image_rectifier_test {

LensCamera barrel() {
  return {320,
          240,
          200,
          205,
          161.5,
          118.25,
          Lens(LensModel::kPlumbBob, {-0.28, 0.07, 0.0005, -0.0004, -0.005})};
}
LensCamera fisheye() {
  return {320, 240, 150, 150, 161.5, 118.25, Lens(LensModel::kEquidistant, {-0.012, 0.004, 0, 0})};
}

/// Brightness of a direction: smooth, so that what interpolation loses is small.
double shade(const Eigen::Vector3d& ray) {
  const Eigen::Vector2d p = ray.head<2>() / ray.z();
  return 128 + 60 * std::sin(9 * p.x()) + 50 * std::cos(11 * p.y() + 2 * p.x());
}

/// What the camera sees of a world in which each direction has its shade.
Image picture(const LensCamera& camera, int channels) {
  Image image(camera.width, camera.height, channels);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      for (int c = 0; c < channels; ++c) {
        const double value = shade(*camera.ray({u, v})) + 5 * c;
        image.pixel(u, v)[c] = static_cast<std::uint8_t>(std::lround(value));
      }
    }
  }
  return image;
}

TEST(ImageRectifier, ShowsWhatAPinholeCameraWouldHaveSeen) {
  for (const LensCamera& camera : {barrel(), fisheye()}) {
    const Camera pinhole = *rectified_camera(camera, 1.7, 8192);
    const auto rectifier = ImageRectifier::make(camera, pinhole);
    ASSERT_TRUE(rectifier);
    for (const int channels : {1, 3}) {
      const Image image = rectifier->rectify(picture(camera, channels));
      ASSERT_EQ(image.width, pinhole.width);
      ASSERT_EQ(image.height, pinhole.height);
      ASSERT_EQ(image.channels, channels);
      double worst = 0, sum = 0;
      for (int v = 0; v < image.height; ++v) {
        for (int u = 0; u < image.width; ++u) {
          const Eigen::Vector3d ray((u - pinhole.cx) / pinhole.fx, (v - pinhole.cy) / pinhole.fy,
                                    1);
          for (int c = 0; c < channels; ++c) {
            const double error = std::abs(image.pixel(u, v)[c] - shade(ray) - 5 * c);
            worst = std::max(worst, error);
            sum += error;
          }
        }
      }
      EXPECT_LT(sum / double(image.data.size()), 0.35);  // rounding twice: 0.3
      EXPECT_LT(worst, 2.5);
    }
  }
}

/// Where a row turns from dark to bright, by interpolation.
double edge_in_row(const Image& image, int v) {
  for (int u = 1; u < image.width; ++u) {
    const double before = image.pixel(u - 1, v)[0], here = image.pixel(u, v)[0];
    if (before < 128 && here >= 128) return u - 1 + (128 - before) / (here - before);
  }
  return -1;
}

TEST(ImageRectifier, StraightLinesAreStraight) {
  for (const LensCamera& camera : {barrel(), fisheye()}) {
    // A slanting edge, softened over some pixels, at the left where the lens bends most.
    Image bent(camera.width, camera.height, 1);
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector3d ray = *camera.ray({u, v});
        const double beside = ray.x() / ray.z() + 0.55 + 0.1 * ray.y() / ray.z();
        bent.pixel(u, v)[0] = static_cast<std::uint8_t>(
            std::lround(127.5 + 100 * std::tanh(0.5 * camera.fx * beside)));
      }
    }
    const auto bow = [](const Image& image) {  // of the edge from its chord, pixels
      const double top = edge_in_row(image, 0), bottom = edge_in_row(image, image.height - 1);
      double most = 0;
      for (int v = 0; v < image.height; ++v) {
        const double chord = top + (bottom - top) * v / (image.height - 1);
        most = std::max(most, std::abs(edge_in_row(image, v) - chord));
      }
      return most;
    };
    const Camera pinhole = *rectified_camera(camera, 1.7, 8192);
    EXPECT_GT(bow(bent), 3);
    EXPECT_LT(bow(ImageRectifier::make(camera, pinhole)->rectify(bent)), 0.15);
  }
}

TEST(ImageRectifier, RefusesAPinholeThatSeesMoreAndImagesOfAnotherSize) {
  const LensCamera camera = barrel();
  Camera pinhole = *rectified_camera(camera, 1.7, 8192);
  EXPECT_THROW(ImageRectifier::make(camera, pinhole)->rectify(Image(320, 241, 3)),
               std::invalid_argument);
  pinhole.width += 60;
  EXPECT_FALSE(ImageRectifier::make(camera, pinhole));
}

}  // namespace fovea::image_rectifier_test
