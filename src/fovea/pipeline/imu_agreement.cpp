#include "fovea/pipeline/imu_agreement.h"

#include <fmt/format.h>

#include <Eigen/SVD>

#include "fovea/core/angle.h"
#include "fovea/core/median.h"
#include "fovea/geometry/rotation_vector.h"

namespace fovea {
namespace {

constexpr double kLeastTurn = 0.5 * kDegree;  // of a frame that counts, rad
constexpr double kMemory = 0.98;              // weight of a frame relative to the one after it
constexpr double kEnough = 12;                // frames
constexpr std::size_t kKept = 50;             // turns

constexpr int kGrossFrames = 3;  // with a gross bias, in a row: one may be registered wrongly

/// Mean errors of a turn, rad: an IMU that is proven, and one that is contradicted.
constexpr double kSmallError = 0.3 * kDegree, kLargeError = 0.6 * kDegree;

}  // namespace

void ImuAgreement::add(const RigidMotion& registered, const RigidMotion& by_imu,
                       const RigidMotion& by_velocity) {
  const Turns turns{rotation_vector(registered.linear()), rotation_vector(by_imu.linear())};
  if (std::max(turns.scans.norm(), turns.imu.norm()) < kLeastTurn) return;
  const auto error = [&](const RigidMotion& guess) {
    return rotation_angle(guess.linear().transpose() * registered.linear());
  };
  frames_ = kMemory * frames_ + 1;
  error_imu_ = kMemory * error_imu_ + error(by_imu);
  error_velocity_ = kMemory * error_velocity_ + error(by_velocity);
  if (turns_.size() == kKept) turns_.erase(turns_.begin());
  turns_.push_back(turns);
}

void ImuAgreement::add_bias(const Eigen::Vector3d& rate_bias) {
  constexpr double kMostBias = 20 * kDegree;  // rad/s: twice that of cheap gyroscopes
  if (gross_biases_ >= kGrossFrames) return;
  gross_biases_ = rate_bias.norm() < kMostBias ? 0 : gross_biases_ + 1;
}

bool ImuAgreement::is_proven() const {
  return frames_ > kEnough && error_imu_ < std::max(kSmallError * frames_, error_velocity_ / 2);
}

bool ImuAgreement::is_contradicted() const {
  return gross_biases_ >= kGrossFrames ||
         (frames_ > kEnough && error_imu_ > std::max(kLargeError * frames_, 1.5 * error_velocity_));
}

std::string ImuAgreement::likely_fault() const {
  if (turns_.empty()) return "its rates have a bias that no gyroscope has";
  std::vector<double> ratios;
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (const Turns& turns : turns_) {
    if (turns.scans.norm() > kLeastTurn / 2) {
      ratios.push_back(turns.imu.norm() / turns.scans.norm());
    }
    products += turns.scans.normalized() * turns.imu.normalized().transpose();
  }
  const double ratio = median_of(std::move(ratios));
  constexpr double kDegreesLeast = 20;
  if (ratio > kDegreesLeast) return "its rates are likely degrees (imu.rate_unit = \"deg/s\")";
  if (ratio > 0 && ratio < 1 / kDegreesLeast) return "its rates are far too small";
  // The best rotation from the IMU's turns to those of the scans (Kabsch 1976).
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Matrix3d mirrored = svd.matrixU() * svd.matrixV().transpose();
  const Eigen::Vector3d agreement = svd.singularValues() / double(turns_.size());
  constexpr double kSeen = 0.05;  // share of turns about a third axis
  if (mirrored.determinant() < 0 && agreement[2] > kSeen) return "an axis is likely flipped";
  const Eigen::Vector3d signs(1, 1, mirrored.determinant());
  const Eigen::Matrix3d R = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  return fmt::format(
      "its mount (imu.T_lidar_imu) is likely off by {:.0f} degrees, an axis flipped, or its clock "
      "another one",
      rotation_angle(R) / kDegree);
}

}  // namespace fovea
