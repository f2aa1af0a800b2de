#include "fovea/mapping/calibration/extrinsic_estimate.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "fovea/core/angle.h"
#include "fovea/mapping/calibration/calibration_limits.h"
#include "fovea/mapping/calibration/coarse_alignment.h"
#include "fovea/mapping/calibration/color_consistency.h"
#include "fovea/mapping/calibration/edge_agreement.h"
#include "fovea/mapping/calibration/edge_displacement.h"
#include "fovea/mapping/calibration/edge_maximum.h"

namespace fovea {
namespace {

using Vector = CalibrationVector;
using Matrix = CalibrationMatrix;

constexpr std::size_t kMinClearEdges = 60;  // with a clear step of the image, about one axis
constexpr std::size_t kMinViews = 5;
// Blur of the compared images in each pass, pixels.
constexpr std::array<double, 4> kBlurs{4, 3, 2, 1.5};
constexpr int kStartPasses = 2, kLaterPasses = 3;
constexpr double kLaterWidth = 2;  // pixels: edges are near after the first pass
// A value above its limit is observable, too, up to this multiple of the limit, if it exceeds this
// number of standard deviations.
constexpr double kUncertain = 3, kClear = 4;
// Standard deviation of the given calibration: rad, m, s. Where the drive shows little, values stay
// near the given ones.
constexpr double kGivenRotation = 5 * kDegree, kGivenTranslation = 0.2, kGivenDelay = 0.1;
constexpr double kGivenShift = 1;  // pixels

/// In calibration_unit()s.
Vector per_parameter(double rotation, double translation, double delay) {
  Vector v = Vector::Constant(kGivenShift);
  v.segment<3>(kCamRotation).setConstant(rotation);
  v.segment<3>(kCamTranslation).setConstant(translation);
  v[kCamDelay] = delay;
  return v.cwiseQuotient(calibration_unit());
}

Vector vector_of(const CameraCorrection& correction) {
  Vector v = Vector::Zero();
  v << correction.rotation, correction.translation, correction.delay, 0, 0;
  return v.cwiseQuotient(calibration_unit());
}

/// Likelihood of a correction before any image is seen.
QuadraticTerm prior_about(const CameraCorrection& correction) {
  const Vector sigma = per_parameter(kGivenRotation, kGivenTranslation, kGivenDelay);
  QuadraticTerm prior;
  prior.curvature.diagonal() = sigma.cwiseAbs2().cwiseInverse();
  prior.gradient = -prior.curvature * vector_of(correction);
  prior.scatter = prior.curvature;
  return prior;
}

/// Weight of a criterion under which its curvature equals its scatter, as that of a likelihood does
/// (composite likelihood; Varin, Reid, Firth 2011). Neighboring edges and points have common
/// errors, so the plain sum claims too much.
double information_weight(const FreeParameters& free, const Matrix& curvature,
                          const Matrix& scatter) {
  const double sum = free_part(free, scatter).trace();
  return sum > 0 ? free_part(free, curvature).trace() / sum : 0;
}

/// Colors and prior, weighted against the edges.
QuadraticTerm evidence_besides_edges(const FreeParameters& free,
                                     const std::vector<EdgeProfile>& profiles,
                                     const QuadraticTerm& colors, const QuadraticTerm& prior) {
  FreeParameters shifts{};
  shifts[kShiftAlongRing] = shifts[kShiftBetweenRings] = true;
  const Vector x = maximize_edge_score(profiles, shifts, prior, kLaterWidth);
  const EdgeScore edges = edge_score(profiles, x, kFinestEdgeWidth);
  const double weight_edges =
      information_weight(free, edges.curvature, edge_scatter(profiles, free, x));
  if (!(weight_edges > 0)) return prior;
  const double weight_colors = information_weight(free, colors.curvature, colors.scatter);
  QuadraticTerm sum = prior.scaled(1 / weight_edges);
  sum += colors.scaled(weight_colors / weight_edges);
  return sum;
}

/// Covariance by a pattern of errors that all edges share, at its worst for each parameter. It does
/// not shrink with the number of edges.
Matrix systematic_covariance(const FreeParameters& free, const std::vector<EdgeProfile>& profiles) {
  Matrix mean = Matrix::Zero();
  for (const EdgeProfile& profile : profiles) {
    const Vector J = profile.J_along.cast<double>().cwiseProduct(calibration_unit());
    mean += J * J.transpose() / double(profiles.size());
  }
  const Vector given = per_parameter(kGivenRotation, kGivenTranslation, kGivenDelay);
  mean.diagonal() += kSystematicError * kSystematicError * given.cwiseAbs2().cwiseInverse();
  return kSystematicError * kSystematicError *
         free_part(free, Matrix(decoupled(free, mean).inverse()));
}

/// Whether both halves of the frames show edges at the expected places. A maximum from clutter in
/// one half is none in the other.
bool halves_stand_out(const std::vector<EdgeProfile>& profiles) {
  const auto [first, second] = halves_of(profiles);
  return edges_stand_out(first) && edges_stand_out(second);
}

/// Estimates one camera. Parameters that turn out not to be observable are fixed one by one.
class Estimator {
 public:
  Estimator(const std::vector<CalibrationView>& views, const Camera& camera,
            const PoseSpline& T_local_lidar)
      : views_(views), camera_(camera), T_local_lidar_(T_local_lidar) {
    free_.fill(true);
  }
  CalibrationEstimate run();

