// Robust least squares of the mount, the bias and the delay of an IMU on a LiDAR.
#pragma once

#include <vector>

#include "fovea/mapping/calibration/hand_eye_search.h"

namespace fovea {

/// Mount, bias and delay that fit the turns.
struct HandEyeFit {
  Eigen::Matrix3d R_lidar_imu = Eigen::Matrix3d::Identity();
  Eigen::Vector3d gyroscope_bias = Eigen::Vector3d::Zero();  ///< rad/s, in the axes of the IMU
  double delay = 0;  ///< s: the right time of a sample is its stamp + delay
};

/// A turn by registration and the same turn as a fit predicts it from the gyroscope, both as
/// rotation vectors in the axes of the LiDAR (rad).
struct PredictedTurn {
  std::size_t index = 0;  ///< of the scan turn
  Eigen::Vector3d scan = Eigen::Vector3d::Zero(), predicted = Eigen::Vector3d::Zero();
  /// Rotation from the predicted turn to that by registration.
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
};

/// What the turns determine about the errors of a fit: rotation (a small rotation on the left of
/// the mount, about the axes of the LiDAR), bias, delay. Units: 1 rad, 1 deg/s, 0.1 s; the standard
/// deviations of a weak prior.
class HandEyeInformation {
 public:
  enum { kRotation = 0, kBias = 3, kDelay = 6, kSize = 7 };
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  /// @param fit          products of the Jacobian, with the weights of the fit
  /// @param independent  products of two Jacobians whose noise is independent: noise that looks
  ///                     like motion adds no information
  /// @param scatter      covariance of the gradient
  HandEyeInformation(const Matrix& fit, const Matrix& independent, const Matrix& scatter)
      : fit_(fit), independent_(independent), scatter_(scatter) {}

  /// Orthonormal directions of the rotation (columns), most accurate first. A fit whose rotation is
  /// fixed along some of them stays the same along the others.
  Eigen::Matrix3d principal_directions() const;

  /// Covariance of a fit (rad, rad/s, s) of rotations along some directions (orthonormal columns),
  /// bias and delay.
  Eigen::MatrixXd covariance(const Eigen::Matrix3Xd& directions) const;

 private:
  Matrix fit_, independent_, scatter_;
};

class HandEyeRefinement {
 public:
  /// Both arguments must outlive this object.
  /// @param turns  in order of time
  HandEyeRefinement(const std::vector<ScanTurn>& turns, const GyroscopeOrientation& gyroscope)
      : turns_(&turns), gyroscope_(&gyroscope) {}

  /// Gauss-Newton with robust weights.
  HandEyeFit solve(const HandEyeFit& start) const;

  HandEyeInformation information(const HandEyeFit& fit) const;

  /// The turns that the samples of the IMU cover, with 50 ms before and after them.
  std::vector<PredictedTurn> predict(const HandEyeFit& fit) const;

 private:
  struct Term;
  std::vector<Term> linearize(const HandEyeFit& fit) const;
  /// Standard deviation of each component of the residuals (rad): of moving turns if there are ten.
  static double sigma_of(const std::vector<Term>& terms);

  const std::vector<ScanTurn>* turns_;
  const GyroscopeOrientation* gyroscope_;
};

/// Enough of moving turns for statistics of them.
inline constexpr std::size_t kEnoughMovingTurns = 10;

/// Whether a turn is so large that it contributes to the mount: over 0.2 degrees.
bool is_moving(const PredictedTurn& turn);

}  // namespace fovea
