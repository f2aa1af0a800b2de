#include "fovea/geometry/plane_moments.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "fovea/core/random.h"

namespace fovea::plane_moments_test {

Eigen::Vector3f random_vector(Random& random) {
  return {float(random.normal()), float(random.normal()), float(random.normal())};
}

/// Of points scattered by these deviations along turned axes.
Eigen::Matrix3f random_covariance(Random& random, const Eigen::Vector3f& deviations) {
  const Eigen::Quaternionf turn(
      Eigen::AngleAxisf(float(random.uniform(0, 6)), random_vector(random).normalized()));
  PlaneMoments moments;
  for (int i = 0; i < 40; ++i) {
    moments.add(turn * random_vector(random).cwiseProduct(deviations));
  }
  return moments.covariance();
}

TEST(PlaneMoments, DirectionsAreTheEigenvectorsOfLeastVariance) {
  Random random(3);
  for (int round = 0; round < 200; ++round) {
    SymmetricLanes lanes;
    std::array<Eigen::Matrix3f, kLanes> covariance;
    for (int lane = 0; lane < kLanes; ++lane) {
      const float size = float(random.uniform(0.01, 10));
      covariance[std::size_t(lane)] = random_covariance(
          random, size * Eigen::Vector3f(1, float(random.uniform(0.3, 1)), 0.05f));
      lanes.put(lane, covariance[std::size_t(lane)]);
    }
    const auto [x, y, z] = directions_of_least_variance(lanes);
    for (int lane = 0; lane < kLanes; ++lane) {
      const Eigen::Vector3f direction(x[lane], y[lane], z[lane]);
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(covariance[std::size_t(lane)]);
      EXPECT_NEAR(direction.norm(), 1, 1e-5f);
      EXPECT_GT(std::abs(direction.dot(solver.eigenvectors().col(0))), 1 - 1e-5f);
      const Eigen::Vector3f alone = direction_of_least_variance(covariance[std::size_t(lane)]);
      EXPECT_EQ(alone, direction) << "a lane does not depend on the others";
    }
  }
}

TEST(PlaneMoments, ALineAndAPointHaveNoDirection) {
  Random random(4);
  const Eigen::Vector3f along = random_vector(random).normalized();
  SymmetricLanes lanes;
  lanes.put(0, Eigen::Matrix3f::Zero());
  lanes.put(1, along * along.transpose());
  lanes.put(2, Eigen::Vector3f(1, 1, 0).asDiagonal());
  const auto [x, y, z] = directions_of_least_variance(lanes);
  for (const int lane : {0, 1, 3, 7}) {
    EXPECT_EQ(Eigen::Vector3f(x[lane], y[lane], z[lane]), Eigen::Vector3f::Zero()) << lane;
  }
  EXPECT_EQ(std::abs(z[2]), 1);
  EXPECT_EQ(direction_of_least_variance(Eigen::Matrix3f::Zero()), Eigen::Vector3f::Zero());
}

}  // namespace fovea::plane_moments_test
