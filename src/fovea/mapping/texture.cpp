#include "fovea/texture.h"

#include "fovea/core/parallel.h"

namespace fovea {
namespace {
constexpr std::size_t kGrain = 8192;

Rgb sample(const Image& image, const Eigen::Vector2d& pixel, ImageSampling sampling) {
  const bool nearest = sampling == ImageSampling::kNearest;
  const Eigen::Vector2d at = nearest ? Eigen::Vector2d(pixel.array().round()) : pixel;
  return to_rgb(bilinear(image, at.x(), at.y()));
}

}  // namespace

void color_points(PointCloud& points_cam, const View& view, ImageSampling sampling) {
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
