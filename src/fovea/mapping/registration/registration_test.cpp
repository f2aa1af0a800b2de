#include "fovea/mapping/registration/registration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "fovea/core/parallel.h"
#include "fovea/mapping/registration/test_scenes.h"

namespace fovea::registration_test {

using test::motion;

constexpr RegistrationMethod kMethods[] = {RegistrationMethod::kGicp,
                                           RegistrationMethod::kPointToPoint,
                                           RegistrationMethod::kPointToPlane};

RegistrationOptions options_for(RegistrationMethod method) {
  RegistrationOptions options;
  options.method = method;
  options.max_iterations = 100;
  return options;
}

struct Scans {
  std::vector<Eigen::Vector3f> target, source;
};

/// Two scans of a scene that share no point; the source is seen from T_target_source.
Scans two_scans(const std::vector<test::Rectangle>& target_scene,
                const std::vector<test::Rectangle>& source_scene,
                const RigidMotion& T_target_source, double sigma) {
  return {test::sample(target_scene, 40, 1, sigma),
          test::transformed(T_target_source.inverse(), test::sample(source_scene, 40, 2, sigma))};
}

RegistrationResult align(const Scans& scans, const RigidMotion& guess,
                         const RegistrationOptions& options) {
  const RegistrationCloud target = prepare_cloud(scans.target, options);
  const RegistrationCloud source = prepare_cloud(scans.source, options);
  return register_clouds(target, PointIndex(target.points), source, guess, options);
}

struct PoseError {
  double meters, radians;
};
PoseError error_of(const RigidMotion& estimate, const RigidMotion& truth) {
  const Twist difference = log_se3(truth.inverse() * estimate);
  return {difference.tail<3>().norm(), difference.head<3>().norm()};
}

class EveryMethod : public testing::TestWithParam<RegistrationMethod> {};
INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod, testing::ValuesIn(kMethods),
                         [](const auto& test_info) -> std::string {
                           switch (test_info.param) {
                             case RegistrationMethod::kGicp:
                               return "Gicp";
                             case RegistrationMethod::kPointToPoint:
                               return "PointToPoint";
                             default:
                               return "PointToPlane";
                           }
                         });

TEST_P(EveryMethod, IdenticalPointsAreAlignedExactly) {
  const RigidMotion truth = motion(0.01, -0.02, 0.04, 0.15, -0.1, 0.05);
  const std::vector<Eigen::Vector3f> target = test::sample(test::room_corner(), 40, 1);
  RegistrationOptions options = options_for(GetParam());
  options.converged_rotation = options.converged_translation = 1e-6;
  const RegistrationResult result =
      align({target, test::transformed(truth.inverse(), target)}, RigidMotion::Identity(), options);
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.degenerate_directions, 0);
  EXPECT_EQ(result.pairs, target.size());
  EXPECT_LT(result.rms_distance, 1e-5);
  EXPECT_LT(error_of(result.T_target_source, truth).meters, 1e-5);
  EXPECT_LT(error_of(result.T_target_source, truth).radians, 1e-5);
}

TEST_P(EveryMethod, RecoversKnownMotionsOfSeparatelySampledScans) {
  // Point to point has the largest error: the random pattern of the samples.
  const bool point_to_point = GetParam() == RegistrationMethod::kPointToPoint;
  const RigidMotion truths[] = {motion(0, 0, 0, 0.5, 0, 0), motion(0, 0, 0.08, 0.3, -0.2, 0.05),
                                motion(0.03, -0.04, -0.05, -0.3, 0.3, -0.1)};
  for (const double sigma : {0.0, 0.01}) {
    for (const RigidMotion& truth : truths) {
      const Scans scans = two_scans(test::room_corner(), test::room_corner(), truth, sigma);
      const RegistrationResult result =
          align(scans, RigidMotion::Identity(), options_for(GetParam()));
      const PoseError error = error_of(result.T_target_source, truth);
      EXPECT_TRUE(result.converged) << "sigma " << sigma;
      EXPECT_EQ(result.degenerate_directions, 0);
      EXPECT_LT(error.meters, point_to_point ? 0.02 : 0.003) << "sigma " << sigma;
      EXPECT_LT(error.radians, point_to_point ? 0.004 : 0.0006) << "sigma " << sigma;
    }
  }
}

TEST_P(EveryMethod, ASampleOfThePointsGivesThePoseOfAll) {
  const RigidMotion truth = motion(0.01, -0.02, 0.04, 0.15, -0.1, 0.05);
  const Scans scans = two_scans(test::room_corner(), test::room_corner(), truth, 0.01);
  RegistrationOptions options = options_for(GetParam());
  const RegistrationResult all = align(scans, RigidMotion::Identity(), options);
  const RegistrationCloud target = prepare_cloud(scans.target, options);
  options.max_points = static_cast<int>(scans.source.size() / 3);
  const RegistrationResult some =
      register_clouds(target, PointIndex(target.points), prepare_cloud(scans.source, options),
                      RigidMotion::Identity(), options);
  EXPECT_TRUE(some.converged);
  EXPECT_LE(some.pairs, scans.source.size() / 3);
  EXPECT_LT(error_of(some.T_target_source, truth).meters,
            error_of(all.T_target_source, truth).meters + 0.005);
  EXPECT_NEAR(some.information.trace() / all.information.trace(), 1. / 3, 0.1);
}

