#include "fovea/pipeline/imu_agreement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/angle.h"

namespace fovea::imu_agreement_test {

using Vector3 = Eigen::Vector3d;
using testing::HasSubstr;

RigidMotion turn(const Vector3& v) {
  RigidMotion T = RigidMotion::Identity();
  if (v.norm() > 0) T.linear() = Eigen::AngleAxisd(v.norm(), v.normalized()).matrix();
  return T;
}

/// Turns about all axes of up to 4 degrees a frame.
Vector3 truth(int frame) {
  return 2 * kDegree *
         Vector3(std::sin(0.7 * frame), std::cos(0.4 * frame), 1.5 * std::sin(0.3 * frame + 1));
}

/// @param imu  from the true turn to that of the IMU
template <class Imu>
ImuAgreement compared(Imu&& imu, int frames = 40) {
  ImuAgreement agreement;
  for (int i = 1; i <= frames; ++i) {
    agreement.add(turn(truth(i)), turn(imu(truth(i))), turn(truth(i - 1)));
  }
  return agreement;
}

TEST(ImuAgreement, AGoodImuIsProvenAfterAWhile) {
  const auto good = [](const Vector3& v) -> Vector3 { return v + Vector3(0.001, 0, 0.001); };
  EXPECT_FALSE(compared(good, 8).is_proven());
  EXPECT_TRUE(compared(good).is_proven());
  EXPECT_FALSE(compared(good).is_contradicted());
}

TEST(ImuAgreement, AFlippedAxisIsTold) {
  const auto flipped = [](const Vector3& v) { return Vector3(v.x(), -v.y(), v.z()); };
  const ImuAgreement agreement = compared(flipped);
  EXPECT_TRUE(agreement.is_contradicted());
  EXPECT_FALSE(agreement.is_proven());
  EXPECT_EQ(agreement.likely_fault(), "an axis is likely flipped");
}

TEST(ImuAgreement, DegreesAreTold) {
  const ImuAgreement agreement = compared([](const Vector3& v) -> Vector3 { return 30 * v; });
  EXPECT_TRUE(agreement.is_contradicted());
  EXPECT_THAT(agreement.likely_fault(), HasSubstr("degrees"));
}

TEST(ImuAgreement, AWrongMountIsTold) {
  const Eigen::Matrix3d R = turn(Vector3(0, 0, 90 * kDegree)).linear();
  const ImuAgreement agreement = compared([&](const Vector3& v) -> Vector3 { return R * v; });
  EXPECT_TRUE(agreement.is_contradicted());
  EXPECT_THAT(agreement.likely_fault(), HasSubstr("off by 90 degrees"));
}

TEST(ImuAgreement, AVehicleThatGoesStraightTellsNothing) {
  ImuAgreement agreement;
  for (int i = 0; i < 100; ++i) {
    agreement.add(turn({0, 0, 1e-4}), turn({0, 0, -1e-3}), turn({0, 0, 1e-4}));
  }
  EXPECT_FALSE(agreement.is_proven());
  EXPECT_FALSE(agreement.is_contradicted());
}

TEST(ImuAgreement, ABiasThatNoGyroscopeHasContradicts) {
  ImuAgreement agreement;
  agreement.add_bias(Eigen::Vector3d(0.1, -0.1, 0.05));
  EXPECT_FALSE(agreement.is_contradicted());
  const Eigen::Vector3d gross(0, 0, 1);  // a flipped axis in a turn of 29 degrees a second
  for (int frame = 0; frame < 2; ++frame) agreement.add_bias(gross);
  agreement.add_bias(Eigen::Vector3d::Zero());
  for (int frame = 0; frame < 2; ++frame) agreement.add_bias(gross);
  EXPECT_FALSE(agreement.is_contradicted());
  agreement.add_bias(gross);
  EXPECT_TRUE(agreement.is_contradicted());
  EXPECT_FALSE(agreement.likely_fault().empty());
  agreement.add_bias(Eigen::Vector3d::Zero());
  EXPECT_TRUE(agreement.is_contradicted());
}

}  // namespace fovea::imu_agreement_test
