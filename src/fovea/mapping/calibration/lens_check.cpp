#include "fovea/mapping/calibration/lens_check.h"

#include <Eigen/Cholesky>
#include <array>
#include <cmath>

#include "fovea/mapping/calibration/calibration_limits.h"
#include "fovea/mapping/calibration/edge_score.h"
#include "fovea/mapping/calibration/grouped_scatter.h"

namespace fovea {
namespace {

// Calibration, shifts, focal length and distortion.
constexpr int kSize = 11, kFocal = 9, kRadial = 10;
using Vector = Eigen::Matrix<double, kSize, 1>;
using Matrix = Eigen::Matrix<double, kSize, kSize>;

constexpr std::array<double, 4> kWidths{8, 4, 2, 1};  // pixels
constexpr int kIterations = 20;
constexpr std::size_t kMinLensEdges = 500;
// An odd lens: share of the focal length or of the distance of a corner, and standard deviations.
constexpr double kOdd = 0.008, kSignificant = 5;

/// Derivative of an edge's position along its profile, in units of about a pixel.
Vector slope_of(const EdgeProfile& profile, const Camera& camera) {
  Vector J;
  J.head<9>() = profile.J_along.cast<double>().cwiseProduct(calibration_unit());
  const Eigen::Vector2d from_center =
      profile.pixel.cast<double>() - Eigen::Vector2d(camera.cx, camera.cy);
  const double corner = std::hypot(camera.width, camera.height) / 2;
  const double outwards = profile.normal.cast<double>().dot(from_center) / corner;
  const double radius = from_center.norm() / corner;
  J[kFocal] = outwards;  // unit: a pixel in the corner
  J[kRadial] = outwards * radius * radius;
  return J;
}

struct System {
  Vector gradient = Vector::Zero();
  Matrix curvature = Matrix::Zero();
};

System system_at(const std::vector<EdgeProfile>& profiles, const std::vector<Vector>& J,
                 const Vector& x, double width) {
  System system;
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const EdgeSlope edge = edge_slope(profiles[i], J[i].dot(x), width);
    system.gradient += edge.slope * J[i];
    system.curvature += edge.bound * J[i] * J[i].transpose();
  }
  return system;
}

Matrix covariance(const std::vector<EdgeProfile>& profiles, const std::vector<Vector>& J,
                  const Vector& x) {
  Matrix curvature = Matrix::Zero(), mean = Matrix::Zero();
  struct Gradient {
    const EdgeProfile* profile;
    Vector value;
  };
  std::vector<Gradient> gradients;
  gradients.reserve(profiles.size());
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const EdgeSlope edge = edge_slope(profiles[i], J[i].dot(x), kWidths.back());
    curvature += edge.curvature * J[i] * J[i].transpose();
    mean += J[i] * J[i].transpose() / double(profiles.size());
    gradients.push_back({&profiles[i], edge.slope * J[i]});
  }
  const Matrix scatter = grouped_scatter(
      gradients, [](const Gradient& g) { return g.value; },
      [](const Gradient& g) { return g.profile->place; });
  curvature.diagonal().array() += 1e-6 * curvature.diagonal().maxCoeff();
  mean.diagonal().array() += 1e-6;
  const Matrix inverse = curvature.inverse();
  return inverse * scatter * inverse + kSystematicError * kSystematicError * mean.inverse();
}

}  // namespace

bool LensCheck::is_odd(double value, double sigma) {
  return std::abs(value) > kOdd && std::abs(value) > kSignificant * sigma;
}

LensCheck check_lens(const std::vector<EdgeProfile>& profiles, const Camera& camera) {
  LensCheck check;
  if (profiles.size() < kMinLensEdges) return check;
  std::vector<Vector> J;
  J.reserve(profiles.size());
  for (const EdgeProfile& profile : profiles) J.push_back(slope_of(profile, camera));
  Vector x = Vector::Zero();
  for (const double width : kWidths) {
    for (int i = 0; i < kIterations; ++i) {
      System system = system_at(profiles, J, x, width);
      // A step for a paraboloid below the score never leads down.
      system.curvature.diagonal().array() += 1e-6 * system.curvature.diagonal().maxCoeff() + 1e-9;
      const Vector step = system.curvature.ldlt().solve(system.gradient);
      x += step;
      if (step.cwiseAbs().maxCoeff() < 1e-3) break;
    }
  }
  const Matrix cov = covariance(profiles, J, x);
  const double corner = std::hypot(camera.width, camera.height) / 2;
  check.is_checked = true;
  check.focal = x[kFocal] / corner;
  check.focal_sigma = std::sqrt(cov(kFocal, kFocal)) / corner;
  check.radial = x[kRadial] / corner;
  check.radial_sigma = std::sqrt(cov(kRadial, kRadial)) / corner;
  return check;
}

}  // namespace fovea
