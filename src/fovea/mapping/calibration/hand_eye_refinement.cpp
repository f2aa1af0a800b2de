#include "fovea/mapping/calibration/hand_eye_refinement.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>

#include "fovea/geometry/rotation_vector.h"

namespace fovea {
namespace {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
using Information = HandEyeInformation;
using Vector7 = Eigen::Matrix<double, Information::kSize, 1>;
using Matrix7 = Information::Matrix;
using Jacobian = Eigen::Matrix<double, 3, Information::kSize>;

constexpr int kRotation = Information::kRotation, kBias = Information::kBias;
constexpr int kDelay = Information::kDelay;
constexpr int kIterations = 30;
constexpr double kMovingTurn = 0.2 * kDegree;

/// Each rate is a mean over this time (s), which reduces the noise of the samples.
constexpr double kRateWindow = 0.05;

/// Units of HandEyeInformation, in rad, rad/s and s.
Vector7 units() {
  Vector7 units;
  units << Vector3::Constant(1), Vector3::Constant(kDegree), 0.1;
  return units;
}

/// Long-run covariance of a sum of gradients with the kernel of Parzen (Andrews 1991). Errors of
/// up to 15 neighbors are correlated: that of one scan's orientation enters two turns with opposite
/// signs.
Matrix7 long_run_covariance(const std::vector<Vector7>& gradients) {
  constexpr std::size_t kMostLags = 15;
  const std::size_t lags = std::min(kMostLags, gradients.size() / 10);
  Matrix7 covariance = Matrix7::Zero();
  for (std::size_t lag = 0; lag <= lags; ++lag) {
    const double x = double(lag) / double(lags + 1);
    const double kernel = x < 0.5 ? 1 - 6 * x * x * (1 - x) : 2 * (1 - x) * (1 - x) * (1 - x);
    Matrix7 products = Matrix7::Zero();
    for (std::size_t i = lag; i < gradients.size(); ++i) {
      products.noalias() += gradients[i] * gradients[i - lag].transpose();
    }
    covariance += kernel * (lag == 0 ? products : Matrix7(products + products.transpose()));
  }
  return covariance;
}

/// exp(w + d) is about exp(left_jacobian(w) * d) * exp(w).
Matrix3 left_jacobian(const Vector3& w) {
  Matrix3 jacobian;
  for (int i = 0; i < 3; ++i) {
    Twist twist;
    twist << w, Vector3::Unit(i);
    jacobian.col(i) = exp_se3(twist).translation();
  }
  return jacobian;
}

}  // namespace

/// A turn under a fit, with derivatives by the errors of the fit in units().
struct HandEyeRefinement::Term {
  PredictedTurn turn;
  Jacobian jacobian;
  /// Two more Jacobians whose noise is independent. One has the gyroscope's turn and the rates
  /// before the stamps, the other has the turn by registration and the rates after the stamps.
  Jacobian before, after;
};

std::vector<HandEyeRefinement::Term> HandEyeRefinement::linearize(const HandEyeFit& fit) const {
  const Matrix3& R = fit.R_lidar_imu;
  const TimeNs window = from_seconds(kRateWindow);
  const auto rate = [&](TimeNs begin, TimeNs end) -> Vector3 {
    return gyroscope_->turn(begin, end) / kRateWindow - fit.gyroscope_bias;
  };
  std::vector<Term> terms;
  terms.reserve(turns_->size());
  for (std::size_t i = 0; i < turns_->size(); ++i) {
    const auto [begin, end] = imu_stamps((*turns_)[i], fit.delay);
    if (!gyroscope_->covers(begin - window, end + window)) continue;
    const Vector3 measured = gyroscope_->turn(begin, end);
    // The bias is nearly constant in the axes of the IMU, as if it turned at a constant rate.
    const Matrix3 by_bias = seconds(end - begin) * left_jacobian(measured);
    const Matrix3 turn_imu = rotation_of(-by_bias * fit.gyroscope_bias) * rotation_of(measured);
    const Matrix3 turn_lidar = R * turn_imu * R.transpose();
    const Matrix3 turn_scan = rotation_of((*turns_)[i].rotation_lidar);
    const Vector3 by_delay_before =
        R * (rate(begin - window, begin) - turn_imu * rate(end - window, end));
    const Vector3 by_delay_after =
        R * (rate(begin, begin + window) - turn_imu * rate(end, end + window));

    Term term;
    term.turn = {i, (*turns_)[i].rotation_lidar, rotation_vector(turn_lidar),
                 rotation_vector(turn_scan * turn_lidar.transpose())};
    term.jacobian << Matrix3::Identity() - turn_lidar, -R * by_bias,
        (by_delay_before + by_delay_after) / 2;
    term.before = term.after = term.jacobian;
    term.before.col(kDelay) = by_delay_before;
    term.after.col(kDelay) = by_delay_after;
    term.after.middleCols<3>(kRotation) = Matrix3::Identity() - turn_scan;
    for (Jacobian* jacobian : {&term.jacobian, &term.before, &term.after}) {
      *jacobian = *jacobian * units().asDiagonal();
    }
    terms.push_back(term);
  }
  return terms;
}

double HandEyeRefinement::sigma_of(const std::vector<Term>& terms) {
  std::vector<double> all, moving;
  for (const Term& term : terms) {
    all.push_back(term.turn.residual.norm());
    if (is_moving(term.turn)) moving.push_back(term.turn.residual.norm());
  }
  return robust_sigma(moving.size() >= kEnoughMovingTurns ? moving : all);
}

std::vector<PredictedTurn> HandEyeRefinement::predict(const HandEyeFit& fit) const {
  std::vector<PredictedTurn> turns;
  for (const Term& term : linearize(fit)) turns.push_back(term.turn);
  return turns;
}

HandEyeFit HandEyeRefinement::solve(const HandEyeFit& start) const {
  HandEyeFit fit = start;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const std::vector<Term> terms = linearize(fit);
    const double sigma = sigma_of(terms);
    // The prior: it draws the bias and the delay to zero, and only dampens the rotation.
    Matrix7 information = Matrix7::Identity();
    Vector7 right_side = Vector7::Zero();
    right_side.segment<3>(kBias) = -fit.gyroscope_bias / units()[kBias];
    right_side[kDelay] = -fit.delay / units()[kDelay];
    for (const Term& term : terms) {
      const double weight = inlier_weight(term.turn.residual.norm(), sigma) / (sigma * sigma);
      information.noalias() += weight * term.jacobian.transpose() * term.jacobian;
      right_side.noalias() += weight * term.jacobian.transpose() * term.turn.residual;
    }
    const Vector7 step = information.ldlt().solve(right_side);
    fit.R_lidar_imu = rotation_of(step.segment<3>(kRotation)) * fit.R_lidar_imu;
    fit.gyroscope_bias += units()[kBias] * step.segment<3>(kBias);
    fit.delay += units()[kDelay] * step[kDelay];
    constexpr double kSmallStep = 1e-7;
    if (step.norm() < kSmallStep) break;
  }
  fit.R_lidar_imu = nearest_rotation(fit.R_lidar_imu);
  return fit;
}

