#include "fovea/mapping/registration/optimizer.h"

#include <gtest/gtest.h>

#include "fovea/mapping/registration/test_scenes.h"

namespace fovea::optimizer_test {

const Eigen::Matrix3f kIdentity = Eigen::Matrix3f::Identity();

/// Pairs of the same physical points, `source` seen from `truth`.
std::vector<Pair> true_pairs(const RigidMotion& truth) {
  std::vector<Pair> pairs;
  for (const Eigen::Vector3f& p : test::sample(test::room_corner(), 2, 1)) {
    const Eigen::Vector3f source = (truth.inverse() * p.cast<double>()).cast<float>();
    pairs.push_back({source, p, pack_symmetric(kIdentity), Eigen::Vector3f::Zero(), 0});
  }
  return pairs;
}

TEST(Optimizer, FindsTheTruthFromFarAwayAndNeverRaisesTheError) {
  const RigidMotion truth = test::motion(0.5, -0.8, 1.2, 3, -2, 1);
  for (const double robust_width : {0.0, 5.0}) {
    OptimizerOptions options;
    options.robust_width = robust_width;
    for (int trial = 0; trial < 8; ++trial) {
      Random random(static_cast<std::uint64_t>(trial));
      Twist offset;
      for (int i = 0; i < 6; ++i) offset[i] = random.uniform(-1.5, 1.5);
      RigidMotion T = truth * exp_se3(offset);
      const PairBlocks pairs(true_pairs(truth));
      double error = accumulate(pairs, T, robust_width).error;
      for (int i = 0; i < 20; ++i) {
        const OptimizerResult result = minimize(pairs, T, options);
        EXPECT_LE(result.equations.error, error);
        EXPECT_EQ(result.equations.error,
                  accumulate(pairs, result.T_target_source, robust_width).error);
        error = result.equations.error;
        T = result.T_target_source;
      }
      EXPECT_LT(log_se3(truth.inverse() * T).norm(), 1e-5) << "trial " << trial;
    }
  }
}

TEST(Optimizer, PairsWithoutATargetDoNotCount) {
  std::vector<Pair> pairs = true_pairs(test::motion(0, 0, 0, 1, 0, 0));
  const std::size_t all = pairs.size();
  pairs[3].target_index = pairs[7].target_index = Pair::kNone;
  pairs[3].target.x() = 1e6f;
  const PairEquations equations = accumulate(PairBlocks(pairs), RigidMotion::Identity(), 0);
  EXPECT_EQ(equations.pairs, all - 2);
  EXPECT_NEAR(equations.error, static_cast<double>(all - 2), 1e-2);
}

TEST(Optimizer, StepsAreProjectedOffDegenerateDirections) {
  // Planes that face y and z only leave x unknown, whatever distance along x the pairs have.
  std::vector<Pair> pairs = true_pairs(test::motion(0, 0, 0, 0.5, 0.2, -0.1));
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs[i].normal = i % 2 == 0 ? Eigen::Vector3f::UnitY() : Eigen::Vector3f::UnitZ();
  }
  OptimizerOptions options;
  options.degenerate_eigenvalue = 0.01;
  options.judge_by_planes = true;
  RigidMotion T = RigidMotion::Identity();
  for (int i = 0; i < 10; ++i) T = minimize(PairBlocks(pairs), T, options).T_target_source;
  EXPECT_EQ(minimize(PairBlocks(pairs), T, options).degenerate_directions, 1);
  EXPECT_NEAR(T.translation().x(), 0, 0.01);  // and not 0.5
  EXPECT_NEAR(T.translation().y(), 0.2, 0.05);
}

/// Pairs of a corridor along x. They do not determine the position along x.
std::vector<Pair> corridor_pairs(std::size_t count) {
  std::vector<Pair> pairs(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3f p(float(i % 40) - 20, i % 2 == 0 ? 2 : -1 + 0.5f * float(i % 5),
                            i % 2 == 0 ? float(i % 7) - 3 : -1.7f);
    const Eigen::Vector3f normal = i % 2 == 0 ? Eigen::Vector3f::UnitY() : Eigen::Vector3f::UnitZ();
    pairs[i].source = p;
    pairs[i].target = p + Eigen::Vector3f(0, 0.2f, 0);
    pairs[i].target_index = 0;
    pairs[i].normal = normal;
    pairs[i].information = pack_symmetric(normal * normal.transpose());
  }
  return pairs;
}

TEST(Optimizer, ThePriorDeterminesDegenerateDirections) {
  const PairBlocks pairs(corridor_pairs(4000));
  OptimizerOptions options;
  options.degenerate_eigenvalue = 0.01;
  options.judge_by_planes = true;
  PosePrior prior;
  prior.T_target_source = test::motion(0, 0, 0, 0.7, 0, 0);
  prior.sigma << Eigen::Vector3d::Constant(0.005), Eigen::Vector3d::Constant(0.1);
  options.prior = prior;
  RigidMotion T = RigidMotion::Identity();
  for (int i = 0; i < 10; ++i) T = minimize(pairs, T, options).T_target_source;
  EXPECT_EQ(minimize(pairs, T, options).degenerate_directions, 1);
  EXPECT_NEAR(T.translation().x(), 0.7, 1e-6);  // by the prior alone
  EXPECT_NEAR(T.translation().y(), 0.2, 0.01);  // by the pairs, against the prior
}

TEST(Optimizer, AMoreCertainPriorMovesThePoseFurther) {
  const PairBlocks pairs(corridor_pairs(4000));
  const auto y_with = [&](double sigma) {
    OptimizerOptions options;
    PosePrior prior;
    prior.sigma << Eigen::Vector3d::Constant(0.1), Eigen::Vector3d::Constant(sigma);
    options.prior = prior;
    RigidMotion T = RigidMotion::Identity();
    for (int i = 0; i < 20; ++i) T = minimize(pairs, T, options).T_target_source;
    return T.translation().y();
  };
  // The pairs have y = 0.2 m, the prior has 0. Half of a hundred independent pairs face y. Their
  // least deviation is 2 cm, so the deviation of y is 0.02 / sqrt(50) = 3 mm.
  EXPECT_NEAR(y_with(0.1), 0.2, 0.001);
  EXPECT_GT(y_with(0.02), y_with(0.005));
  EXPECT_GT(y_with(0.005), y_with(0.001));
  EXPECT_LT(y_with(0.001), 0.02);
}

TEST(Optimizer, NoPairsNoStep) {
  const RigidMotion guess = test::motion(0.1, 0, 0, 1, 2, 3);
  EXPECT_LT(log_se3(guess.inverse() * minimize(PairBlocks(), guess, {}).T_target_source).norm(),
            1e-12);
}

}  // namespace fovea::optimizer_test
