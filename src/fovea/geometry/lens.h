// A camera as it is built: lenses bend straight lines.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <string_view>

#include "fovea/platform.h"

namespace fovea {

/// How a lens distorts; the names are those of ROS, the formulas OpenCV's.
enum class LensModel {
  kNone,                ///< "none": pinhole
  kPlumbBob,            ///< "plumb_bob" (Brown-Conrady): k1 k2 p1 p2 k3
  kRationalPolynomial,  ///< "rational_polynomial": k1 k2 p1 p2 k3 k4 k5 k6
  kEquidistant,         ///< "equidistant" (Kannala-Brandt fisheye): k1 k2 k3 k4
};

/// The name in quotes above.
std::string_view to_string(LensModel model);

/// How many coefficients a model has.
std::size_t coefficient_count(LensModel model);

using LensCoefficients = std::array<double, 8>;

/// Coefficients as files list them: the plumb bob's k3 may be missing, zeros may follow. Empty if
/// they are not the model's, or one is no lens's: over a million or not a number.
std::optional<LensCoefficients> lens_coefficients(LensModel model, std::span<const double> listed);

/// A lens of focal length 1.
class Lens {
 public:
  Lens() = default;
  /// @param coefficients  in the model's order; those it has none of are 0
  Lens(LensModel model, const LensCoefficients& coefficients);

  LensModel model() const { return model_; }
  const LensCoefficients& coefficients() const { return k_; }

  /// Where a ray meets the image plane; empty if it comes from the side or from behind, beyond
  /// where the model turns back on itself.
  std::optional<Eigen::Vector2d> distort(const Eigen::Vector3d& ray_cam) const;
  /// The ray (not of length 1) that meets the image plane there; empty if none does.
  std::optional<Eigen::Vector3d> ray(const Eigen::Vector2d& distorted) const;

 private:
  /// The distorted radius of a radius: the slope hypot(x, y) / z, or the angle (rad) of a fisheye.
  double radial(double r) const;
  /// Radius of a distorted one; empty if beyond the limit.
  std::optional<double> undo_radial(double distorted) const;
  Eigen::Vector2d tangential(const Eigen::Vector2d& p) const;
  double find_limit() const;

  LensModel model_ = LensModel::kNone;
  LensCoefficients k_{};
  double limit_ = 0;  // radius up to which radial() grows; not of kNone
};

/// Intrinsics of a camera with its lens. Pixel centres at integers, as in Camera.
struct LensCamera {
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  Lens lens;

  /// Whether focal lengths and principal point are a camera's, in pixels: not so of NaN.
  bool has_pinhole() const;
  /// Pixel of a ray, in the image or beside it; empty as Lens::distort.
  std::optional<Eigen::Vector2d> project(const Eigen::Vector3d& ray_cam) const;
  /// The ray of a pixel; empty as Lens::ray.
  std::optional<Eigen::Vector3d> ray(const Eigen::Vector2d& pixel) const;
  /// Whether a colour can be interpolated there, as Camera::in_view.
  bool in_view(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= 0 && pixel.x() <= width - 1 && pixel.y() >= 0 && pixel.y() <= height - 1;
  }
};

}  // namespace fovea
