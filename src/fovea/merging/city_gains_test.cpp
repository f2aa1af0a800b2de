#include "fovea/merging/city_gains.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::city_gains_test {

using Eigen::Vector3d;

/// Maps with an equal number of submaps.
std::vector<GainNode> maps_of(std::size_t maps, std::size_t submaps) {
  std::vector<GainNode> nodes(maps * submaps);
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].continues = i % submaps != 0;
  return nodes;
}

/// What colors show whose gains are `truth`: color * 2^gain is the same in both submaps.
GainTie tie(std::size_t a, std::size_t b, const std::vector<Vector3d>& truth) {
  return {a, b, truth[a] - truth[b]};
}

TEST(CityGains, FindsTheGainsOfThreeMaps) {
  // Their sum is zero: the prior leaves it there.
  const std::vector<Vector3d> truth{{0.3, -0.2, 0.1}, {-0.5, 0.1, 0.2}, {0.2, 0.1, -0.3}};
  const auto gains =
      city_gains(maps_of(3, 1), {tie(0, 1, truth), tie(1, 2, truth), tie(0, 2, truth)});
  // With 3 ties of weight 1 / 0.05^2 and a prior of weight 1, the normal equations of gains whose
  // sum is zero have the factor 3 * 400 + 1 instead of 3 * 400.
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_LT((gains[k] - 1200.0 / 1201 * truth[k]).norm(), 1e-6) << k;
  }
}

TEST(CityGains, ThePriorKeepsTheCommonGainAtZero) {
  const std::vector<Vector3d> truth{{1.3, 1.3, 1.3}, {1, 1, 1}, {0.7, 0.7, 0.7}};
  const auto gains = city_gains(maps_of(3, 1), {tie(0, 1, truth), tie(1, 2, truth)});
  EXPECT_LT((gains[0] + gains[1] + gains[2]).norm(), 1e-9);
  EXPECT_LT((gains[0] - gains[1] - Vector3d::Constant(0.3)).norm(), 2e-3);
  EXPECT_LT((gains[1] - gains[2] - Vector3d::Constant(0.3)).norm(), 2e-3);
}

TEST(CityGains, FindsTheGainsOfMapsWithManySubmaps) {
  const std::vector<Vector3d> of_map{{0.4, 0, -0.1}, {-0.1, 0.3, -0.2}, {-0.3, -0.3, 0.3}};
  std::vector<Vector3d> truth;
  for (std::size_t i = 0; i < 30; ++i) truth.push_back(of_map[i / 10]);
  std::vector<GainTie> ties;
  for (std::size_t i = 0; i < 10; ++i) {
    ties.push_back(tie(i, 10 + i, truth));
    ties.push_back(tie(10 + i, 29 - i, truth));
  }
  const auto gains = city_gains(maps_of(3, 10), ties);
  for (std::size_t i = 0; i < 30; ++i) EXPECT_LT((gains[i] - truth[i]).norm(), 2e-3) << i;
}

// A tie may have the later submap first.
TEST(CityGains, ATieCountsInBothDirections) {
  const std::vector<Vector3d> truth{{0.3, -0.2, 0.1}, {-0.3, 0.2, -0.1}};
  const auto forth = city_gains(maps_of(2, 1), {tie(0, 1, truth)});
  const auto back = city_gains(maps_of(2, 1), {tie(1, 0, truth)});
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT((forth[k] - 800.0 / 801 * truth[k]).norm(), 1e-6);
    EXPECT_LT((back[k] - forth[k]).norm(), 1e-12);
  }
}

TEST(CityGains, OneWrongTieOfTenChangesLittle) {
  const std::vector<Vector3d> of_map{{0.2, -0.1, 0}, {-0.2, 0.1, 0}};
  std::vector<Vector3d> truth;
  std::vector<GainTie> ties;
  for (std::size_t i = 0; i < 20; ++i) truth.push_back(of_map[i / 10]);
  for (std::size_t i = 0; i < 10; ++i) ties.push_back(tie(i, 10 + i, truth));
  const auto right = city_gains(maps_of(2, 10), ties);
  for (const double error : {0.5, 2.0, -3.0}) {
    for (const std::size_t wrong : {0u, 4u}) {
      std::vector<GainTie> with_wrong = ties;
      with_wrong[wrong].log2_gain.array() += error;
      const auto gains = city_gains(maps_of(2, 10), with_wrong);
      for (std::size_t i = 0; i < 20; ++i) {
        const double change = (gains[i] - right[i]).cwiseAbs().maxCoeff();
        EXPECT_LT(std::exp2(change) - 1, 0.02) << error << " at " << wrong << ", submap " << i;
      }
    }
  }
}

