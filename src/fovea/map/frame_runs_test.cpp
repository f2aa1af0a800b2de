#include "fovea/map/frame_runs.h"

#include <gtest/gtest.h>

#include "fovea/base/random.h"

namespace fovea::frame_runs_test {

using Frames = std::vector<std::int32_t>;

Frames all_of(const FrameRuns& runs) {
  Frames frames(runs.size());
  runs.copy_to(frames);
  return frames;
}

/// Runs of 1 to 5 points of a few frames, in any order.
Frames random_frames(std::size_t count, Random& random) {
  Frames frames;
  while (frames.size() < count) {
    const auto frame = static_cast<std::int32_t>(random.next() % 4) - 1;
    for (std::uint64_t n = 1 + random.next() % 5; n > 0; --n) frames.push_back(frame);
  }
  return frames;
}

TEST(FrameRuns, TellTheFrameOfEachPoint) {
  Random random(1);
  const Frames frames = random_frames(300, random);
  const FrameRuns runs(frames);
  ASSERT_EQ(runs.size(), frames.size());
  EXPECT_EQ(all_of(runs), frames);
  for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(runs[i], frames[i]);
  EXPECT_EQ(runs.back(), frames.back());
}

TEST(FrameRuns, NeighboursOfOneFrameAreOneRun) {
  FrameRuns runs;
  EXPECT_EQ(runs.size(), 0u);
  for (const std::int32_t frame : {7, 7, 7, 9, 7}) runs.push_back(frame);
  EXPECT_EQ(runs.runs(), (std::vector<FrameRuns::Run>{{7, 3}, {9, 4}, {7, 5}}));
  runs.keep(std::vector<std::uint32_t>{1, 2, 4});
  EXPECT_EQ(runs.runs(), (std::vector<FrameRuns::Run>{{7, 3}}));
  runs.keep({});
  EXPECT_EQ(runs, FrameRuns());
}

TEST(FrameRuns, KeepsWhatIsAskedFor) {
  Random random(2);
  const Frames frames = random_frames(300, random);
  std::vector<std::uint32_t> indices;
  Frames kept;
  for (std::uint32_t i = 0; i < frames.size(); ++i) {
    if (random.uniform() < 0.6) continue;
    indices.push_back(i);
    kept.push_back(frames[i]);
  }
  FrameRuns runs(frames);
  runs.keep(indices);
  EXPECT_EQ(runs, FrameRuns(kept));
}

TEST(FrameRuns, GoesThroughPointsFromAnyOn) {
  const FrameRuns runs(Frames{4, 4, 5, 5, 5, 8});
  for (std::size_t first = 0; first <= runs.size(); ++first) {
    Frames seen;
    runs.for_each_from(first, [&](std::size_t i, std::int32_t frame) {
      EXPECT_EQ(i, first + seen.size());
      if (frame > 5) return false;
      seen.push_back(frame);
      return true;
    });
    const Frames all{4, 4, 5, 5, 5};
    EXPECT_EQ(seen,
              Frames(all.begin() + std::min<std::ptrdiff_t>(std::ptrdiff_t(first), 5), all.end()));
  }
}

}  // namespace fovea::frame_runs_test
