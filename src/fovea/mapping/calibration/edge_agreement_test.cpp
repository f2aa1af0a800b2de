#include "fovea/mapping/calibration/edge_agreement.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/random.h"

namespace fovea::edge_agreement_test {

/// Edges along v (upright) or along u (level), each of its own object. The image has a step `off`
/// pixels from the expected position, and clutter of up to the same height.
struct Edges {
  int frames = 10, upright = 40, level = 40;  ///< a frame
  double off_upright = 0, off_level = 0;      ///< pixels
  double step = 0.3;                          ///< share of a profile's strength
};

EdgeProfile profile_of(bool upright, double off, double step, Random& random) {
  EdgeProfile profile;
  profile.half_gap = 1;
  constexpr float kF = 700;
  profile.J.setZero();
  profile.J(1, 0) = kF;   // pitch moves edges down
  profile.J(0, 1) = -kF;  // yaw moves edges to the left
  profile.J_along.setZero();
  profile.J_along[upright ? 1 : 0] = upright ? -kF : kF;
  for (float& strength : profile.strength) {
    if (random.uniform() < 0.1) strength = static_cast<float>(step * random.uniform());
  }
  for (int k = -1; k <= 1; ++k) {
    const int pixel = static_cast<int>(std::lround(off)) + k + EdgeProfile::kReach;
    if (pixel < 0 || pixel >= EdgeProfile::kSize) continue;
    profile.strength[std::size_t(pixel)] = static_cast<float>(k == 0 ? step : step / 2);
  }
  return profile;
}

std::vector<EdgeProfile> profiles_of(const Edges& edges) {
  Random random(3);
  std::vector<EdgeProfile> profiles;
  for (int frame = 0; frame < edges.frames; ++frame) {
    for (int i = 0; i < edges.upright + edges.level; ++i) {
      const bool upright = i < edges.upright;
      profiles.push_back(
          profile_of(upright, upright ? edges.off_upright : edges.off_level, edges.step, random));
      profiles.back().frame = frame;
      profiles.back().place = {frame, i, 0};
    }
  }
  return profiles;
}

TEST(EdgeAgreement, EdgesThatMeetAgree) {
  const auto profiles = profiles_of({});
  for (const int axis : {0, 1}) {
    const EdgeMean contrast = edge_contrast(profiles, axis);
    EXPECT_EQ(contrast.edges, 400u);
    EXPECT_GT(contrast.mean, 1);
    EXPECT_LT(contrast.sigma, 0.2);
  }
  EXPECT_FALSE(edges_disagree(profiles));
}

// A pitch does not move upright edges: only level ones count.
TEST(EdgeAgreement, EachAxisIsJudgedByTheEdgesThatItMovesAcross) {
  const auto pitched = profiles_of({.off_level = 40});
  EXPECT_LT(edge_contrast(pitched, 0).mean, 0.3);
  EXPECT_GT(edge_contrast(pitched, 1).mean, 1);
  EXPECT_TRUE(edges_disagree(pitched));

  const auto yawed = profiles_of({.off_upright = -30});
  EXPECT_GT(edge_contrast(yawed, 0).mean, 1);
  EXPECT_LT(edge_contrast(yawed, 1).mean, 0.3);
  EXPECT_TRUE(edges_disagree(yawed));

  EXPECT_FALSE(edges_disagree(profiles_of({.level = 0, .off_level = 40})));
}

TEST(EdgeAgreement, FewEdgesOrImagesWithoutStepsAreNoEvidence) {
  EXPECT_FALSE(edges_disagree({}));
  EXPECT_FALSE(edges_disagree(profiles_of({.upright = 5, .level = 5, .off_upright = 30})));
  EXPECT_FALSE(edges_disagree(profiles_of({.off_upright = 30, .off_level = 30, .step = 0.05})));
}

// Ten frames of one scene contain no more evidence than one.
TEST(EdgeAgreement, SigmasCountObjects) {
  const auto once = profiles_of({.frames = 1});
  std::vector<EdgeProfile> again;
  for (int frame = 0; frame < 10; ++frame) {
    for (EdgeProfile profile : once) {
      profile.frame = frame;
      again.push_back(profile);
    }
  }
  EXPECT_NEAR(edge_contrast(again, 1).mean, edge_contrast(once, 1).mean, 1e-9);
  EXPECT_GT(edge_contrast(again, 1).sigma,
            0.9 * edge_contrast(profiles_of({.frames = 1}), 1).sigma);
}

TEST(EdgeAgreement, MeansHaveTheScatterOfTheirGroups) {
  std::vector<EdgeProfile> profiles(4);
  for (int i = 0; i < 4; ++i) profiles[std::size_t(i)].frame = i / 2;
  for (int i = 0; i < 4; ++i) profiles[std::size_t(i)].place = {i % 2, 0, 0};
  std::vector<const EdgeProfile*> all;
  for (const EdgeProfile& profile : profiles) all.push_back(&profile);
  // Sums of deviations: -2 and 2 over the frames, 0 and 0 over the places.
  const EdgeMean mean = mean_over_edges(all, {1, 1, 3, 3});
  EXPECT_EQ(mean.edges, 4u);
  EXPECT_NEAR(mean.mean, 2, 1e-12);
  EXPECT_NEAR(mean.sigma, std::sqrt(2.0 / 1 * 8) / 4, 1e-12);
}

TEST(EdgeAgreement, GainsFavorTheBetterOfTwoCorrections) {
  const auto profiles = profiles_of({.off_upright = 7});
  // Yaw moves an edge to the left: -7 / 700 rad moves it 7 pixels to the right.
  CalibrationVector right = CalibrationVector::Zero();
  right[1] = -7.0 / 700 / 0.0014;
  const EdgeMean gain = edge_gain(profiles, right, CalibrationVector::Zero());
  EXPECT_GT(gain.mean, 0.5);
  EXPECT_GT(gain.mean, 5 * gain.sigma);
  EXPECT_LT(edge_gain(profiles, -right, CalibrationVector::Zero()).mean, 0.2);
}

}  // namespace fovea::edge_agreement_test
