#include "fovea/mapping/calibration/hand_eye_search.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fovea/core/median.h"
#include "fovea/core/parallel.h"

namespace fovea {
namespace {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

constexpr int kDelays = 50;  // steps to either side
constexpr double kDelayStep = 0.005;
constexpr int kRounds = 3;                     // of robust weights
constexpr std::size_t kMostTurns = 3000;       // more are not needed here
constexpr double kUsualError = 0.3 * kDegree;  // of a turn, rad
constexpr double kUsualBias = 1 * kDegree;     // rad/s
constexpr double kMirroredGain = 0.7;          // costs: a reflection relative to a rotation

/// The same turn by registration and by the gyroscope: rotation vectors (rad).
struct TurnPair {
  Vector3 lidar, imu;
  double duration = 0;  ///< s
};

/// lidar = R * (imu - bias * duration). R is orthogonal, with a determinant of 1 or -1.
struct Alignment {
  Matrix3 R = Matrix3::Identity();
  Vector3 bias = Vector3::Zero();
  double cost = std::numeric_limits<double>::infinity();

  Vector3 residual(const TurnPair& pair) const {
    return pair.lidar - R * (pair.imu - bias * pair.duration);
  }
};

std::vector<TurnPair> pair_turns(const std::vector<ScanTurn>& turns,
                                 const GyroscopeOrientation& gyroscope, double delay) {
  const std::size_t stride = turns.size() / kMostTurns + 1;
  std::vector<TurnPair> pairs;
  for (std::size_t i = 0; i < turns.size(); i += stride) {
    const StampInterval stamps = imu_stamps(turns[i], delay);
    if (!gyroscope.covers(stamps.begin, stamps.end)) continue;
    pairs.push_back({turns[i].rotation_lidar, gyroscope.turn(stamps.begin, stamps.end),
                     seconds(stamps.end - stamps.begin)});
  }
  return pairs;
}

/// Weighted least squares of an orthogonal matrix and a bias, with a prior of the bias, in closed
/// form (Kabsch 1976). Elimination of the bias centers the products of the turns.
Alignment solve_alignment(const std::vector<TurnPair>& pairs, const std::vector<double>& weights,
                          double determinant) {
  Matrix3 products = Matrix3::Zero();
  Vector3 lidar = Vector3::Zero(), imu = Vector3::Zero();
  double durations = kUsualError * kUsualError / (kUsualBias * kUsualBias);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const TurnPair& pair = pairs[i];
    products += weights[i] * pair.lidar * pair.imu.transpose();
    lidar += weights[i] * pair.duration * pair.lidar;
    imu += weights[i] * pair.duration * pair.imu;
    durations += weights[i] * pair.duration * pair.duration;
  }
  products -= lidar * imu.transpose() / durations;
  const Eigen::JacobiSVD<Matrix3> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() * determinant;
  Alignment alignment;
  alignment.R =
      svd.matrixU() * Vector3(1, 1, sign < 0 ? -1 : 1).asDiagonal() * svd.matrixV().transpose();
  alignment.bias = (imu - alignment.R.transpose() * lidar) / durations;
  return alignment;
}

/// A robust alignment. The lengths of the turns, which need no alignment, give the first weights.
Alignment align(const std::vector<TurnPair>& pairs, double determinant) {
  std::vector<double> lengths(pairs.size()), weights(pairs.size());
  const auto set_weights = [&] {
    const double sigma = robust_sigma(lengths);
    for (std::size_t i = 0; i < pairs.size(); ++i) weights[i] = inlier_weight(lengths[i], sigma);
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    lengths[i] = std::abs(pairs[i].lidar.norm() - pairs[i].imu.norm());
  }
  Alignment alignment;
  for (int round = 0; round < kRounds; ++round) {
    set_weights();
    alignment = solve_alignment(pairs, weights, determinant);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      lengths[i] = alignment.residual(pairs[i]).norm();
    }
  }
  alignment.cost = 0;
  for (const double length : lengths) {  // Cauchy's loss: outliers count about the same
    alignment.cost += std::log1p(length * length / (kUsualError * kUsualError));
  }
  alignment.cost /= double(pairs.size());
  return alignment;
}

}  // namespace

StampInterval imu_stamps(const ScanTurn& turn, double delay) {
  const TimeNs shift = from_seconds(delay);
  return {turn.begin - shift, turn.end - shift};
}

double robust_sigma(std::vector<double> lengths) {
  constexpr double kMedianLength = 1.538;  // of three standard normal components
  constexpr double kLeastSigma = 1e-4 * kDegree;
  return std::max(kLeastSigma, median_of(std::move(lengths)) / kMedianLength);
}

double inlier_weight(double length, double sigma) {
  constexpr double kInlierSigmas = 3.5;
  const double ratio = length / (kInlierSigmas * sigma);
  return ratio < 1 ? 1 : 1 / (ratio * ratio * ratio);
}

CoarseHandEye search_hand_eye(const std::vector<ScanTurn>& turns,
                              const GyroscopeOrientation& gyroscope) {
  constexpr std::size_t kCount = 2 * kDelays + 1;
  std::vector<Alignment> rotations(kCount), reflections(kCount);
  std::vector<std::size_t> sizes(kCount);
  const auto delay_of = [](std::size_t k) { return (double(k) - kDelays) * kDelayStep; };
  parallel_for(kCount, 1, [&](std::size_t k) {
    const std::vector<TurnPair> pairs = pair_turns(turns, gyroscope, delay_of(k));
    sizes[k] = pairs.size();
    if (pairs.empty()) return;
    rotations[k] = align(pairs, 1);
    reflections[k] = align(pairs, -1);
  });
  const std::size_t most = *std::max_element(sizes.begin(), sizes.end());
  Alignment best;
  double best_reflection = std::numeric_limits<double>::infinity();
  CoarseHandEye coarse;
  for (std::size_t k = 0; k < kCount; ++k) {
    if (2 * sizes[k] < most) continue;  // few turns fit by chance
    best_reflection = std::min(best_reflection, reflections[k].cost);
    if (rotations[k].cost >= best.cost) continue;
    best = rotations[k];
    coarse.delay = delay_of(k);
  }
  coarse.R_lidar_imu = best.R;
  coarse.gyroscope_bias = best.bias;
  coarse.mirrored = best_reflection < kMirroredGain * best.cost;
  return coarse;
}

}  // namespace fovea