TEST(CityGains, FixedGainsStay) {
  std::vector<GainNode> nodes = maps_of(2, 3);
  const Vector3d fixed(0.75, -0.5, 0.125);
  for (std::size_t i = 0; i < 3; ++i) nodes[i].fixed = fixed + Vector3d::Constant(0.1 * double(i));
  std::vector<GainTie> ties;
  for (std::size_t i = 0; i < 3; ++i) ties.push_back({i, 3 + i, Vector3d::Constant(-1)});
  const auto gains = city_gains(nodes, ties);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_LT((gains[i] - *nodes[i].fixed).norm(), 1e-6) << i;
}

TEST(CityGains, MapsFollowAFixedOne) {
  std::vector<GainNode> nodes = maps_of(2, 1);
  const Vector3d fixed(0.75, -0.5, 0.125), tied(-1, 0.5, 0);
  nodes[0].fixed = fixed;
  const auto gains = city_gains(nodes, {{0, 1, tied}});
  EXPECT_LT((gains[0] - fixed).norm(), 1e-6);
  // A tie of weight 400 and a prior of weight 1.
  EXPECT_LT((gains[1] - 400.0 / 401 * (fixed - tied)).norm(), 1e-4);
}

TEST(CityGains, MapsWithoutTiesStayAtZero) {
  for (const Vector3d& gain : city_gains(maps_of(3, 2), {})) EXPECT_EQ(gain, Vector3d::Zero());
  // Ties between other maps do not matter.
  const auto gains = city_gains(maps_of(3, 2), {{0, 2, Vector3d(1, -1, 0.5)}});
  EXPECT_GT(gains[0].norm(), 0.1);
  EXPECT_EQ(gains[4], Vector3d::Zero());
  EXPECT_EQ(gains[5], Vector3d::Zero());
  EXPECT_TRUE(city_gains({}, {}).empty());
}

TEST(CityGains, ConsecutiveSubmapsHaveSimilarGains) {
  // Only the middle submap of five has a tie: the others follow it.
  std::vector<GainNode> nodes = maps_of(1, 6);
  nodes[0].fixed = Vector3d::Zero();
  nodes[1].continues = false;
  const auto gains = city_gains(nodes, {{0, 3, Vector3d(-0.5, 0, 0.25)}});
  EXPECT_NEAR(gains[3].x(), 0.5, 0.01);
  EXPECT_NEAR(gains[3].z(), -0.25, 0.01);
  for (const std::size_t i : {1u, 2u, 4u, 5u}) EXPECT_LT((gains[i] - gains[3]).norm(), 0.002) << i;
}

// Each submap of a map has a tie to a fixed one; the ties are off in turns. The equations of
// consecutive gains g are 401 g[i] + 2500 (2 g[i] - g[i - 1] - g[i + 1]) = 400 * error[i]: ties of
// 0.05 stops, changes of 0.02, a prior of 1. The answer to a single error falls by the factor r per
// submap, where r + 1 / r = 2 + 401 / 2500.
TEST(CityGains, ErrorsOfTiesAreSmoothed) {
  constexpr std::size_t kSubmaps = 40, kMiddle = kSubmaps / 2;
  constexpr double kError = 0.002;  // so small that no tie counts less for its error
  std::vector<GainNode> nodes = maps_of(2, kSubmaps);
  std::vector<GainTie> ties;
  for (std::size_t i = 0; i < kSubmaps; ++i) {
    nodes[i].fixed = Vector3d::Zero();
    ties.push_back({i, kSubmaps + i, Vector3d::Constant(i % 2 == 0 ? -kError : kError)});
  }
  const auto gains = city_gains(nodes, ties);
  const double sum = 2 + 401.0 / 2500, r = (sum - std::sqrt(sum * sum - 4)) / 2;
  const double at_end = 400.0 / 401 * (1 - r) / (1 + r), in_middle = 400.0 / (401 + 4 * 2500);
  EXPECT_NEAR(gains[kSubmaps].x() / kError, at_end, 0.005);
  EXPECT_NEAR(gains[kSubmaps + kMiddle].x() / kError, in_middle, 0.005);
  EXPECT_NEAR(gains[kSubmaps + kMiddle + 1].x() / kError, -in_middle, 0.005);
}

}  // namespace fovea::city_gains_test
