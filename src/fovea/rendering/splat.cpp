#include "fovea/rendering/splat.h"

#include <cmath>
#include <stdexcept>

namespace fovea {
namespace {

/// The pixel that a point falls into is always its own: half a pixel's diagonal.
constexpr float kMinRadius = 0.7072f;
/// Samples this far behind the front one in a pixel are still the same surface: what noise does,
/// and what a surface slants over the footprint at up to 83 degrees (tan 83 = 8).
constexpr float kSurfaceNoise = 0.05f;  // m
constexpr float kSurfaceSlant = 8.0f;

struct Disc {
  float u, v, depth, radius;  // pixels, m, pixels
  float surface;              // m, depth within which samples are one surface
  std::uint32_t index;
};

/// Calls f(pixel, squared distance) for the pixels whose centres the disc covers.
template <class F>
void for_each_pixel(const Disc& disc, int width, int height, F&& f) {
  const int left = std::max(0, static_cast<int>(std::ceil(disc.u - disc.radius)));
  const int right = std::min(width - 1, static_cast<int>(std::floor(disc.u + disc.radius)));
  const int top = std::max(0, static_cast<int>(std::ceil(disc.v - disc.radius)));
  const int bottom = std::min(height - 1, static_cast<int>(std::floor(disc.v + disc.radius)));
  for (int y = top; y <= bottom; ++y) {
    const float dy = static_cast<float>(y) - disc.v;
    for (int x = left; x <= right; ++x) {
      const float dx = static_cast<float>(x) - disc.u;
      const float squared = dx * dx + dy * dy;
      if (squared <= disc.radius * disc.radius) {
        f(static_cast<std::size_t>(y) * width + x, squared);
      }
    }
  }
}

/// The four side planes of the view and its near and far planes, to pass over runs that lie
/// outside.
class ViewVolume {
 public:
  ViewVolume(const Camera& camera, const Eigen::Isometry3f& T_cam_map, const SplatOptions& options)
      : T_cam_map_(T_cam_map),
        near_(static_cast<float>(options.min_depth)),
        far_(static_cast<float>(options.max_depth)) {
    const auto slope = [&](double pixel, double center, double focal) {
      return static_cast<float>((pixel - center) / focal);
    };
    const double margin = options.max_radius;
    left_ = slope(-margin, camera.cx, camera.fx);
    right_ = slope(camera.width - 1 + margin, camera.cx, camera.fx);
    top_ = slope(-margin, camera.cy, camera.fy);
    bottom_ = slope(camera.height - 1 + margin, camera.cy, camera.fy);
  }

  bool contains(const Eigen::Vector3f& p) const {  // camera frame
    return p.z() > near_ && p.z() < far_ && p.x() >= left_ * p.z() && p.x() <= right_ * p.z() &&
           p.y() >= top_ * p.z() && p.y() <= bottom_ * p.z();
  }

  bool may_contain(const PointRun& run) const {
    bool near = false, far = false, left = false, right = false, top = false, bottom = false;
    for (int corner = 0; corner < 8;
         ++corner) {  // outside only if all corners are beyond one plane
      const Eigen::Vector3f p =
          T_cam_map_ * Eigen::Vector3f((corner & 1) != 0 ? run.high.x() : run.low.x(),
                                       (corner & 2) != 0 ? run.high.y() : run.low.y(),
                                       (corner & 4) != 0 ? run.high.z() : run.low.z());
      near |= p.z() > near_;
      far |= p.z() < far_;
      left |= p.x() >= left_ * p.z();
      right |= p.x() <= right_ * p.z();
      top |= p.y() >= top_ * p.z();
      bottom |= p.y() <= bottom_ * p.z();
    }
    return near && far && left && right && top && bottom;
  }

 private:
  Eigen::Isometry3f T_cam_map_;
  float near_, far_, left_, right_, top_, bottom_;
};

std::vector<Disc> project(const ColoredPoints& map, const std::vector<float>& spacing,
                          const Camera& camera, const RigidMotion& T_cam_local,
                          const SplatOptions& options) {
  const Eigen::Isometry3f T_cam_map =
      RigidMotion(T_cam_local * Eigen::Translation3d(map.origin)).cast<float>();
  const ViewVolume volume(camera, T_cam_map, options);
  const auto fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
  const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy);
  std::size_t candidates = 0;
  for (const PointRun& run : map.runs) {
    if (volume.may_contain(run)) candidates += run.end - run.begin;
  }
  std::vector<Disc> discs;
  discs.reserve(candidates);  // a vector that grows takes three times the memory
  for (const PointRun& run : map.runs) {
    if (!volume.may_contain(run)) continue;
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      const Eigen::Vector3f p = T_cam_map * map.position[i];
      if (!volume.contains(p)) continue;
      const float radius = std::clamp(fx * spacing[i] / p.z(), kMinRadius, options.max_radius);
      const float surface = kSurfaceNoise + kSurfaceSlant * radius * p.z() / fx;
      discs.push_back(
          {fx * p.x() / p.z() + cx, fy * p.y() / p.z() + cy, p.z(), radius, surface, i});
    }
  }
  return discs;
}

}  // namespace

SplatView splat(const ColoredPoints& map, const std::vector<float>& spacing, const Camera& camera,
                const RigidMotion& T_cam_local, const SplatOptions& options) {
  if (spacing.size() != map.position.size()) {
    throw std::invalid_argument("every map point needs its sample spacing");
  }
  const int width = camera.width, height = camera.height;
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::vector<Disc> discs = project(map, spacing, camera, T_cam_local, options);

  std::vector<float> front(pixels, kInfinity);
  for (const Disc& disc : discs) {
    for_each_pixel(disc, width, height, [&](std::size_t pixel, float) {
      front[pixel] = std::min(front[pixel], disc.depth);
    });
  }
  SplatView view{Image(width, height, 3), std::vector<float>(pixels, kInfinity),
                 std::vector<std::uint8_t>(pixels, 0)};
  std::vector<float> nearest(pixels, kInfinity);
  for (const Disc& disc : discs) {
    for_each_pixel(disc, width, height, [&](std::size_t pixel, float squared) {
      if (disc.depth > front[pixel] + disc.surface || squared >= nearest[pixel]) return;
      nearest[pixel] = squared;
      const Rgb color = options.display(map.color[disc.index]);
      std::uint8_t* out = view.image.data.data() + 3 * pixel;
      out[0] = color.r, out[1] = color.g, out[2] = color.b;
      view.depth[pixel] = disc.depth;
      view.covered[pixel] = 1;
    });
  }
  return view;
}

}  // namespace fovea
