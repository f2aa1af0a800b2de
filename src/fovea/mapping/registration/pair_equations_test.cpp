// Analytic Jacobians of the factors against central differences.
#include "fovea/mapping/registration/pair_equations.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "fovea/core/random.h"
#include "fovea/mapping/registration/gicp_factor.h"
#include "fovea/mapping/registration/point_to_plane_factor.h"
#include "fovea/mapping/registration/point_to_point_factor.h"

namespace fovea::pair_equations_test {

Eigen::Vector3d random_vector(Random& random, double size) {
  return Eigen::Vector3d(random.uniform(-size, size), random.uniform(-size, size),
                         random.uniform(-size, size));
}

RigidMotion random_pose(Random& random) {
  Twist twist;
  twist.head<3>() = random_vector(random, 1.5);
  twist.tail<3>() = random_vector(random, 5);
  return exp_se3(twist);
}

Eigen::Matrix3d unpack_symmetric(const Symmetric3& s) {
  const Eigen::Matrix<double, 6, 1> d = s.cast<double>();
  Eigen::Matrix3d m;
  m << d[0], d[1], d[2], d[1], d[3], d[4], d[2], d[4], d[5];
  return m;
}

PairEquations equations_at(const Pair& pair, const RigidMotion& T, double robust_width) {
  return accumulate(PairBlocks(std::span(&pair, 1)), T, robust_width);
}

template <class Factor>
class FactorTest : public testing::Test {
 protected:
  /// A pair with the factor's weight, up to a meter apart at T.
  Pair random_pair(const RigidMotion& T) {
    Pair pair;
    pair.source = random_vector(random_, 20).cast<float>();
    pair.target =
        (T * pair.source.cast<double>() + random_vector(random_, 0.5)).template cast<float>();
    const Eigen::Vector3f n = random_vector(random_, 1).normalized().cast<float>();
    const Eigen::Vector3f m = random_vector(random_, 1).normalized().cast<float>();
    pair.information = Factor::information(n, m, RegistrationOptions());
    pair.normal = n;
    pair.target_index = 0;
    return pair;
  }
  Random random_{7};
};

using Factors = testing::Types<GicpFactor, PointToPointFactor, PointToPlaneFactor>;
TYPED_TEST_SUITE(FactorTest, Factors);

TYPED_TEST(FactorTest, GradientIsTheDerivativeOfTheError) {
  for (const double robust_width : {0.0, 0.3}) {
    for (int trial = 0; trial < 20; ++trial) {
      const RigidMotion T = random_pose(this->random_);
      const Pair pair = this->random_pair(T);
      const PairEquations equations = equations_at(pair, T, robust_width);
      for (int i = 0; i < 6; ++i) {
        const double h = i < 3 ? 1e-3 : 1e-2;  // wide, since the error is a float
        const auto change = [&](double step) {
          return equations_at(pair, T * exp_se3(step * Twist::Unit(i)), robust_width).error -
                 equations_at(pair, T * exp_se3(-step * Twist::Unit(i)), robust_width).error;
        };
        const double slope = (8 * change(h) - change(2 * h)) / (12 * h);
        EXPECT_NEAR(2 * equations.b[i], slope, 5e-3 * (1 + std::abs(slope)));
      }
    }
  }
}

TYPED_TEST(FactorTest, HessianIsTheSquareOfTheNumericalJacobian) {
  for (int trial = 0; trial < 20; ++trial) {
    const RigidMotion T = random_pose(this->random_);
    const Pair pair = this->random_pair(T);
    const auto residual = [&](const Twist& step) -> Eigen::Vector3d {
      return T * exp_se3(step) * pair.source.cast<double>() - pair.target.cast<double>();
    };
    constexpr double h = 1e-6;
    Eigen::Matrix<double, 3, 6> J;
    for (int i = 0; i < 6; ++i) {
      J.col(i) = (residual(h * Twist::Unit(i)) - residual(-h * Twist::Unit(i))) / (2 * h);
    }
    const Eigen::Matrix<double, 6, 6> H = J.transpose() * unpack_symmetric(pair.information) * J;
    const PairEquations equations = equations_at(pair, T, 0);
    EXPECT_LT((equations.H - H).norm(), 1e-5 * (1 + H.norm()));
    const Eigen::Matrix<double, 1, 6> slope = pair.normal.cast<double>().transpose() * J;
    EXPECT_LT((equations.H_planes - slope.transpose() * slope).norm(),
              1e-5 * (1 + slope.squaredNorm()));
  }
}

/// Plain version of accumulate(): one pair at a time, in doubles.
PairEquations plain_equations(const std::vector<Pair>& pairs, const RigidMotion& T,
                              double robust_width) {
  PairEquations sum;
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d source = pair.source.cast<double>();
    const Eigen::Vector3d d = T * source - pair.target.cast<double>();
    Eigen::Matrix<double, 3, 6> J;
    const Eigen::Matrix3d R = T.linear();
    for (int i = 0; i < 3; ++i) J.col(i) = R * Eigen::Vector3d::Unit(i).cross(source);
    J.rightCols<3>() = R;
    const Eigen::Matrix3d M = unpack_symmetric(pair.information);
    const double e2 = d.dot(M * d), w2 = robust_width * robust_width, share = w2 / (w2 + e2);
    const Eigen::Matrix<double, 1, 6> slope = pair.normal.cast<double>().transpose() * J;
    sum.H += share * share * J.transpose() * M * J;
    sum.b += share * share * J.transpose() * M * d;
    sum.H_planes += share * share * slope.transpose() * slope;
    sum.error += share * e2;
    sum.squared_distance += d.squaredNorm();
    sum.weight += share * share;
  }
  return sum;
}

