#include "fovea/pipeline/frame_pipeline.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <utility>
#include <vector>

#include "fovea/base/errors.h"
#include "fovea/base/parallel.h"

namespace fovea::frame_pipeline_test {

using namespace std::chrono_literals;

constexpr int kSkipped = 3;

/// Frames without content; one is skipped, one may be an error.
class Numbers : public FrameSource {
 public:
  int error_at = -1;
  mutable std::atomic<int> loaded{0};
  mutable std::vector<std::pair<int, int>> expected;  // and how many had been loaded

  const DriveInfo& info() const override { return info_; }
  std::optional<TimeNs> stamp(int index) const override { return index; }
  void expect(int index) const override { expected.emplace_back(index, loaded); }
  LoadedFrame load(int index) const override {
    ++loaded;
    if (index == error_at) throw InputError("no such frame", "numbers", "ask for another");
    if (index == kSkipped) return SkippedFrame{index, SkipReason::kMissingScan, ""};
    Frame frame;
    frame.index = index;
    return frame;
  }

 private:
  DriveInfo info_;
};

TrackedScan number_of(const Frame& frame) {
  TrackedScan tracked;
  tracked.result.index = frame.index;
  return tracked;
}

/// Indices in the order in which they come; the one skipped negative.
/// first, ..., end - 1.
std::vector<int> numbers(int first, int end) {
  std::vector<int> numbers(static_cast<std::size_t>(end - first));
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

std::vector<int> indices(FramePipeline& frames) {
  std::vector<int> found;
  while (const auto located = frames.next()) {
    const auto* skipped = std::get_if<SkippedFrame>(&located->result);
    found.push_back(skipped != nullptr ? -skipped->index : located->tracked->result.index);
  }
  return found;
}

TEST(FramePipeline, EachFrameIsExpectedOnceBeforeItIsLoaded) {
  const Numbers source;
  FramePipeline frames(source, numbers(0, 30), number_of, {.overlap = true});
  while (frames.next()) {
  }
  ASSERT_EQ(source.expected.size(), 29u);  // the first is loaded at once
  for (int i = 1; i < 30; ++i) {
    const auto [index, loaded] = source.expected[std::size_t(i) - 1];
    EXPECT_EQ(index, i);
    EXPECT_LE(loaded, i);
  }
}

TEST(FramePipeline, FramesComeInOrderTrackedOrSkipped) {
  const Numbers source;
  for (const bool overlap : {false, true}) {
    FramePipeline frames(source, numbers(1, 6), number_of, {.overlap = overlap});
    EXPECT_EQ(indices(frames), (std::vector<int>{1, 2, -3, 4, 5}));
    FramePipeline none(source, numbers(6, 6), number_of, {.overlap = overlap});
    EXPECT_EQ(indices(none), std::vector<int>{});
  }
}

TEST(FramePipeline, ErrorsOfAnyStageComeAfterTheFramesBefore) {
  Numbers source;
  source.error_at = 5;
  for (const bool overlap : {false, true}) {
    FramePipeline decoding(source, numbers(0, 9), number_of, {.overlap = overlap});
    const auto fails_at = [](int index) {
      return [index](const Frame& frame) {
        if (frame.index == index) throw OutputError("no pose", "frame", "give one");
        return number_of(frame);
      };
    };
    FramePipeline tracking(source, numbers(0, 9), fails_at(4), {.overlap = overlap});
    for (int i = 0; i < 5; ++i) ASSERT_TRUE(decoding.next()) << i;
    EXPECT_THROW(decoding.next(), InputError);
    for (int i = 0; i < 4; ++i) ASSERT_TRUE(tracking.next()) << i;
    EXPECT_THROW(tracking.next(), OutputError);
  }
}

TEST(FramePipeline, ReadsFewFramesAhead) {
  if (available_threads() < 2) GTEST_SKIP() << "one processor";
  const Numbers source;
  FramePipeline frames(source, numbers(10, 100), number_of, {});
  for (int taken = 0; taken < 10; ++taken) {
    while (source.loaded < taken + 2) std::this_thread::yield();  // one tracked, one decoded
    std::this_thread::sleep_for(1ms);                             // so that it could go on
    ASSERT_EQ(source.loaded, taken + 2);
    ASSERT_TRUE(frames.next());
  }
}

TEST(FramePipeline, AtARateFramesArriveWhenTheyAreDue) {
  const Numbers source;
  for (const bool overlap : {false, true}) {
    FramePipeline frames(source, numbers(0, 6), number_of, {.rate = 200, .overlap = overlap});
    const auto first = frames.next();
    for (int i = 1; i < 6; ++i) {
      const auto located = frames.next();
      EXPECT_EQ(located->arrival, first->arrival + i * 5ms);
      EXPECT_GE(located->tracking_began, located->arrival);
    }
  }
}

// However late its taker is, a live sensor's frame was there at its time.
TEST(FramePipeline, WaitingCountsAtARateAndNotWithoutOne) {
  const Numbers source;
  for (const double rate : {0.0, 1000.0}) {
    const auto slow = [](const Frame& frame) {
      std::this_thread::sleep_for(20ms);
      return number_of(frame);
    };
    FramePipeline frames(source, numbers(10, 14), slow, {.rate = rate});
    std::optional<LocatedFrame> last;
    while (auto located = frames.next()) last = std::move(located);
    const auto waited = last->tracking_began - last->arrival;
    EXPECT_TRUE(rate == 0 ? waited == 0ms : waited >= 3 * 20ms - 3ms);
  }
}

// A frame in hand has the processors for itself while the next one is far from due.
TEST(FramePipeline, AtARateWhatCanWaitWaitsForTheFrameInHand) {
  const Numbers source;
  std::atomic<int> settled = 0;
  std::stop_source stop;
  FramePipeline frames(source, numbers(0, 9), number_of,
                       {.rate = 1e-3, .stop = stop.get_token(), .settle = [&] { ++settled; }});
  ASSERT_TRUE(frames.next());
  std::this_thread::sleep_for(5ms);  // so that it could go on
  EXPECT_EQ(source.loaded, 1);
  EXPECT_EQ(settled, 1);  // before the first frame
  std::jthread taker([&] { EXPECT_FALSE(frames.next()); });
  while (source.loaded < 2 || settled < 2) std::this_thread::yield();
  stop.request_stop();
}

TEST(FramePipeline, AFrameInHandForLongHoldsUpNoOther) {
  const Numbers source;
  FramePipeline frames(source, numbers(10, 14), number_of, {.rate = 100});
  ASSERT_TRUE(frames.next());
  while (source.loaded < 2) std::this_thread::yield();  // it is about to be due
  EXPECT_TRUE(frames.next());
}

TEST(FramePipeline, AStopEndsTheWaitForAFrameNotDue) {
  const Numbers source;
  for (const bool overlap : {false, true}) {
    std::stop_source stop;
    FramePipeline frames(source, numbers(0, 9), number_of,
                         {.rate = 1e-3, .overlap = overlap, .stop = stop.get_token()});
    EXPECT_TRUE(frames.next());  // at once
    std::jthread interrupt([&] {
      std::this_thread::sleep_for(20ms);
      stop.request_stop();
    });
    EXPECT_FALSE(frames.next());  // not after a quarter of an hour
  }
}

TEST(FramePipeline, AStopLosesNoFrameThatWasTracked) {
  if (available_threads() < 2) GTEST_SKIP() << "one processor";
  const Numbers source;
  std::stop_source stop;
  std::atomic<int> tracked{0};
  const auto track = [&](const Frame& frame) {
    ++tracked;
    return number_of(frame);
  };
  FramePipeline frames(source, numbers(10, 100), track, {.stop = stop.get_token()});
  ASSERT_TRUE(frames.next());
  while (tracked < 2) std::this_thread::yield();
  stop.request_stop();
  EXPECT_EQ(indices(frames), std::vector<int>{11});
  EXPECT_EQ(tracked, 2);
}

}  // namespace fovea::frame_pipeline_test
