#include "fovea/mapping/calibration/imu_hand_eye.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "fovea/core/median.h"
#include "fovea/geometry/rotation_vector.h"
#include "fovea/mapping/calibration/hand_eye_refinement.h"

namespace fovea {
namespace {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

constexpr double kObservableDelay = 0.004;  // s

/// Turns that can contradict, by registration or by the IMU, rad.
constexpr double kClearTurn = 1 * kDegree;
constexpr TimeNs kNeighborTime = kNsPerSecond / 2;

constexpr double kMostRatio = 1.5;  // of lengths of turns, either way
/// Of clear turns that a fit predicts, medians: ratio of lengths (or its inverse), and error (rad,
/// or relative to the turn).
constexpr double kLeastPredicted = 0.7, kSmallError = 0.8 * kDegree, kSmallRelativeError = 0.3;

/// Whether registration shows a turn that is not an error: a neighbor is similar. Errors of a
/// scan's orientation turn the two neighbors in opposite directions.
bool is_clear_scan_turn(const std::vector<ScanTurn>& turns, std::size_t i) {
  const Vector3& turn = turns[i].rotation_lidar;
  if (turn.norm() < kClearTurn) return false;
  const auto is_similar = [&](std::size_t j) {
    if (j >= turns.size() || std::abs(turns[j].begin - turns[i].begin) > kNeighborTime) {
      return false;
    }
    const Vector3& other = turns[j].rotation_lidar;
    return turn.dot(other) > std::max(turn.squaredNorm(), other.squaredNorm()) / 2;
  };
  return is_similar(i + 1) || (i > 0 && is_similar(i - 1));
}

/// The turns that can contradict, and the median ratio of lengths of IMU and LiDAR.
struct ClearTurns {
  std::vector<bool> is_clear;  ///< for each turn
  bool are_enough = false;
  double ratio = 0;  ///< 0 if they are few
};

ClearTurns find_clear_turns(const std::vector<ScanTurn>& turns,
                            const std::vector<ImuSample>& samples) {
  // Rates in wrong units could turn by more than pi. Scaled rates do not.
  constexpr double kScale = 1.0 / 128;
  const GyroscopeOrientation scaled(samples, kScale);
  ClearTurns clear{std::vector<bool>(turns.size()), false, 0};
  std::vector<double> ratios;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    if (!scaled.covers(turns[i].begin, turns[i].end)) continue;
    const double imu = scaled.turn(turns[i].begin, turns[i].end).norm() / kScale;
    if (imu < kClearTurn && !is_clear_scan_turn(turns, i)) continue;
    clear.is_clear[i] = true;
    ratios.push_back(imu / std::max(turns[i].rotation_lidar.norm(), 1e-6));
  }
  clear.are_enough = ratios.size() >= std::max(kEnoughMovingTurns, turns.size() / 100);
  if (clear.are_enough) clear.ratio = median_of(std::move(ratios));
  return clear;
}

/// Whether a fit is far from the clear turns.
bool contradicts(const std::vector<PredictedTurn>& turns, const ClearTurns& clear) {
  std::vector<double> ratios, lengths, errors;
  for (const PredictedTurn& turn : turns) {
    if (!clear.is_clear[turn.index]) continue;
    // Along the predicted axis, thus most errors of registration do not count.
    const double ratio = turn.scan.dot(turn.predicted) / turn.predicted.squaredNorm();
    ratios.push_back(std::min(ratio, 1 / ratio));
    lengths.push_back(turn.predicted.norm());
    errors.push_back(turn.residual.norm());
  }
  if (ratios.size() < kEnoughMovingTurns) return false;
  const double error = median_of(std::move(errors)), length = median_of(std::move(lengths));
  return median_of(std::move(ratios)) < kLeastPredicted ||
         error > std::max(kSmallError, kSmallRelativeError * length);
}

/// Fills in standard deviations and what is observable. Fixes the least accurate direction of the
/// rotation if the other two are observable. Turns about one axis show two directions, thus one
/// direction alone is none.
void set_observability(ImuHandEye& estimate, const HandEyeInformation& information) {
  const bool is_moving = estimate.moving_turns >= kEnoughMovingTurns;
  Matrix3& directions = estimate.directions;
  directions = information.principal_directions();
  const Eigen::MatrixXd all = information.covariance(directions);
  constexpr int kBias = HandEyeInformation::kBias, kDelay = HandEyeInformation::kDelay;
  estimate.delay_sigma = std::min(estimate.delay_sigma, std::sqrt(all(kDelay, kDelay)));
  estimate.delay_observable = is_moving && estimate.delay_sigma <= kObservableDelay;
  estimate.gyroscope_bias_sigma =
      all.diagonal().segment<3>(kBias).cwiseSqrt().cwiseMin(estimate.gyroscope_bias_sigma);

  Matrix3 covariance = Matrix3::Identity();  // along the directions
  for (int count = 3; count > 0; --count) {
    covariance.topLeftCorner(count, count) =
        information.covariance(directions.leftCols(count)).topLeftCorner(count, count);
    Eigen::Index worst = 0;
    const double variance = covariance.diagonal().head(count).maxCoeff(&worst);
    if (is_moving && count >= 2 && variance <= kMaxMountSigma * kMaxMountSigma) {
      estimate.observable_directions = count;
      break;
    }
    directions.col(worst).swap(directions.col(count - 1));
    covariance.row(count - 1).setZero();
    covariance.col(count - 1).setZero();
    covariance(count - 1, count - 1) = std::min(1.0, variance);
  }
  estimate.direction_sigma = covariance.diagonal().cwiseSqrt();
  estimate.rotation_covariance = directions * covariance * directions.transpose();
}

/// A correction (rad) without its rotation about the unobservable direction. The remaining error of
/// the mount is a rotation about that direction.
Vector3 observable_part(const Vector3& rotation, const ImuHandEye& estimate) {
  if (estimate.observable_directions == 3) return rotation;
  if (estimate.observable_directions == 0) return Vector3::Zero();
  // Splits it into twist * swing. The swing is at right angles to the axis of the twist.
  const Vector3 axis = estimate.directions.col(2);
  const Eigen::Quaterniond q = quaternion_of(rotation);
  const double angle = 2 * std::atan2(q.vec().dot(axis), q.w());
  return rotation_vector(quaternion_of(-angle * axis) * q);
}

}  // namespace