TEST(PrepareCloud, KeepsPointsAtEvenStepsWithTheirNormalsAmongAll) {
  const std::vector<Eigen::Vector3f> room = test::sample(test::room_corner(), 8, 1);
  RegistrationOptions options;
  const RegistrationCloud all = prepare_cloud(room, options, 0.25);
  options.max_points = static_cast<int>(room.size() / 4);
  const RegistrationCloud some = prepare_cloud(room, options, 0.25);
  ASSERT_EQ(some.points.size(), room.size() / 4);
  ASSERT_EQ(some.normals.size(), some.points.size());
  for (std::size_t i = 0; i < some.points.size(); ++i) {
    const std::size_t at = i * room.size() / some.points.size();
    EXPECT_EQ(some.points[i], all.points[at]);
    EXPECT_EQ(some.normals[i], all.normals[at]);
  }
}

TEST_P(EveryMethod, IsTheSameAtAnyThreadCount) {
  const Scans scans = two_scans(test::room_corner(), test::room_corner(),
                                motion(0.01, 0.02, 0.05, 0.2, 0.1, 0), 0.01);
  const auto with_threads = [&](int threads) {
    const ThreadLimit limit(threads);
    return align(scans, RigidMotion::Identity(), options_for(GetParam()));
  };
  const RegistrationResult one = with_threads(1), two = with_threads(2);
  EXPECT_EQ(one.T_target_source.matrix(), two.T_target_source.matrix());
  EXPECT_EQ(one.iterations, two.iterations);
  EXPECT_EQ(one.rms_distance, two.rms_distance);
}

TEST_P(EveryMethod, EmptyAndTinyCloudsKeepTheGuess) {
  const RigidMotion guess = motion(0, 0, 0.1, 1, 2, 3);
  const std::vector<Eigen::Vector3f> room = test::sample(test::room_corner(), 40, 1);
  const std::vector<Eigen::Vector3f> few(room.begin(), room.begin() + 20);
  const std::vector<Eigen::Vector3f> one = {{1, 2, 3}};
  for (const Scans& scans :
       {Scans{{}, {}}, Scans{room, {}}, Scans{{}, room}, Scans{one, one}, Scans{room, few}}) {
    const RegistrationResult result = align(scans, guess, options_for(GetParam()));
    EXPECT_FALSE(result.converged);
    EXPECT_EQ(result.T_target_source.matrix(), guess.matrix());
  }
}

TEST_P(EveryMethod, CloudsOutOfReachKeepTheGuess) {
  const std::vector<Eigen::Vector3f> room = test::sample(test::room_corner(), 40, 1);
  const RigidMotion guess = motion(0, 0, 0, 50, 0, 0);
  const RegistrationResult result = align({room, room}, guess, options_for(GetParam()));
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.pairs, 0u);
  EXPECT_EQ(result.T_target_source.matrix(), guess.matrix());
}

TEST_P(EveryMethod, NonFinitePointsAreLeftOut) {
  const RigidMotion truth = motion(0, 0, 0.02, 0.1, 0, 0);
  Scans scans = two_scans(test::room_corner(), test::room_corner(), truth, 0);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  scans.source.insert(scans.source.begin() + 100, {{nan, 0, 0}, {0, infinity, 0}});
  scans.target.insert(scans.target.begin() + 50, {{0, nan, nan}, {-infinity, 0, 0}});
  const RegistrationResult result = align(scans, RigidMotion::Identity(), options_for(GetParam()));
  EXPECT_LT(error_of(result.T_target_source, truth).meters, 0.02);
}

TEST_P(EveryMethod, ResultIsARotationHoweverOftenItIsExtrapolated) {
  // Constant-velocity guesses double the rounding errors of the poses with every frame.
  const std::vector<Eigen::Vector3f> room = test::sample(test::room_corner(), 5, 1);
  RegistrationOptions options = options_for(GetParam());
  const RegistrationCloud cloud = prepare_cloud(room, options);
  const PointIndex index(cloud.points);
  RigidMotion before = motion(0.01, 0, 0, 0, 0, 0), last = RigidMotion::Identity();
  for (int i = 0; i < 100; ++i) {
    const RigidMotion guess = last * (before.inverse() * last);
    before = last;
    last = register_clouds(cloud, index, cloud, guess, options).T_target_source;
  }
  EXPECT_TRUE(is_rotation(last.linear(), 1e-12));
}

class MethodsWithNormals : public EveryMethod {};
INSTANTIATE_TEST_SUITE_P(Methods, MethodsWithNormals,
                         testing::Values(RegistrationMethod::kGicp,
                                         RegistrationMethod::kPointToPlane));

