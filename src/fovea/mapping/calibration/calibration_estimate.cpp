#include "fovea/mapping/calibration/calibration_estimate.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "fovea/core/angle.h"
#include "fovea/core/median.h"
#include "fovea/mapping/calibration/edge_agreement.h"
#include "fovea/mapping/calibration/edge_score.h"

namespace fovea {
namespace {

using Vector = CalibrationVector;
using Matrix = CalibrationMatrix;
using Free = std::array<bool, 6>;  // parameters to estimate; the others are fixed at 0

// Standard deviations of the Gaussian that smooths image edges, pixels: coarse to fine.
constexpr std::array<double, 5> kWidths{8, 4, 2, 1, 0.5};
constexpr int kMaxIterations = 60;
constexpr double kConverged = 1e-3;   // pixels
constexpr double kNearEnough = 0.02;  // of a coarse Gaussian's width
constexpr int kDelay = 3;
// A parameter with less than this share of the largest curvature moves no edge.
constexpr double kLeastCurvature = 1e-4;

constexpr int kMinFrames = 5, kMinFramesJudged = 3;
constexpr std::size_t kMinEdges = 200;
constexpr double kMaxRotationSigma = 0.15 * kDegree, kMaxDelaySigma = 0.004;
// RMS speed of edges, pixels per second, that a delay needs to be observable.
constexpr double kMinFlow = 40;
constexpr double kMaxRotation = 2 * kDegree, kMaxDelay = 0.1;  // larger is a wrong maximum
// Estimates below these limits do not depend on the choice of frames (docs/calibration.md).
constexpr double kSureRotation = 1.7 * kDegree, kSureDelay = 0.08;
constexpr double kSurePixels = EdgeProfile::kReach - 4;
// Rings up to this spacing (an HDL-64E's) do not bias a rotation. Wider rings add a standard
// deviation of this share of the excess: KITTI with half of the rings is off by 0.15 degrees in one
// of two cameras.
constexpr double kDenseRings = 0.5 * kDegree, kGapShare = 1.0 / 6;
// Standard deviation of an unknown delay (s), which biases a rotation that is estimated without it.
constexpr double kLikelyDelay = 0.02;
// Minimum gain in the mean logarithm of edge strength over rotated cameras. Drives have 0.7 to 1.3,
// the maximum of clutter up to 0.13, and edges beyond the ends of the profiles up to 0.46
// (docs/calibration.md).
constexpr double kMinContrast = 0.5;
constexpr double kElsewhere = 8;  // pixels
constexpr double kConfirmed =
    2;  // standard deviations of the gain of one half by the correction of the other

/// Removes the rows and columns of fixed parameters from a system of equations.
Matrix only(const Free& free, Matrix m) {
  const double largest = m.diagonal().maxCoeff();
  for (int k = 0; k < 6; ++k) {
    if (free[static_cast<std::size_t>(k)]) continue;
    m.row(k).setZero();
    m.col(k).setZero();
    m(k, k) = largest;
  }
  return m;
}

Vector only(const Free& free, Vector v) {
  for (int k = 0; k < 6; ++k) {
    if (!free[static_cast<std::size_t>(k)]) v[k] = 0;
  }
  return v;
}

bool positive(const Matrix& m) {
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(m, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()[0] > 1e-6 * eigen.eigenvalues()[5];
}

/// Finds the maximum of the score from no correction, coarse to fine, with Newton steps. If a step
/// leads down or the score is not concave, it uses the paraboloid below the score instead, whose
/// maximum never leads down.
Vector climb(const std::vector<EdgeProfile>& profiles, const Free& free) {
  Vector x = Vector::Zero();
  for (const double width : kWidths) {
    const double converged = width == kWidths.back() ? kConverged : kNearEnough * width;
    EdgeScore score = edge_score(profiles, x, width);
    for (int i = 0; i < kMaxIterations; ++i) {
      const Vector gradient = only(free, score.gradient);
      const Matrix curvature = only(free, score.curvature), bound = only(free, score.bound);
      if (!(bound.diagonal().maxCoeff() > 0)) return x;  // nothing in sight
      std::optional<EdgeScore> next;
      Vector step = Vector::Zero();
      if (positive(curvature)) {
        step = curvature.ldlt().solve(gradient);
        next = edge_score(profiles, x + step, width);
        if (!(next->value >= score.value)) next.reset();
      }
      if (!next) {
        step = (bound + 1e-9 * bound.diagonal().maxCoeff() * Matrix::Identity())
                   .ldlt()
                   .solve(gradient);
      }
      x += step;
      if (step.norm() < converged) break;
      score = next ? *next : edge_score(profiles, x, width);
    }
  }
  return x;
}

/// Scatter of the sums of gradients over groups of edges with common errors, corrected for the
/// number of groups.
template <class Key>
Matrix scatter_by(const std::vector<EdgeProfile>& profiles, const Free& free, const Vector& x,
                  Key&& key) {
  std::map<std::decay_t<decltype(key(profiles.front()))>, Vector> sums;
  for (const EdgeProfile& profile : profiles) {
    sums.try_emplace(key(profile), Vector::Zero()).first->second +=
        only(free, edge_score(profile, x, kWidths.back()).gradient);
  }
  Matrix scatter = Matrix::Zero();
  for (const auto& [group, sum] : sums) scatter += sum * sum.transpose();
  const double n = static_cast<double>(sums.size());
  return n / std::max(n - 1, 1.0) * scatter;
}

/// Covariance of the maximum, H^-1 S H^-1 (H: curvature, S: scatter of the gradients there). Edges
/// of one frame have common errors, and so do edges of one object in all frames: S is the sum of
/// both.
Matrix covariance(const std::vector<EdgeProfile>& profiles, const Free& free, const Vector& x,
                  const Matrix& curvature) {
  const Matrix inverse = only(free, curvature).inverse();
  const Matrix scatter =
      scatter_by(profiles, free, x, [](const EdgeProfile& p) { return p.frame; }) +
      scatter_by(profiles, free, x, [](const EdgeProfile& p) { return p.place; });
  Matrix result = inverse * scatter * inverse;
  if (!free[kDelay]) {
    const Vector turned = inverse * only(free, Vector(curvature.col(kDelay))) *
                          (kLikelyDelay / calibration_unit()[kDelay]);
    result += turned * turned.transpose();
  }
  return result;
}

/// Variance of a rotation across sparse rings. An object ends somewhere between two rings, mostly
/// on the same side. Wide gaps therefore bias all edges of a drive in one direction.
Matrix gap_covariance(const std::vector<EdgeProfile>& profiles) {
  double spacing = 0, across = 0;  // across: > 0 if a rotation about x moves edges between rings
                                   // more than one about y
  for (const EdgeProfile& profile : profiles) {
    spacing = std::max(spacing, double(profile.ring_spacing));
    const bool between_rings = profile.J_along[4] == 0;
    if (between_rings) across += std::abs(profile.J_along[0]) - std::abs(profile.J_along[1]);
  }
  const int axis = across < 0 ? 1 : 0;
  const double sigma = kGapShare * std::max(0.0, spacing - kDenseRings) / calibration_unit()[axis];
  Matrix result = Matrix::Zero();
  result(axis, axis) = sigma * sigma;
  return result;
}

void describe_pixels(const std::vector<EdgeProfile>& profiles, const Vector& x, const Matrix& cov,
                     CalibrationEstimate& estimate) {
  std::vector<double> displacements, sigmas;
  for (const EdgeProfile& profile : profiles) {
    const Eigen::Matrix<double, 2, 4> J =
        profile.J.cast<double>() * calibration_unit().head<4>().asDiagonal();
    displacements.push_back((J * x.head<4>()).norm());
    sigmas.push_back(std::sqrt((J * cov.topLeftCorner<4, 4>() * J.transpose()).trace()));
  }
  estimate.pixels = median_of(std::move(displacements));
  estimate.pixels_sigma = median_of(std::move(sigmas));
}

/// Whether the edge strength exceeds that of rotated cameras by more than chance.
bool stands_out(const std::vector<EdgeProfile>& profiles, const Vector& x, double value) {
  double elsewhere = 0;
  for (const auto& [axis, sign] : {std::pair{0, -1}, {0, 1}, {1, -1}, {1, 1}}) {
    const Vector other = x + sign * kElsewhere * Vector::Unit(axis);
    elsewhere += edge_score(profiles, other, kWidths.back()).value / 4;
  }
  return value - elsewhere > kMinContrast * static_cast<double>(profiles.size());
}

enum class Outcome { kFound, kDelayUnobservable, kNothing };

/// If it finds an estimate, sets all but the counts.
Outcome try_estimate(const std::vector<EdgeProfile>& profiles, const Free& free,
                     CalibrationEstimate& estimate) {
  const Vector x = climb(profiles, free);
  const EdgeScore score = edge_score(profiles, x, kWidths.back());
  const bool with_delay = free[kDelay];
  const Outcome failure = with_delay ? Outcome::kDelayUnobservable : Outcome::kNothing;
  if (!positive(only(free, score.curvature))) return failure;
  const Matrix cov = covariance(profiles, free, x, score.curvature);
  const Vector sigma = cov.diagonal().cwiseMax(0).cwiseSqrt().cwiseProduct(calibration_unit());
  const Vector found = x.cwiseProduct(calibration_unit());
  if (with_delay && (sigma[kDelay] > kMaxDelaySigma || std::abs(found[kDelay]) > kMaxDelay)) {
    return failure;
  }
  if (sigma.head<3>().maxCoeff() > kMaxRotationSigma || found.head<3>().norm() > kMaxRotation ||
      !stands_out(profiles, x, score.value)) {
    return Outcome::kNothing;
  }
  const Matrix whole = cov + gap_covariance(profiles);
  estimate.rotation_observable = true;
  estimate.rotation = found.head<3>();
  estimate.rotation_sigma =
      whole.diagonal().head<3>().cwiseSqrt().cwiseProduct(calibration_unit().head<3>());
  estimate.delay_observable = with_delay;
  estimate.delay = with_delay ? found[kDelay] : 0;
  estimate.delay_sigma = with_delay ? sigma[kDelay] : 0;
  describe_pixels(profiles, x, whole, estimate);
  estimate.correctable = estimate.rotation.norm() <= kSureRotation &&
                         std::abs(estimate.delay) <= kSureDelay && estimate.pixels <= kSurePixels &&
                         !edges_disagree(profiles, x);
  return Outcome::kFound;
}

/// Whether the correction from each half of the frames improves the agreement of the other half by
/// more than chance. A maximum from clutter in one half is none in the other.
bool halves_confirm(const std::vector<EdgeProfile>& profiles, const Free& free) {
  auto middle = profiles.begin() + static_cast<std::ptrdiff_t>(profiles.size() / 2);
  while (middle != profiles.end() && middle->frame == (middle - 1)->frame) ++middle;
  const std::array<std::vector<EdgeProfile>, 2> halves{
      std::vector<EdgeProfile>(profiles.begin(), middle),
      std::vector<EdgeProfile>(middle, profiles.end())};
  double gain = 0, variance = 0;
  for (const std::size_t half : {0u, 1u}) {
    const Vector correction = climb(halves[half], free);
    Vector none = correction;  // keeps the shifts, which are no calibration
    none.head<4>().setZero();
    const EdgeMean mean = edge_gain(halves[1 - half], correction, none);
    if (mean.mean <= 0) return false;
    gain += mean.mean;
    variance += mean.sigma * mean.sigma;
  }
  return gain > kConfirmed * std::sqrt(variance);
}

/// The parameters that move edges.
Free movable(const std::vector<EdgeProfile>& profiles) {
  const Matrix bound = edge_score(profiles, Vector::Zero(), kWidths.front()).bound;
  Free free{};
  for (int k = 0; k < 6; ++k) {
    free[static_cast<std::size_t>(k)] = bound(k, k) > kLeastCurvature * bound.diagonal().maxCoeff();
  }
  double flow2 = 0;
  for (const EdgeProfile& profile : profiles) flow2 += profile.J.col(kDelay).squaredNorm();
  free[kDelay] = flow2 > kMinFlow * kMinFlow * static_cast<double>(profiles.size());
  return free;
}

int count_frames(const std::vector<EdgeProfile>& profiles) {
  int count = 0, last = -1;
  for (const EdgeProfile& profile : profiles) {
    if (count == 0 || profile.frame != last) ++count;
    last = profile.frame;
  }
  return count;
}

}  // namespace

CalibrationEstimate estimate_calibration(const std::vector<EdgeProfile>& profiles) {
  CalibrationEstimate estimate;
  estimate.frames = count_frames(profiles);
  estimate.edges = profiles.size();
  if (estimate.frames >= kMinFrames && estimate.edges >= kMinEdges) {
    CalibrationEstimate found = estimate;
    Free free = movable(profiles);
    Outcome outcome = try_estimate(profiles, free, found);
    if (outcome == Outcome::kDelayUnobservable) {
      free[kDelay] = false;
      outcome = try_estimate(profiles, free, found);
    }
    const bool is_found = outcome == Outcome::kFound;
    if (is_found && (!found.off_by_a_pixel() || halves_confirm(profiles, free))) return found;
  }
  estimate.disagrees = estimate.frames >= kMinFramesJudged && edges_disagree(profiles);
  return estimate;
}

Camera corrected(const Camera& camera, const CalibrationEstimate& estimate) {
  Camera right = camera;
  right.T_cam_lidar =
      exp_se3((Twist() << estimate.rotation, 0, 0, 0).finished()) * camera.T_cam_lidar;
  right.image_delay += estimate.delay;
  return right;
}

}  // namespace fovea
