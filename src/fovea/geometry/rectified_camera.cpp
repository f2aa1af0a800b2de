#include "fovea/geometry/rectified_camera.h"

#include <algorithm>
#include <cmath>

namespace fovea {
namespace {

constexpr int kSmallestSide = 8;  // pixels

/// Pixels of the pinhole camera, its principal point where the lens camera's is.
struct PixelRectangle {
  int left, right, top, bottom;  // the first and last columns and rows

  int width() const { return right - left + 1; }
  int height() const { return bottom - top + 1; }
};

class Coverage {
 public:
  explicit Coverage(const LensCamera& camera) : camera_(camera) {}

  bool covered(int u, int v) const {
    const Eigen::Vector3d ray((u - camera_.cx) / camera_.fx, (v - camera_.cy) / camera_.fy, 1);
    const auto pixel = camera_.project(ray);
    return pixel && camera_.in_view(*pixel);
  }

  /// Takes columns and rows off, always of the side of which most is not covered, until all four
  /// are.
  /// @param samples  of a side that are looked at
  void shrink(PixelRectangle& r, int samples) const {
    while (r.width() >= kSmallestSide && r.height() >= kSmallestSide) {
      const auto column = [&](int u) {
        return uncovered(r.top, r.bottom, samples, [&](int v) { return covered(u, v); });
      };
      const auto row = [&](int v) {
        return uncovered(r.left, r.right, samples, [&](int u) { return covered(u, v); });
      };
      const double left = column(r.left), right = column(r.right), top = row(r.top),
                   bottom = row(r.bottom);
      const double worst = std::max({left, right, top, bottom});
      if (worst == 0) return;
      if (left == worst) {
        ++r.left;
      } else if (right == worst) {
        --r.right;
      } else if (top == worst) {
        ++r.top;
      } else {
        --r.bottom;
      }
    }
  }

 private:
  /// Share of the places from first to last that are not covered.
  template <class Covered>
  static double uncovered(int first, int last, int samples, Covered&& is_covered) {
    const int steps = std::clamp(last - first, 1, samples);
    int missing = 0;
    for (int i = 0; i <= steps; ++i) {
      const auto along = static_cast<int>(std::int64_t{last - first} * i / steps);
      if (!is_covered(first + along)) ++missing;
    }
    return double(missing) / (steps + 1);
  }

  const LensCamera& camera_;
};

/// Slopes x / z and y / z of what the lens camera sees, at most those of the field of view.
Eigen::AlignedBox2d seen_slopes(const LensCamera& camera, double max_field_of_view) {
  const double most = std::tan(max_field_of_view / 2);
  const Eigen::AlignedBox2d widest(Eigen::Vector2d(-most, -most), Eigen::Vector2d(most, most));
  Eigen::AlignedBox2d seen;
  const auto look_at = [&](int u, int v) {
    const auto ray = camera.ray({double(u), double(v)});
    if (!ray || !(ray->z() > 0)) {
      seen.extend(widest);
    } else {
      seen.extend(Eigen::Vector2d(ray->head<2>() / ray->z()));
    }
  };
  for (int u = 0; u < camera.width; ++u) {
    look_at(u, 0);
    look_at(u, camera.height - 1);
  }
  for (int v = 0; v < camera.height; ++v) {
    look_at(0, v);
    look_at(camera.width - 1, v);
  }
  return seen.intersection(widest);
}

}  // namespace

std::optional<Camera> rectified_camera(const LensCamera& camera, double max_field_of_view,
                                       int max_side) {
  Camera pinhole;
  pinhole.fx = camera.fx;
  pinhole.fy = camera.fy;
  PixelRectangle r{0, camera.width - 1, 0, camera.height - 1};
  if (camera.lens.model() != LensModel::kNone) {
    const Eigen::AlignedBox2d slopes = seen_slopes(camera, max_field_of_view);
    const Eigen::Vector2d focal(camera.fx, camera.fy), center(camera.cx, camera.cy);
    const Eigen::Vector2d low = slopes.min().cwiseProduct(focal) + center,
                          high = slopes.max().cwiseProduct(focal) + center;
    const Eigen::Vector2d size = high - low;
    const bool usable = !slopes.isEmpty() && size.minCoeff() >= kSmallestSide &&
                        size.maxCoeff() < max_side && low.cwiseAbs().maxCoeff() < 1e8;
    if (!usable) return std::nullopt;
    r = {static_cast<int>(std::ceil(low.x())), static_cast<int>(std::floor(high.x())),
         static_cast<int>(std::ceil(low.y())), static_cast<int>(std::floor(high.y()))};
    constexpr int kSamples = 64;
    const Coverage coverage(camera);
    coverage.shrink(r, kSamples);
    coverage.shrink(r, max_side);
    if (r.width() < kSmallestSide || r.height() < kSmallestSide) return std::nullopt;
  }
  pinhole.width = r.width();
  pinhole.height = r.height();
  pinhole.cx = camera.cx - r.left;
  pinhole.cy = camera.cy - r.top;
  return pinhole;
}

}  // namespace fovea
