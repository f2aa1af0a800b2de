#include "fovea/geometry/lens.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fovea {

std::string_view to_string(LensModel model) {
  switch (model) {
    case LensModel::kNone:
      return "none";
    case LensModel::kPlumbBob:
      return "plumb_bob";
    case LensModel::kRationalPolynomial:
      return "rational_polynomial";
    case LensModel::kEquidistant:
      return "equidistant";
  }
  return "unknown";
}

std::size_t coefficient_count(LensModel model) {
  switch (model) {
    case LensModel::kNone:
      return 0;
    case LensModel::kPlumbBob:
      return 5;
    case LensModel::kRationalPolynomial:
      return 8;
    case LensModel::kEquidistant:
      return 4;
  }
  return 0;
}

std::optional<LensCoefficients> lens_coefficients(LensModel model, std::span<const double> listed) {
  constexpr double kMax = 1e6;
  const std::size_t count = coefficient_count(model);
  const std::size_t least = model == LensModel::kPlumbBob ? count - 1 : count;
  if (listed.size() < least) return std::nullopt;
  LensCoefficients coefficients{};
  for (std::size_t i = 0; i < listed.size(); ++i) {
    // Written so that NaN fails, too.
    if (!(std::abs(listed[i]) <= (i < count ? kMax : 0))) return std::nullopt;
    if (i < count) coefficients[i] = listed[i];
  }
  return coefficients;
}

Lens::Lens(LensModel model, const LensCoefficients& coefficients)
    : model_(model), k_(coefficients) {
  std::fill(k_.begin() + static_cast<std::ptrdiff_t>(coefficient_count(model)), k_.end(), 0.0);
  if (model_ != LensModel::kNone) limit_ = find_limit();
}

double Lens::radial(double r) const {
  const double r2 = r * r;
  if (model_ == LensModel::kEquidistant) {
    return r * (1 + r2 * (k_[0] + r2 * (k_[1] + r2 * (k_[2] + r2 * k_[3]))));
  }
  return r * (1 + r2 * (k_[0] + r2 * (k_[1] + r2 * k_[4]))) /
         (1 + r2 * (k_[5] + r2 * (k_[6] + r2 * k_[7])));
}

Eigen::Vector2d Lens::tangential(const Eigen::Vector2d& p) const {
  if (model_ == LensModel::kEquidistant) return Eigen::Vector2d::Zero();
  const double r2 = p.squaredNorm(), xy = p.x() * p.y();
  return {2 * k_[2] * xy + k_[3] * (r2 + 2 * p.x() * p.x()),
          k_[2] * (r2 + 2 * p.y() * p.y()) + 2 * k_[3] * xy};
}

double Lens::find_limit() const {
  constexpr int kSteps = 4096;
  constexpr double kSteepest = 10;  // 84 degrees from the axis
  const double end = model_ == LensModel::kEquidistant ? std::numbers::pi : kSteepest;
  double limit = 0, reached = 0;
  for (int i = 1; i <= kSteps; ++i) {
    const double r = end * i / kSteps, distorted = radial(r);
    if (!(distorted > reached) || !std::isfinite(distorted)) break;
    limit = r;
    reached = distorted;
  }
  return limit;
}

std::optional<double> Lens::undo_radial(double distorted) const {
  double low = 0, high = limit_;
  if (!(distorted <= radial(high))) return std::nullopt;
  double r = std::min(distorted, high);
  // Regula falsi's bracket with secant steps inside it: the function grows all the way.
  double r_before = high, f_before = radial(high) - distorted;
  constexpr int kIterations = 100;
  for (int i = 0; i < kIterations; ++i) {
    const double f = radial(r) - distorted;
    if (f == 0) return r;
    (f < 0 ? low : high) = r;
    double next = r - f * (r - r_before) / (f - f_before);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    r_before = r;
    f_before = f;
    if (std::abs(next - r) <= 1e-15 * r) return next;
    r = next;
  }
  return r;
}

std::optional<Eigen::Vector2d> Lens::distort(const Eigen::Vector3d& ray_cam) const {
  const double side = ray_cam.head<2>().norm();
  if (model_ == LensModel::kEquidistant) {
    const double angle = std::atan2(side, ray_cam.z());
    if (!(angle <= limit_)) return std::nullopt;
    if (side == 0) return Eigen::Vector2d::Zero();
    return Eigen::Vector2d(ray_cam.head<2>() * (radial(angle) / side));
  }
  if (!(ray_cam.z() > 0)) return std::nullopt;
  const Eigen::Vector2d p = ray_cam.head<2>() / ray_cam.z();
  if (model_ == LensModel::kNone) return p;
  const double r = side / ray_cam.z();
  if (!(r <= limit_)) return std::nullopt;
  return Eigen::Vector2d((r == 0 ? 1 : radial(r) / r) * p + tangential(p));
}

std::optional<Eigen::Vector3d> Lens::ray(const Eigen::Vector2d& distorted) const {
  if (model_ == LensModel::kNone) return Eigen::Vector3d(distorted.x(), distorted.y(), 1);
  if (model_ == LensModel::kEquidistant) {
    const double radius = distorted.norm();
    const std::optional<double> angle = undo_radial(radius);
    if (!angle) return std::nullopt;
    if (radius == 0) return Eigen::Vector3d(0, 0, 1);
    const Eigen::Vector2d side = distorted * (std::sin(*angle) / radius);
    return Eigen::Vector3d(side.x(), side.y(), std::cos(*angle));
  }
  // What the tangential part adds is small beside the radial one and hardly changes with the ray.
  constexpr int kIterations = 50;
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  for (int i = 0; i < kIterations; ++i) {
    const Eigen::Vector2d radial_part = distorted - tangential(p);
    const double radius = radial_part.norm();
    const std::optional<double> r = undo_radial(radius);
    if (!r) return std::nullopt;
    const Eigen::Vector2d next =
        radius == 0 ? radial_part : Eigen::Vector2d(radial_part * (*r / radius));
    const bool settled = (next - p).norm() <= 1e-14 * (1 + next.norm());
    p = next;
    if (settled) return Eigen::Vector3d(p.x(), p.y(), 1);
  }
  return std::nullopt;
}

bool LensCamera::has_pinhole() const {
  constexpr double kMax = 1e5;
  return fx >= 1 && fx <= kMax && fy >= 1 && fy <= kMax && std::abs(cx) <= kMax &&
         std::abs(cy) <= kMax;
}

std::optional<Eigen::Vector2d> LensCamera::project(const Eigen::Vector3d& ray_cam) const {
  const std::optional<Eigen::Vector2d> p = lens.distort(ray_cam);
  if (!p) return std::nullopt;
  return Eigen::Vector2d(fx * p->x() + cx, fy * p->y() + cy);
}

std::optional<Eigen::Vector3d> LensCamera::ray(const Eigen::Vector2d& pixel) const {
  return lens.ray({(pixel.x() - cx) / fx, (pixel.y() - cy) / fy});
}

}  // namespace fovea
