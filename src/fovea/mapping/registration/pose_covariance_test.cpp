#include "fovea/mapping/registration/pose_covariance.h"

#include <gtest/gtest.h>

namespace fovea::pose_covariance_test {

TEST(PoseCovariance, IsTheInverseOfTheInformationOfFewerPairs) {
  RegistrationResult result;
  Twist information;
  information << 1e6, 2e6, 3e6, 1e4, 2e4, 3e4;
  result.information = information.asDiagonal();
  const Twist variances = pose_covariance(result, 0.2).diagonal();
  // 80 pairs count as one.
  EXPECT_NEAR(variances[0], 80 / 1e6, 1e-12);
  EXPECT_NEAR(variances[2], 80 / 3e6, 1e-12);
  EXPECT_NEAR(variances[3], 80 / 1e4, 1e-12);
  EXPECT_NEAR(variances[5], 80 / 3e4, 1e-12);
}

TEST(PoseCovariance, AnOpenDirectionIsKnownFromPredictionAlone) {
  RegistrationResult result;
  Twist information = Twist::Constant(1e6);
  information[3] = 1e-3;  // along a corridor
  result.information = information.asDiagonal();
  result.degenerate_directions = 1;
  const Eigen::Matrix<double, 6, 6> covariance = pose_covariance(result, 0.2);
  EXPECT_NEAR(covariance(3, 3), 0.04, 1e-9);
  EXPECT_NEAR(covariance(4, 4), 80 / 1e6, 1e-9);
}

}  // namespace fovea::pose_covariance_test