TEST_P(MethodsWithNormals, CorridorKeepsTheGuessAlongItsAxis) {
  const RigidMotion truth = motion(0, 0, 0.03, 0.4, 0.15, 0.05);
  for (const double sigma : {0.0, 0.005, 0.015}) {
    // The source does not see the ends of the target, which would determine the axial position.
    const Scans scans = two_scans(test::corridor(15), test::corridor(10), truth, sigma);
    const RigidMotion guess = motion(0, 0, 0, 0.7, 0, 0);
    const RegistrationResult result = align(scans, guess, options_for(GetParam()));
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.degenerate_directions, 1) << "sigma " << sigma;
    const RigidMotion& T = result.T_target_source;
    EXPECT_NEAR(T.translation().x(), 0.7, 0.02);  // the guess, not the truth
    EXPECT_NEAR(T.translation().y(), truth.translation().y(), 0.005);
    EXPECT_NEAR(T.translation().z(), truth.translation().z(), 0.005);
    EXPECT_LT(rotation_angle(T.linear().transpose() * truth.linear()), 1e-3);
  }
}

TEST_P(MethodsWithNormals, PlaneHasThreeDegenerateDirections) {
  const std::vector<test::Rectangle> floor = {{{-10, -10, -1.7}, {20, 0, 0}, {0, 20, 0}}};
  const std::vector<test::Rectangle> inner = {{{-5, -5, -1.7}, {10, 0, 0}, {0, 10, 0}}};
  const RigidMotion truth = motion(0.02, 0.03, 0, 0, 0, 0.1);
  const RigidMotion guess = motion(0, 0, 0.2, 0.5, -0.3, 0);
  const RegistrationResult result =
      align(two_scans(floor, inner, truth, 0), guess, options_for(GetParam()));
  EXPECT_TRUE(result.converged);
  EXPECT_EQ(result.degenerate_directions, 3);
  // The pose of the floor is found ...
  EXPECT_LT((result.T_target_source.linear().row(2) - truth.linear().row(2)).norm(), 0.05);
  const Eigen::Vector3d under =
      result.T_target_source * (truth.inverse() * Eigen::Vector3d(0, 0, -1.7));
  EXPECT_NEAR(under.z(), -1.7, 0.005);
  // ... and the motion in the plane of the floor is that of the guess.
  EXPECT_NEAR(log_se3(result.T_target_source)[2], 0.2, 0.01);
  EXPECT_NEAR(result.T_target_source.translation().x(), 0.5, 0.1);
  EXPECT_NEAR(result.T_target_source.translation().y(), -0.3, 0.1);
}

TEST_P(EveryMethod, RobustKernelResistsAMovingBlock) {
  // A fifth of each scan is a block that moves by 0.4 m.
  const std::vector<test::Rectangle> room = test::room_corner();
  std::vector<test::Rectangle> block;
  test::add_box(block, {2, 1, -1.7}, {2.5, 2.5, 3.2});
  const RigidMotion truth = motion(0, 0, 0.01, 0.05, -0.05, 0);
  Scans scans = two_scans(room, room, truth, 0.005);
  std::vector<Eigen::Vector3f> before = test::sample(block, 50, 3, 0.005);
  std::vector<Eigen::Vector3f> after = test::transformed(
      truth.inverse() * motion(0, 0, 0, 0.3, 0.25, 0), test::sample(block, 50, 4, 0.005));
  EXPECT_GT(static_cast<double>(after.size()), 0.15 * static_cast<double>(scans.source.size()));
  scans.target.insert(scans.target.end(), before.begin(), before.end());
  scans.source.insert(scans.source.end(), after.begin(), after.end());

  RegistrationOptions options = options_for(GetParam());
  const double plain =
      error_of(align(scans, RigidMotion::Identity(), options).T_target_source, truth).meters;
  options.robust_width = 0.1;
  const double robust =
      error_of(align(scans, RigidMotion::Identity(), options).T_target_source, truth).meters;
  EXPECT_LT(robust, 0.01);
  EXPECT_LT(robust, 0.5 * plain);
}

TEST(Registration, ResultDoesNotDependOnTheTargetsOrigin) {
  // Degeneracy and conditioning refer to the sensor, so an offset of the target has no effect.
  const RigidMotion truth = motion(0.01, 0.02, 0.05, 0.2, 0.1, 0);
  Scans scans = two_scans(test::room_corner(), test::room_corner(), truth, 0.01);
  const RegistrationOptions options = options_for(RegistrationMethod::kGicp);
  const RigidMotion near = align(scans, RigidMotion::Identity(), options).T_target_source;
  const RigidMotion shift = motion(0, 0, 0, 60, -40, 2);
  scans.target = test::transformed(shift, scans.target);
  const RegistrationResult far = align(scans, shift, options);
  EXPECT_LT(error_of(far.T_target_source, shift * near).meters, 1e-4);
}

}  // namespace fovea::registration_test
