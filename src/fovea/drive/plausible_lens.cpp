#include "fovea/drive/plausible_lens.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/core/angle.h"

namespace fovea {
namespace {

constexpr double kNarrowest = 1 * kDegree, kWidest = 179 * kDegree;  // of a pinhole camera
constexpr double kWidestFisheye = 360 * kDegree;
constexpr double kMostOblique =
    70 * kDegree;                 // from the axis to the nearest pixel: a part of an image
constexpr double kMaxAspect = 3;  // anamorphic lenses have 2
constexpr double kMinSeen = 0.5;  // share of the image that has rays
constexpr double kLeastAngleRatio = 1. / 3;  // of a ray's angle to that of the pinhole model

constexpr const char* kFocalRemedy =
    "give fx and fy in pixels of the images as they are, not in millimeters";

bool is_fisheye(const LensCamera& camera) { return camera.lens.model() == LensModel::kEquidistant; }

/// Angle from the optical axis of a ray at `slope` focal lengths from the principal point, without
/// distortion.
double plain_angle(const LensCamera& camera, double slope) {
  return is_fisheye(camera) ? slope : std::atan(slope);
}

std::optional<LensProblem> focal_problem(const LensCamera& c) {
  for (const auto& [name, side, focal] :
       {std::tuple("width", c.width, c.fx), std::tuple("height", c.height, c.fy)}) {
    const double view = 2 * plain_angle(c, side / (2 * focal));
    if (view >= kNarrowest && view <= (is_fisheye(c) ? kWidestFisheye : kWidest)) continue;
    return LensProblem{"K",
                       fmt::format("a focal length of {:.4g} for a {} of {} pixels makes a field "
                                   "of view of {:.4g} degrees",
                                   focal, name, side, view / kDegree),
                       kFocalRemedy};
  }
  if (std::max(c.fx, c.fy) <= kMaxAspect * std::min(c.fx, c.fy)) return std::nullopt;
  return LensProblem{"K", fmt::format("the focal lengths {:.4g} and {:.4g} differ", c.fx, c.fy),
                     kFocalRemedy};
}

std::optional<LensProblem> principal_point_problem(const LensCamera& c) {
  for (const auto& [name, side, focal, center] :
       {std::tuple("width", c.width, c.fx, c.cx), std::tuple("height", c.height, c.fy, c.cy)}) {
    const double outside = std::max({-center, center - (side - 1), 0.0});
    if (plain_angle(c, outside / focal) <= kMostOblique) continue;
    return LensProblem{"K",
                       fmt::format("a principal point at {:.6g} lies far outside of a {} of {} "
                                   "pixels",
                                   center, name, side),
                       "give cx and cy in pixels of the images as they are"};
  }
  return std::nullopt;
}

std::optional<LensProblem> distortion_problem(const LensCamera& c) {
  constexpr int kSteps = 16;  // samples along each side
  constexpr const char* kRemedy = "give the coefficients of this model, in its order";
  int seen = 0;
  double least_ratio = 1;
  for (int row = 0; row <= kSteps; ++row) {
    for (int column = 0; column <= kSteps; ++column) {
      const Eigen::Vector2d pixel(double(c.width - 1) * column / kSteps,
                                  double(c.height - 1) * row / kSteps);
      const auto ray = c.ray(pixel);
      if (!ray) continue;
      ++seen;
      const double slope = std::hypot((pixel.x() - c.cx) / c.fx, (pixel.y() - c.cy) / c.fy);
      const double angle = std::atan2(ray->head<2>().norm(), ray->z());
      if (slope > 0) least_ratio = std::min(least_ratio, angle / plain_angle(c, slope));
    }
  }
  const double share = double(seen) / ((kSteps + 1) * (kSteps + 1));
  if (!(share >= kMinSeen)) {
    return LensProblem{
        "D",
        fmt::format("the distortion has no inverse on {:.0f} % of the image", 100 * (1 - share)),
        kRemedy};
  }
  if (least_ratio >= kLeastAngleRatio) return std::nullopt;
  return LensProblem{
      "D", fmt::format("the distortion narrows the view to {:.0f} % in places", 100 * least_ratio),
      kRemedy};
}

}  // namespace

std::optional<LensProblem> lens_problem(const LensCamera& camera) {
  if (auto problem = focal_problem(camera)) return problem;
  if (auto problem = principal_point_problem(camera)) return problem;
  if (camera.lens.model() == LensModel::kNone) return std::nullopt;
  return distortion_problem(camera);
}

std::optional<LensProblem> lens_problem(const Camera& camera) {
  return lens_problem(
      LensCamera{camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy, Lens()});
}

}  // namespace fovea
