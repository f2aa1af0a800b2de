#include "fovea/mapping/registration/pose_covariance.h"

#include <Eigen/Eigenvalues>

namespace fovea {
namespace {

constexpr double kPairsAlike = 80;

}  // namespace

Eigen::Matrix<double, 6, 6> pose_covariance(const RegistrationResult& registration, double open) {
  Twist unit = Twist::Ones();  // turns beside shifts, as degeneracy is judged
  unit.head<3>().setConstant(1 / kRotationArm);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(
      unit.asDiagonal() * registration.information * unit.asDiagonal());
  Twist variances = kPairsAlike * solver.eigenvalues().cwiseInverse();
  for (int i = 0; i < registration.degenerate_directions; ++i) variances[i] = open * open;
  return unit.asDiagonal() * solver.eigenvectors() * variances.asDiagonal() *
         solver.eigenvectors().transpose() * unit.asDiagonal();
}

}  // namespace fovea
