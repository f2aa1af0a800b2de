#include "fovea/texture.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>
#include <string_view>

#include "fovea/core/parallel.h"

namespace fovea {
namespace {
constexpr std::size_t kGrain = 8192;

Rgb sample(const Image& image, const Eigen::Vector2d& pixel, ImageSampling sampling) {
  const bool nearest = sampling == ImageSampling::kNearest;
  const Eigen::Vector2d at = nearest ? Eigen::Vector2d(pixel.array().round()) : pixel;
  return to_rgb(bilinear(image, at.x(), at.y()));
}

void require_size(std::string_view what, int width, int height, const Camera& camera) {
  if (width == camera.width && height == camera.height) return;
  throw std::invalid_argument(
      fmt::format("color_points: the {} has {} x {} pixels, the camera {} x {}", what, width,
                  height, camera.width, camera.height));
}

void check(const PointCloud& points_cam, const View& view) {
  const auto& [image, camera, frame, mask] = view;
  if (!points_cam.origin.isZero()) {
    throw std::invalid_argument("color_points: the points' origin is not 0, the camera");
  }
  if (mask != nullptr) require_size("mask", mask->width(), mask->height(), camera);
  if (image.empty()) return;  // a drive without cameras
  if (!(camera.fx > 0 && camera.fy > 0)) {
    throw std::invalid_argument("color_points: the camera has no focal length");
  }
  if (camera.index < 0 || camera.index > std::numeric_limits<std::int8_t>::max()) {
    throw std::invalid_argument(
        fmt::format("color_points: the camera has the number {}, beyond 0 to 127", camera.index));
  }
  require_size("image", image.width, image.height, camera);
  const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
  if ((image.channels != 1 && image.channels != 3) ||
      image.data.size() != pixels * std::size_t(image.channels)) {
    throw std::invalid_argument(
        fmt::format("color_points: the image has {} bytes, not 1 or 3 channels of {} x {} pixels",
                    image.data.size(), image.width, image.height));
  }
}

}  // namespace

void color_points(PointCloud& points_cam, const View& view, ImageSampling sampling) {
  check(points_cam, view);
  const std::size_t n = points_cam.size();
  points_cam.color.assign(n, LogColor());
  points_cam.camera.assign(n, kNoCamera);
  points_cam.frame.assign(n, view.frame);
  points_cam.views.assign(n, 0);
  points_cam.spread.assign(n, 0);
  points_cam.weight.assign(n, 0);  // one view, not to be fused with others
  if (view.image.empty()) return;
  parallel_for(n, kGrain, [&](std::size_t i) {
    const auto pixel = view.camera.project(points_cam.position[i].cast<double>());
    if (!pixel || !view.camera.in_view(*pixel)) return;
    constexpr float kNeighbor = 0.5f;  // of the interpolation, pixels
    const Eigen::Vector2f at = pixel->cast<float>();
    if (view.mask != nullptr && view.mask->covers(at.x(), at.y(), kNeighbor)) return;
    points_cam.color[i] = sample(view.image, *pixel, sampling);
    points_cam.camera[i] = static_cast<std::int8_t>(view.camera.index);
    points_cam.views[i] = 1;
  });
}

}  // namespace fovea
