#include "fovea/rigid_motion.h"

#include <gtest/gtest.h>

#include <numbers>

#include "fovea/core/random.h"

namespace fovea::rigid_motion_test {

constexpr double kPi = std::numbers::pi;

Eigen::Vector3d random_vector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

TEST(RigidMotion, HatIsTheCrossProduct) {
  const Eigen::Vector3d a(1, -2, 3), b(0.5, 4, -1);
  EXPECT_LT((hat(a) * b - a.cross(b)).norm(), 1e-15);
}

TEST(RigidMotion, ExponentialOfATurnIsAnArc) {
  // A quarter turn to the left at radius 10 m: 10 m ahead, 10 m to the left, heading left.
  Twist twist;
  twist << 0, 0, kPi / 2, 10 * kPi / 2, 0, 0;
  const RigidMotion T = exp_se3(twist);
  EXPECT_LT((T.translation() - Eigen::Vector3d(10, 10, 0)).norm(), 1e-12);
  EXPECT_LT((T.rotation() * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitY()).norm(), 1e-12);
}

TEST(RigidMotion, ExponentialEqualsItsSeries) {
  Twist twist;
  twist << 0.3, -0.2, 0.5, 1, 2, -3;
  Eigen::Matrix4d X = Eigen::Matrix4d::Zero();
  X.topLeftCorner<3, 3>() = hat(twist.head<3>());
  X.topRightCorner<3, 1>() = twist.tail<3>();
  Eigen::Matrix4d sum = Eigen::Matrix4d::Identity(), term = sum;
  for (int n = 1; n < 30; ++n) {
    term = term * X / n;
    sum += term;
  }
  EXPECT_LT((exp_se3(twist).matrix() - sum).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(RigidMotion, LogarithmInvertsTheExponentialAtEverySize) {
  Random random(1);
  for (const double angle : {0.0, 1e-13, 1e-9, 9.9e-5, 1.01e-4, 1e-2, 1.0, 3.0, kPi - 1e-6}) {
    for (int i = 0; i < 20; ++i) {
      Twist twist;
      twist.head<3>() = angle * random_vector(random, 1).normalized();
      twist.tail<3>() = random_vector(random, 10);
      EXPECT_LT((log_se3(exp_se3(twist)) - twist).norm(), 1e-8) << angle;
    }
  }
}

TEST(RigidMotion, InterpolationHasConstantTwistAndItsEnds) {
  Twist a, b;
  a << 0.1, 0.2, -0.3, 5, 6, 7;
  b << -0.4, 0.1, 0.9, 1, -2, 3;
  const RigidMotion T0 = exp_se3(a), T1 = exp_se3(b);
  EXPECT_TRUE(interpolate(T0, T1, 0).isApprox(T0, 1e-14));
  EXPECT_TRUE(interpolate(T0, T1, 1).isApprox(T1, 1e-12));
  // Equal steps are equal motions, beyond the ends, too.
  const RigidMotion step = T0.inverse() * interpolate(T0, T1, 0.25);
  for (const double s : {-0.5, 0.25, 0.5, 0.75, 1.0, 1.5}) {
    EXPECT_TRUE((interpolate(T0, T1, s) * step).isApprox(interpolate(T0, T1, s + 0.25), 1e-12));
  }
}

TEST(RigidMotion, RotationAngleIsUnsigned) {
  EXPECT_NEAR(rotation_angle(exp_se3((Twist() << 0, 0, -0.7, 0, 0, 0).finished()).rotation()), 0.7,
              1e-14);
  EXPECT_EQ(rotation_angle(Eigen::Matrix3d::Identity()), 0);
}

TEST(RigidMotion, RecognisesRotations) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  EXPECT_TRUE(is_rotation(R, 1e-12));
  EXPECT_FALSE(is_rotation(-R, 1e-3));  // mirrored
  EXPECT_FALSE(is_rotation(1.01 * R, 1e-3));
  Eigen::Matrix3d broken = R;
  broken(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_rotation(broken, 1e-3));
  EXPECT_FALSE(is_rotation(Eigen::Matrix3d::Zero(), 1e-3));
}

TEST(RigidMotion, NearestRotationTakesRoundingOut) {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(2, Eigen::Vector3d(3, -1, 2).normalized()).matrix();
  Eigen::Matrix3d rounded = R;
  for (double& entry : rounded.reshaped()) entry = std::round(entry * 1e6) / 1e6;
  const Eigen::Matrix3d repaired = nearest_rotation(rounded);
  EXPECT_TRUE(is_rotation(repaired, 1e-14));
  EXPECT_LT((repaired - R).cwiseAbs().maxCoeff(), 1e-6);
  // Of a reflection, too, it makes a rotation.
  EXPECT_GT(nearest_rotation(Eigen::Vector3d(1, 1, -0.9).asDiagonal()).determinant(), 0);
}

TEST(RigidMotion, ATwistIsThatOfEachPartOfABody) {
  Twist twist_a, T;
  twist_a << 0.2, -0.1, 0.4, 9, 0.5, -0.3;
  T << -1.1, 0.6, 2.0, 0.8, -0.3, 1.9;
  const RigidMotion T_a_b = exp_se3(T);
  const Twist twist_b = twist_of_part(twist_a, T_a_b);
  EXPECT_TRUE(exp_se3(twist_b).isApprox(T_a_b.inverse() * exp_se3(twist_a) * T_a_b, 1e-12));
}

}  // namespace fovea::rigid_motion_test
