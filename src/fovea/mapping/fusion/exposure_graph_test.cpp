#include "fovea/mapping/fusion/exposure_graph.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/random.h"

namespace fovea::exposure_graph_test {

constexpr double kLength = 20;  // of a submap, m

/// A drive whose stored colors drift: by so many stops per submap.
struct Drift {
  double per_submap = 0;
  bool metered = false;
  bool shows_color = true;
  double slope = 1 / 2.4;

  /// What an image of a submap says.
  ImageLevel level(int submap, Random& random) const {
    const double exposure = std::sin(submap);  // stops
    const auto stored_gain = float(slope * exposure - per_submap * submap);
    ImageLevel level{2, LogGain::Constant(stored_gain), {}, {}};
    if (shows_color) {
      level.color = LogGain::Constant(float(6.5 + per_submap * submap + 0.1 * random.normal()));
    }
    if (metered) level.exposure = exposure;
    return level;
  }
};

ExposureGraph graph_of(const Drift& drift, int submaps) {
  ExposureGraph graph;
  Random random(1);
  for (int submap = 0; submap < submaps; ++submap) {
    graph.optimize();
    graph.add_submap(submap > 0 ? kLength : 0);
    for (int image = 0; image < 5; ++image) graph.add(drift.level(submap, random));
  }
  graph.optimize();
  return graph;
}

/// Exposure of a submap above that of the first, stops.
double error(const ExposureGraph& graph, const Drift& drift, int submap) {
  return double(graph.gains()[std::size_t(submap)].mean() - graph.gains()[0].mean()) +
         drift.per_submap * submap;
}

TEST(ExposureGraph, LeavesADriveWithoutDriftAsItIs) {
  const Drift none;
  const ExposureGraph graph = graph_of(none, 50);
  for (int submap = 0; submap < 50; ++submap) {
    EXPECT_LT(std::abs(error(graph, none, submap)), 0.03) << submap;  // 2 %
  }
}

TEST(ExposureGraph, TheColorOfTheRoadLimitsDrift) {
  const Drift drift{.per_submap = 0.01};  // 0.5 stops a kilometer
  const ExposureGraph graph = graph_of(drift, 100);
  EXPECT_LT(std::abs(error(graph, drift, 99)), 0.06);  // of 1 stop
}

TEST(ExposureGraph, ShadeIsNotDrift) {
  const Drift none;
  ExposureGraph graph;
  Random random(1);
  for (int submap = 0; submap < 60; ++submap) {
    graph.optimize();
    graph.add_submap(kLength);
    ImageLevel level = none.level(submap, random);
    if (submap >= 25 && submap < 35) *level.color -= 1.5f;  // a forest
    graph.add(level);
  }
  graph.optimize();
  EXPECT_LT(std::abs(error(graph, none, 59)), 0.1);
}

TEST(ExposureGraph, KnownExposuresRemoveDrift) {
  const Drift drift{.per_submap = 0.01, .metered = true, .shows_color = false};
  const ExposureGraph graph = graph_of(drift, 100);
  for (int submap = 0; submap < 100; submap += 9) {
    EXPECT_LT(std::abs(error(graph, drift, submap)), 0.01) << submap;
  }
}

TEST(ExposureGraph, KnownExposuresOfALinearCameraRemoveDrift) {
  const Drift drift{.per_submap = 0.01, .metered = true, .shows_color = false, .slope = 1};
  EXPECT_LT(std::abs(error(graph_of(drift, 100), drift, 99)), 0.01);
}

TEST(ExposureGraph, TheTintOfTheRoadLimitsTheDriftOfTheWhiteBalance) {
  ExposureGraph graph;
  Random random(1);
  for (int submap = 0; submap < 100; ++submap) {
    graph.optimize();
    graph.add_submap(kLength);
    const LogGain drift = 0.005f * float(submap) * LogGain(1, 0, -1);
    const LogGain step = LogGain(float(0.1 * random.normal()), 0, float(0.1 * random.normal()));
    graph.add({2, step - drift, LogGain(6.5f + drift), 0.0});
  }
  graph.optimize();
  const LogGain gain = graph.gains()[99] + 0.005f * 99 * LogGain(1, 0, -1);
  EXPECT_LT(gain.abs().maxCoeff(), 0.03);
}

TEST(ExposureGraph, ARevisitedPlaceClosesTheLoop) {
  const Drift drift{.per_submap = 0.003, .shows_color = false};
  ExposureGraph graph = graph_of(drift, 100);
  graph.add_revisit(0, 99, LogGain::Constant(float(0.003 * 99)));
  graph.optimize();
  EXPECT_NEAR(error(graph, drift, 99), 0, 0.02);
  EXPECT_LT(std::abs(error(graph, drift, 50)), 0.04);  // and what lies between
}

TEST(ExposureGraph, HasAChannelForEachColor) {
  ExposureGraph graph;
  for (int submap = 0; submap < 3; ++submap) graph.add_submap(kLength);
  graph.add_revisit(0, 2, LogGain(0.02f, 0, -0.02f));
  graph.optimize();
  const LogGain gain = graph.gains()[2];
  EXPECT_LT(gain[0], -0.01);
  EXPECT_NEAR(gain[1], 0, 1e-6);
  EXPECT_GT(gain[2], 0.01);
}

TEST(ExposureGraph, OfNothingIsEmpty) {
  ExposureGraph graph;
  graph.optimize();
  EXPECT_TRUE(graph.gains().empty());
}

}  // namespace fovea::exposure_graph_test
