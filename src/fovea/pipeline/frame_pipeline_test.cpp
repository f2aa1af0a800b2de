#include "fovea/pipeline/frame_pipeline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "fovea/pipeline/frame_reader.h"
#include "fovea/pipeline/numbered_frames.h"

namespace fovea::frame_pipeline_test {

using namespace std::chrono_literals;

TrackedScan number_of(const Frame& frame) {
  TrackedScan tracked;
  tracked.result.index = frame.index;
  return tracked;
}

/// A pipeline over numbered frames.
struct NumberedRun {
  NumberedRun(const NumberedFrames& source, int first, int end, bool threaded,
              std::function<TrackedScan(const Frame&)> track = number_of, double rate = 0)
      : reader(source, numbers(first, end), rate),
        frames({.read = [this](const std::stop_token& s) { return reader.next(s); },
                .track = std::move(track)},
               threaded, stop.get_token()) {}

  /// Indices in the order in which the frames come; the skipped one is negative.
  std::vector<int> indices() {
    std::vector<int> found;
    while (const auto frame = frames.next()) {
      const auto* skipped = std::get_if<SkippedFrame>(&frame->read.result);
      found.push_back(skipped != nullptr ? -skipped->index : frame->tracked->result.index);
    }
    return found;
  }

  std::stop_source stop;
  FrameReader reader;
  FramePipeline frames;
};

TEST(FramePipeline, FramesComeInOrderTrackedOrSkipped) {
  const NumberedFrames source;
  for (const bool threaded : {false, true}) {
    EXPECT_EQ(NumberedRun(source, 1, 6, threaded).indices(), (std::vector<int>{1, 2, -3, 4, 5}));
    EXPECT_EQ(NumberedRun(source, 6, 6, threaded).indices(), std::vector<int>{});
  }
}

TEST(FramePipeline, DeferredWorkRunsBeforeEachFrame) {
  const NumberedFrames source;
  for (const bool threaded : {false, true}) {
    FrameReader reader(source, numbers(10, 15), /*rate=*/0);
    std::atomic<int> deferred = 0, tracked = 0;
    FramePipeline frames({.read = [&](const std::stop_token& stop) { return reader.next(stop); },
                          .track =
                              [&](const Frame& frame) {
                                EXPECT_EQ(deferred, ++tracked);
                                return number_of(frame);
                              },
                          .apply_deferred = [&] { ++deferred; }},
                         threaded, {});
    while (frames.next()) {
    }
    EXPECT_EQ(tracked, 5);
    EXPECT_EQ(deferred, 6);  // once more before the end is seen
  }
}

TEST(FramePipeline, ErrorsOfAnyStageComeAfterTheFramesBefore) {
  NumberedFrames all, fifth_fails;
  fifth_fails.error_at = 5;
  const auto fails_at_4 = [](const Frame& frame) {
    if (frame.index == 4) throw OutputError("no pose", "frame", "give one");
    return number_of(frame);
  };
  for (const bool threaded : {false, true}) {
    NumberedRun reading(fifth_fails, 0, 9, threaded), tracking(all, 0, 9, threaded, fails_at_4);
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(reading.frames.next()) << i;
    EXPECT_THROW(reading.frames.next(), InputError);
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(tracking.frames.next()) << i;
    EXPECT_THROW(tracking.frames.next(), OutputError);
  }
}

TEST(FramePipeline, ReadsFewFramesAhead) {
  const NumberedFrames source;
  NumberedRun run(source, 10, 100, /*threaded=*/true);
  // One in each queue, and one in each thread that waits for room.
  constexpr int kAhead = 4;
  for (int taken = 0; taken < 10; ++taken) {
    while (source.loaded < taken + kAhead) std::this_thread::yield();
    std::this_thread::sleep_for(1ms);  // time for one too many
    ASSERT_EQ(source.loaded, taken + kAhead);
    ASSERT_TRUE(run.frames.next());
  }
}

// A live sensor's frame arrives when it is due, however late the pipeline takes it.
TEST(FramePipeline, WaitingCountsAtARateAndNotWithoutOne) {
  const NumberedFrames source;
  const auto slow = [](const Frame& frame) {
    std::this_thread::sleep_for(20ms);
    return number_of(frame);
  };
  for (const double rate : {0.0, 1000.0}) {
    NumberedRun run(source, 10, 14, /*threaded=*/true, slow, rate);
    std::optional<TrackedFrame> last;
    while (auto frame = run.frames.next()) last = std::move(frame);
    const auto waited = last->tracking_began - last->arrival();
    EXPECT_TRUE(rate == 0 ? waited == 0ms : waited >= 3 * 20ms - 3ms);
  }
}

TEST(FramePipeline, AStopEndsTheWaitForAFrameNotDue) {
  const NumberedFrames source;
  for (const bool threaded : {false, true}) {
    NumberedRun run(source, 0, 9, threaded, number_of, /*rate=*/1e-3);
    EXPECT_TRUE(run.frames.next());  // at once
    const std::jthread interrupt([&] {
      std::this_thread::sleep_for(20ms);
      run.stop.request_stop();
    });
    EXPECT_FALSE(run.frames.next());  // not after a quarter of an hour
  }
}

TEST(FramePipeline, AStopLosesNoTrackedFrame) {
  const NumberedFrames source;
  std::atomic<int> tracked{0};
  const auto track = [&](const Frame& frame) {
    ++tracked;
    return number_of(frame);
  };
  NumberedRun run(source, 10, 100, /*threaded=*/true, track);
  ASSERT_TRUE(run.frames.next());
  while (tracked < 3) std::this_thread::yield();
  run.stop.request_stop();
  const std::size_t rest = run.indices().size();
  EXPECT_EQ(int(rest) + 1, tracked);
  EXPECT_LE(tracked, 4);
}

TEST(FramePipeline, DestructionEndsAllThreads) {
  const NumberedFrames source;
  for (const double rate : {0.0, 1e-3}) {
    NumberedRun run(source, 0, 1000, /*threaded=*/true, number_of, rate);
    EXPECT_TRUE(run.frames.next());
  }
}

}  // namespace fovea::frame_pipeline_test