 private:
  std::vector<EdgeProfile> profiles(const CameraCorrection& correction) const {
    return profiles_of_views(views_, corrected(camera_, correction), T_local_lidar_);
  }
  QuadraticTerm colors(const CameraCorrection& correction, double blur) const {
    return color_consistency(views_, corrected(camera_, correction), T_local_lidar_, blur).term;
  }
  std::optional<CameraCorrection> best_start() const;
  CameraCorrection by_edges(CameraCorrection correction) const;
  void refine(int passes);
  Matrix covariance(const std::vector<EdgeProfile>& edges) const;
  bool fix_least_observable(const Vector& sigma);

  const std::vector<CalibrationView>& views_;
  const Camera& camera_;
  const PoseSpline& T_local_lidar_;
  FreeParameters free_;
  CameraCorrection correction_;
};

/// The best of several starts, by the contrast of its edges with those of rotated cameras. Empty if
/// there are too few edges, or if the images do not show them clearly.
std::optional<CameraCorrection> Estimator::best_start() const {
  std::vector<CameraCorrection> starts = coarse_corrections(views_, camera_, T_local_lidar_);
  starts.emplace_back();
  std::optional<CameraCorrection> best;
  double best_contrast = 0;
  for (const CameraCorrection& start : starts) {
    const CameraCorrection correction = by_edges(start);
    const std::vector<EdgeProfile> edges = profiles(correction);
    if (edges.size() < kMinEdges) continue;
    const EdgeMean pitch = edge_contrast(edges, 0), yaw = edge_contrast(edges, 1);
    if (std::max(pitch.edges, yaw.edges) < kMinClearEdges) continue;
    const double contrast = pitch.mean + yaw.mean;
    if (best && contrast <= best_contrast) continue;
    best = correction;
    best_contrast = contrast;
  }
  return best;
}

CameraCorrection Estimator::by_edges(CameraCorrection correction) const {
  for (int pass = 0; pass < kStartPasses; ++pass) {
    const std::vector<EdgeProfile> edges = profiles(correction);
    if (edges.size() < kMinEdges) break;
    const QuadraticTerm evidence =
        evidence_besides_edges(free_, edges, {}, prior_about(correction));
    const Vector x = maximize_edge_score(edges, free_, evidence);
    correction = joined(correction, correction_of(x));
  }
  return correction;
}

/// Passes over edges and colors, each from the result of the last. The last passes have the finest
/// images.
void Estimator::refine(int passes) {
  for (std::size_t pass = kBlurs.size() - std::size_t(passes); pass < kBlurs.size(); ++pass) {
    correction_ = correction_of(free_part(free_, vector_of(correction_)));
    const std::vector<EdgeProfile> edges = profiles(correction_);
    const QuadraticTerm evidence = evidence_besides_edges(
        free_, edges, colors(correction_, kBlurs[pass]), prior_about(correction_));
    const Vector x = maximize_edge_score(edges, free_, evidence, kLaterWidth);
    correction_ = joined(correction_, correction_of(x));
  }
  correction_ = correction_of(free_part(free_, vector_of(correction_)));
}

/// Covariance of the estimate, in calibration_unit()s.
Matrix Estimator::covariance(const std::vector<EdgeProfile>& edges) const {
  const QuadraticTerm evidence = evidence_besides_edges(
      free_, edges, colors(correction_, kBlurs.back()), prior_about(correction_));
  const Vector x = maximize_edge_score(edges, free_, evidence, kLaterWidth);
  for (double width = kFinestEdgeWidth; width <= kLaterWidth; width *= 2) {
    const Matrix curvature =
        decoupled(free_, Matrix(edge_score(edges, x, width).curvature + evidence.curvature));
    if (!is_positive_definite(curvature)) continue;  // the score of few edges is ragged
    const Matrix inverse = curvature.inverse();
    const Matrix scatter =
        edge_scatter(edges, free_, x, width) + free_part(free_, evidence.scatter);
    return inverse * scatter * inverse + systematic_covariance(free_, edges);
  }
  return Matrix::Constant(std::numeric_limits<double>::infinity());  // no maximum
}

/// Fixes the parameter that is the farthest from observable. False if all are observable. A
/// translation comes before a rotation: where the two look alike, its error matters less.
bool Estimator::fix_least_observable(const Vector& sigma) {
  const Vector value = vector_of(correction_).cwiseAbs();
  Vector ratio =
      sigma.cwiseQuotient(per_parameter(kMaxRotationSigma, kMaxTranslationSigma, kMaxDelaySigma));
  // A large correction is worth more than the given value, also if it is less certain.
  for (int k = 0; k < kCalibrationSize; ++k) {
    if (ratio[k] <= kUncertain && value[k] > kClear * sigma[k]) ratio[k] = 0;
  }
  const auto worst_of = [&](int begin, int end) {
    int worst = -1;
    for (int k = begin; k < end; ++k) {
      if (!free_[std::size_t(k)] || ratio[k] <= 1) continue;
      if (worst < 0 || ratio[k] > ratio[worst]) worst = k;
    }
    return worst;
  };
  int worst = worst_of(kCamTranslation, kCalibrationSize);
  // At a steady speed a shift forward looks like a delay, whose error matters more.
  constexpr int kForward = kCamTranslation + 2;
  if (worst == kCamDelay && free_[kForward] && ratio[kForward] > 1) worst = kForward;
  if (worst < 0) worst = worst_of(kCamRotation, kCamTranslation);
  if (worst < 0) return false;
  free_[std::size_t(worst)] = false;
  return true;
}

CalibrationEstimate Estimator::run() {
  CalibrationEstimate estimate;
  estimate.frames = int(views_.size());
  const auto start = views_.size() < kMinViews ? std::nullopt : best_start();
  if (!start) {
    estimate.edges = profiles({}).size();
    return estimate;
  }
  correction_ = *start;
  refine(int(kBlurs.size()));
  std::vector<EdgeProfile> edges = profiles(correction_);
  Matrix cov = covariance(edges);
  while (fix_least_observable(cov.diagonal().cwiseMax(0).cwiseSqrt())) {
    refine(kLaterPasses);
    edges = profiles(correction_);
    cov = covariance(edges);
  }
  estimate.edges = edges.size();
  estimate.disagrees = edges.size() >= kMinEdges && edges_disagree(edges);
  if (estimate.disagrees || edges.size() < kMinEdges || !halves_stand_out(edges)) {
    return estimate;
  }
  estimate.correction = correction_;
  estimate.sigma = correction_of(cov.diagonal().cwiseMax(0).cwiseSqrt());
  std::copy_n(free_.begin(), int(kCalibrationSize), estimate.observable.begin());
  const EdgeDisplacement displacement = edge_displacement(edges, vector_of(correction_), cov);
  estimate.pixels = displacement.pixels;
  estimate.pixels_sigma = displacement.sigma;
  return estimate;
}

}  // namespace

CalibrationEstimate estimate_extrinsics(const std::vector<CalibrationView>& views,
                                        const Camera& camera, const PoseSpline& T_local_lidar) {
  return Estimator(views, camera, T_local_lidar).run();
}

}  // namespace fovea