TYPED_TEST(FactorTest, VectorizedSumsAreThePlainSums) {
  const RigidMotion T = random_pose(this->random_);
  std::vector<Pair> pairs;
  for (int i = 0; i < 2500; ++i) pairs.push_back(this->random_pair(T));  // the last block has four
  const PairEquations sums = accumulate(PairBlocks(pairs), T, 0.3);
  const PairEquations plain = plain_equations(pairs, T, 0.3);
  EXPECT_LT((sums.H - plain.H).norm(), 1e-5 * plain.H.norm());
  EXPECT_LT((sums.H_planes - plain.H_planes).norm(), 1e-5 * plain.H_planes.norm());
  EXPECT_LT((sums.b - plain.b).norm(), 1e-4 * (1 + plain.b.norm()));
  EXPECT_NEAR(sums.error / plain.error, 1, 1e-5);
  EXPECT_NEAR(sums.squared_distance / plain.squared_distance, 1, 1e-5);
  EXPECT_NEAR(sums.weight / plain.weight, 1, 1e-5);
}

TEST(GicpFactor, InformationIsTheInverseOfTheSummedCovariances) {
  Random random(3);
  RegistrationOptions options;
  for (const double epsilon : {1e-3, 0.1, 1.0}) {
    options.plane_epsilon = epsilon;
    for (int trial = 0; trial < 20; ++trial) {
      const Eigen::Vector3d n = random_vector(random, 1).normalized();
      // Every second pair has parallel normals, a special case of the closed form.
      const Eigen::Vector3d m = trial % 2 == 0 ? n : random_vector(random, 1).normalized();
      const Eigen::Matrix3d sum =
          2 * Eigen::Matrix3d::Identity() - (1 - epsilon) * (n * n.transpose() + m * m.transpose());
      const Eigen::Matrix3d M =
          unpack_symmetric(GicpFactor::information(n.cast<float>(), m.cast<float>(), options));
      EXPECT_LT((M - 2 * epsilon * sum.inverse()).norm(), 1e-3) << "epsilon " << epsilon;
    }
  }
}

TEST(GicpFactor, UnknownNormalMeansAnIsotropicPoint) {
  const RegistrationOptions options;
  const Eigen::Vector3f n = Eigen::Vector3f::UnitX(), unknown = Eigen::Vector3f::Zero();
  const Eigen::Matrix3d M = unpack_symmetric(GicpFactor::information(n, unknown, options));
  const double epsilon = options.plane_epsilon;
  EXPECT_NEAR(M(0, 0), 2 * epsilon / (1 + epsilon), 1e-7);
  EXPECT_NEAR(M(1, 1), epsilon, 1e-7);
}

TEST(PointToPlaneFactor, SlidingInThePlaneCostsNothing) {
  Pair pair{{5, 0, 0}, {5, 0.4f, -0.7f}, {}, {1, 0, 0}, 0};
  pair.information =
      PointToPlaneFactor::information(Eigen::Vector3f::UnitX(), Eigen::Vector3f::Zero(), {});
  EXPECT_DOUBLE_EQ(equations_at(pair, RigidMotion::Identity(), 0).error, 0);
  pair.target.x() = 4.9f;
  EXPECT_NEAR(equations_at(pair, RigidMotion::Identity(), 0).error, 0.01, 1e-6);
}

}  // namespace fovea::pair_equations_test