HandEyeInformation HandEyeRefinement::information(const HandEyeFit& fit) const {
  const std::vector<Term> terms = linearize(fit);
  const double sigma = sigma_of(terms);
  Matrix7 by_fit = Matrix7::Zero(), independent = Matrix7::Zero();
  std::vector<Vector7> gradients;
  for (const Term& term : terms) {
    const double weight = inlier_weight(term.turn.residual.norm(), sigma) / (sigma * sigma);
    by_fit += weight * term.jacobian.transpose() * term.jacobian;
    independent += weight * term.before.transpose() * term.after;
    gradients.push_back(weight * term.jacobian.transpose() * term.turn.residual);
  }
  return {by_fit, (independent + independent.transpose()) / 2, long_run_covariance(gradients)};
}

Matrix3 HandEyeInformation::principal_directions() const {
  // The information of the rotation, with unknown bias and delay (Schur complement).
  const Matrix7 information = fit_ + Matrix7::Identity();
  const Eigen::Matrix<double, 3, 4> mixed = information.topRightCorner<3, 4>();
  const Eigen::Matrix4d others = information.bottomRightCorner<4, 4>();
  const Matrix3 rotation =
      information.topLeftCorner<3, 3>() - mixed * others.ldlt().solve(mixed.transpose());
  return Eigen::SelfAdjointEigenSolver<Matrix3>(-rotation).eigenvectors();
}

Eigen::MatrixXd HandEyeInformation::covariance(const Eigen::Matrix3Xd& directions) const {
  const Eigen::Index count = directions.cols(), others = kSize - kBias;
  Eigen::MatrixXd basis = Eigen::MatrixXd::Zero(kSize, count + others);
  basis.topLeftCorner(3, count) = directions;
  basis.bottomRightCorner(others, others).setIdentity();
  const Eigen::MatrixXd information = basis.transpose() * independent_ * basis;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information);
  const Eigen::MatrixXd vectors = basis * eigen.eigenvectors();
  Eigen::MatrixXd covariance = vectors.transpose() * (scatter_ + Matrix::Identity()) * vectors;
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    const double inverse = 1 / (eigen.eigenvalues()[i] + 1);
    const bool is_known = eigen.eigenvalues()[i] > 1;
    covariance.row(i) *= is_known ? inverse : 0;
    covariance.col(i) *= is_known ? inverse : 0;
    if (!is_known) covariance(i, i) = 1;  // the variance of the prior
  }
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(count + others);
  scale.tail(others) = units().tail(others);
  const Eigen::MatrixXd scaled = scale.asDiagonal() * eigen.eigenvectors();
  return scaled * covariance * scaled.transpose();
}

bool is_moving(const PredictedTurn& turn) { return turn.predicted.norm() > kMovingTurn; }

}  // namespace fovea
