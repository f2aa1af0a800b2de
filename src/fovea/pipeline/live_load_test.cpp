#include "fovea/pipeline/live_load.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace fovea {
namespace {

/// A run of a robot that sends a scan each `step`. It needs a time for each frame that it tracks,
/// and another if it maps the frame (ms). It tracks nothing while it maps: the worst case.
struct SimulatedRun {
  double step, tracking, mapping;
  int first = 1;  ///< frames that come all at once, when the last of them is there
  /// Frames that the reader and the tracker hold, at most.
  static constexpr int kHeld = 4;

  struct Outcome {
    int mapped = 0, most_waiting = 0, longest_skip = 0;
  };
  Outcome of(int frames) const {
    LiveLoad load;
    Outcome outcome;
    double now = (first - 1) * step;
    int skipped = 0;
    for (int frame = 0; frame < frames; ++frame) {
      now = std::max(now, frame * step) + tracking;
      const int came = std::min(frames, int(now / step) + 1);
      const int waiting = came - std::max(frame + 1, first);
      const int held = std::min(came, frame + 1 + kHeld) - std::max(frame + 1, first);
      outcome.most_waiting = std::max(outcome.most_waiting, waiting);
      if (load.skips_next(held, now - frame * step)) {
        outcome.longest_skip = std::max(outcome.longest_skip, ++skipped);
        continue;
      }
      skipped = 0;
      ++outcome.mapped;
      now += mapping;
    }
    return outcome;
  }
};

}  // namespace

TEST(LiveLoad, ARunInTimeMapsEachFrame) {
  EXPECT_EQ((SimulatedRun{100, 10, 85}).of(1000).mapped, 1000);
}

TEST(LiveLoad, TheFirstFramesDelayLaterOnesForAWhileOnly) {
  EXPECT_EQ((SimulatedRun{100, 10, 40, 10}).of(1000).mapped, 1000);
}

TEST(LiveLoad, ALateFrameIsMapped) {
  LiveLoad load;
  double age = 0.1;
  for (const int waiting : {0, 2, 2, 1, 2, 0}) EXPECT_FALSE(load.skips_next(waiting, age += 0.1));
}

TEST(LiveLoad, ARunThatFallsBehindCatchesUp) {
  LiveLoad load;
  std::vector<bool> skips;
  double age = 0.3;
  for (const int waiting : {2, 3, 2, 2}) skips.push_back(load.skips_next(waiting, age += 0.1));
  for (const int waiting : {2, 1, 2}) skips.push_back(load.skips_next(waiting, age -= 0.1));
  EXPECT_EQ(skips, (std::vector<bool>{false, true, true, true, true, false, false}));
}

TEST(LiveLoad, NoScanWaitsForLongIfTrackingKeepsUp) {
  const SimulatedRun::Outcome outcome = SimulatedRun{25, 12, 60}.of(4000);
  EXPECT_LE(outcome.most_waiting, 6);  // the source keeps eight beyond those that are held
  // Of 100 s, tracking needs 48 s. The others suffice for 867 frames.
  EXPECT_NEAR(outcome.mapped, 867, 10);
}

TEST(LiveLoad, ATooFastRobotGetsASparseMap) {
  const SimulatedRun::Outcome outcome = SimulatedRun{10, 12, 60}.of(4000);
  EXPECT_EQ(outcome.longest_skip, LiveLoad::kMostSkipped);
  EXPECT_GE(outcome.mapped, 4000 / (LiveLoad::kMostSkipped + 1));
}

}  // namespace fovea
