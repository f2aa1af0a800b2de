#include "fovea/pipeline/frame_reader.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "fovea/errors.h"
#include "fovea/pipeline/numbered_frames.h"

namespace fovea::frame_reader_test {

using namespace std::chrono_literals;

TEST(FrameReader, EachFrameIsExpectedOnceBeforeItIsLoaded) {
  const NumberedFrames source;
  FrameReader reader(source, numbers(0, 30), /*rate=*/0);
  while (reader.next({})) {
  }
  ASSERT_EQ(source.expected.size(), 29u);  // the first is loaded at once
  for (int i = 1; i < 30; ++i) {
    const auto [index, loaded] = source.expected[std::size_t(i) - 1];
    EXPECT_EQ(index, i);
    EXPECT_LE(loaded, i);
  }
}

TEST(FrameReader, AtARateFramesComeWhenTheyAreDue) {
  const NumberedFrames source;
  FrameReader reader(source, numbers(0, 6), /*rate=*/200);
  const auto first = reader.next({});
  for (int i = 1; i < 6; ++i) {
    const auto frame = reader.next({});
    EXPECT_EQ(frame->due, *first->due + i * 5ms);
    EXPECT_GE(WallClock::now(), *frame->due);
  }
  EXPECT_FALSE(reader.next({}));
}

TEST(FrameReader, AtARateAFrameIsDecodedShortlyBeforeItIsDue) {
  const NumberedFrames source;
  FrameReader reader(source, numbers(0, 9), /*rate=*/1e-3);
  ASSERT_TRUE(reader.next({}));
  std::jthread waiting([&](const std::stop_token& stop) { EXPECT_FALSE(reader.next(stop)); });
  std::this_thread::sleep_for(5ms);
  EXPECT_EQ(source.loaded, 1);
}

TEST(FrameReader, AStopEndsTheWaitForAFrame) {
  const NumberedFrames source;
  FrameReader reader(source, numbers(0, 9), /*rate=*/1e-3);
  EXPECT_TRUE(reader.next({}));  // at once
  std::stop_source stop;
  const std::jthread interrupt([&] {
    std::this_thread::sleep_for(20ms);
    stop.request_stop();
  });
  EXPECT_FALSE(reader.next(stop.get_token()));  // not after a quarter of an hour
}

}  // namespace fovea::frame_reader_test
