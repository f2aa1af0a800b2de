#include "fovea/mapping/calibration/calibration_estimate.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "fovea/core/angle.h"
#include "fovea/mapping/calibration/calibration_limits.h"
#include "fovea/mapping/calibration/edge_agreement.h"
#include "fovea/mapping/calibration/edge_displacement.h"
#include "fovea/mapping/calibration/edge_maximum.h"
#include "fovea/mapping/calibration/edge_score.h"

namespace fovea {
namespace {

using Vector = CalibrationVector;
using Matrix = CalibrationMatrix;
using Free = FreeParameters;

// A parameter with less than this share of the largest curvature moves no edge.
constexpr double kLeastCurvature = 1e-4;

constexpr int kMinFrames = 5, kMinFramesJudged = 3;
// RMS speed of edges, pixels per second, that a delay needs to be observable.
constexpr double kMinFlow = 40;
constexpr double kMaxRotation = 2 * kDegree, kMaxDelay = 0.1;  // larger is a wrong maximum
// Rings up to this spacing (an HDL-64E's) do not bias a rotation. Wider rings add a standard
// deviation of this share of the excess: KITTI with half of the rings is off by 0.15 degrees in one
// of two cameras.
constexpr double kDenseRings = 0.5 * kDegree, kGapShare = 1.0 / 6;
constexpr double kConfirmed =
    2;  // standard deviations of the gain of one half by the correction of the other

/// Variance of a rotation across sparse rings. An object ends somewhere between two rings, mostly
/// on the same side. Wide gaps therefore bias all edges of a drive in one direction.
Matrix gap_covariance(const std::vector<EdgeProfile>& profiles) {
  double spacing = 0, across = 0;  // across: > 0 if a rotation about x moves edges between rings
                                   // more than one about y
  for (const EdgeProfile& profile : profiles) {
    spacing = std::max(spacing, double(profile.ring_spacing));
    const bool between_rings = profile.J_along[kShiftAlongRing] == 0;
    if (between_rings) across += std::abs(profile.J_along[0]) - std::abs(profile.J_along[1]);
  }
  const int axis = across < 0 ? 1 : 0;
  const double sigma = kGapShare * std::max(0.0, spacing - kDenseRings) / calibration_unit()[axis];
  Matrix result = Matrix::Zero();
  result(axis, axis) = sigma * sigma;
  return result;
}

enum class Outcome { kFound, kDelayUnobservable, kNothing };

/// If it finds an estimate, sets all but the counts.
Outcome try_estimate(const std::vector<EdgeProfile>& profiles, const Free& free,
                     CalibrationEstimate& estimate) {
  const Vector x = maximize_edge_score(profiles, free);
  const EdgeScore score = edge_score(profiles, x, kFinestEdgeWidth);
  const bool with_delay = free[kCamDelay];
  const Outcome failure = with_delay ? Outcome::kDelayUnobservable : Outcome::kNothing;
  if (!is_positive_definite(decoupled(free, score.curvature))) return failure;
  const Matrix cov = edge_covariance(profiles, free, x, score.curvature);
  const Vector sigma = cov.diagonal().cwiseMax(0).cwiseSqrt().cwiseProduct(calibration_unit());
  const Vector found = x.cwiseProduct(calibration_unit());
  if (with_delay && (sigma[kCamDelay] > kMaxDelaySigma || std::abs(found[kCamDelay]) > kMaxDelay)) {
    return failure;
  }
  if (sigma.head<3>().maxCoeff() > kMaxRotationSigma || found.head<3>().norm() > kMaxRotation ||
      !edges_stand_out(profiles, x)) {
    return Outcome::kNothing;
  }
  const Matrix whole = cov + gap_covariance(profiles);
  estimate.observable = {true, true, true, false, false, false, with_delay};
  estimate.correction = correction_of(x);
  estimate.sigma = correction_of(whole.diagonal().cwiseMax(0).cwiseSqrt());
  const EdgeDisplacement displacement = edge_displacement(profiles, x, whole);
  estimate.pixels = displacement.pixels;
  estimate.pixels_sigma = displacement.sigma;
  return Outcome::kFound;
}

/// Whether the correction from each half of the frames improves the agreement of the other half by
/// more than chance. A maximum from clutter in one half is none in the other.
bool halves_confirm(const std::vector<EdgeProfile>& profiles, const Free& free) {
  const std::array<std::vector<EdgeProfile>, 2> halves = halves_of(profiles);
  double gain = 0, variance = 0;
  for (const std::size_t half : {0u, 1u}) {
    const Vector correction = maximize_edge_score(halves[half], free);
    Vector none = correction;  // keeps the shifts, which are no calibration
    none.head<kCalibrationSize>().setZero();
    const EdgeMean mean = edge_gain(halves[1 - half], correction, none);
    if (mean.mean <= 0) return false;
    gain += mean.mean;
    variance += mean.sigma * mean.sigma;
  }
  return gain > kConfirmed * std::sqrt(variance);
}

/// The parameters that move edges.
Free movable(const std::vector<EdgeProfile>& profiles) {
  const Matrix bound = edge_score(profiles, Vector::Zero(), kCoarsestEdgeWidth).bound;
  Free free{};
  for (int k = 0; k < 9; ++k) {
    free[static_cast<std::size_t>(k)] = bound(k, k) > kLeastCurvature * bound.diagonal().maxCoeff();
  }
  double flow2 = 0;
  for (const EdgeProfile& profile : profiles) flow2 += profile.J.col(kCamDelay).squaredNorm();
  for (int k = kCamTranslation; k < kCamTranslation + 3; ++k) free[std::size_t(k)] = false;
  free[kCamDelay] = flow2 > kMinFlow * kMinFlow * static_cast<double>(profiles.size());
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
      free[kCamDelay] = false;
      outcome = try_estimate(profiles, free, found);
    }
    const bool is_found = outcome == Outcome::kFound;
    if (is_found && (!found.off_by_a_pixel() || halves_confirm(profiles, free))) return found;
  }
  estimate.disagrees = estimate.frames >= kMinFramesJudged && edges_disagree(profiles);
  return estimate;
}

}  // namespace fovea
