#include "fovea/mapping/calibration/edge_displacement.h"

#include <cmath>

#include "fovea/core/median.h"

namespace fovea {

EdgeDisplacement edge_displacement(const std::vector<EdgeProfile>& profiles,
                                   const CalibrationVector& correction,
                                   const CalibrationMatrix& covariance) {
  std::vector<double> displacements, sigmas;
  for (const EdgeProfile& profile : profiles) {
    const PixelJacobian J =
        profile.J.cast<double>() * calibration_unit().head<kCalibrationSize>().asDiagonal();
    displacements.push_back((J * correction.head<kCalibrationSize>()).norm());
    const auto cov = covariance.topLeftCorner<kCalibrationSize, kCalibrationSize>();
    sigmas.push_back(std::sqrt((J * cov * J.transpose()).trace()));
  }
  return {median_of(std::move(displacements)), median_of(std::move(sigmas))};
}

}  // namespace fovea