bool ImuHandEye::is_off() const {
  constexpr double kRotation = 0.75 * kDegree, kDelay = 0.007, kSigmas = 5;  // rad, s
  const double sigma = direction_sigma.head(observable_directions).norm();
  return rotation.norm() > std::max(kRotation, kSigmas * sigma) ||
         std::abs(delay) > std::max(kDelay, kSigmas * delay_sigma);
}

ImuHandEye estimate_imu_hand_eye(std::vector<ScanTurn> turns, const std::vector<ImuSample>& samples,
                                 const Eigen::Matrix3d& R_lidar_imu) {
  std::erase_if(turns, [](const ScanTurn& turn) {
    return turn.end <= turn.begin || !turn.rotation_lidar.allFinite();
  });
  std::stable_sort(turns.begin(), turns.end(),
                   [](const ScanTurn& a, const ScanTurn& b) { return a.begin < b.begin; });
  ImuHandEye estimate;
  const ClearTurns clear = find_clear_turns(turns, samples);
  estimate.turn_ratio = clear.ratio;
  if (clear.are_enough && (clear.ratio > kMostRatio || clear.ratio < 1 / kMostRatio)) {
    estimate.agrees = false;
    return estimate;
  }

  const GyroscopeOrientation gyroscope(samples);
  const CoarseHandEye coarse = search_hand_eye(turns, gyroscope);
  const HandEyeRefinement refinement(turns, gyroscope);
  const HandEyeFit fit =
      refinement.solve({coarse.R_lidar_imu, coarse.gyroscope_bias, coarse.delay});

  const std::vector<PredictedTurn> predicted = refinement.predict(fit);
  std::vector<double> residuals;
  for (const PredictedTurn& turn : predicted) {
    residuals.push_back(turn.residual.norm());
    if (is_moving(turn)) ++estimate.moving_turns;
  }
  estimate.turns = predicted.size();
  estimate.residual = median_of(std::move(residuals));
  if (clear.are_enough) {
    estimate.mirrored = coarse.mirrored;
    estimate.agrees = !coarse.mirrored && !contradicts(predicted, clear);
  }
  if (!estimate.agrees) return estimate;

  set_observability(estimate, refinement.information(fit));
  const Vector3 rotation = rotation_vector(Matrix3(fit.R_lidar_imu * R_lidar_imu.transpose()));
  estimate.rotation = observable_part(rotation, estimate);
  estimate.gyroscope_bias = fit.gyroscope_bias;
  if (estimate.delay_observable) estimate.delay = fit.delay;
  return estimate;
}

std::string missing_motion(const ImuHandEye& estimate) {
  if (!estimate.agrees) return "";
  if (estimate.moving_turns < kEnoughMovingTurns)
    return "turn about several axes, faster and slower";
  std::string motion;
  if (estimate.observable_directions == 2) {
    // All turns are about one axis: the mount can rotate about it without a change of the turns.
    Vector3 axis = estimate.directions.col(2);
    Eigen::Index largest = 0;
    axis.cwiseAbs().maxCoeff(&largest);
    if (axis[largest] < 0) axis = -axis;
    axis = (100 * axis).array().round() / 100 + 0.0;  // + 0.0: no negative zeros
    motion = fmt::format("turn about another axis than ({:.2f} {:.2f} {:.2f}) of the LiDAR",
                         axis.x(), axis.y(), axis.z());
  } else if (estimate.observable_directions < 2) {
    motion = "turn about several axes, each way";
  }
  if (estimate.delay_observable) return motion;
  return motion + (motion.empty() ? "" : ", and ") + "turn faster and slower";
}

}  // namespace fovea
