#include "fovea/drive/live/frame_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fovea::frame_queue_test {

constexpr TimeNs kMs = 1'000'000, kStep = 100 * kMs;

namespace {

std::shared_ptr<const LiveScan> scan(TimeNs stamp) {
  return std::make_shared<const LiveScan>(LiveScan{"", stamp, {}});
}
std::shared_ptr<const LiveImage> image(TimeNs stamp, std::size_t bytes = 10) {
  return std::make_shared<const LiveImage>(LiveImage{"c", stamp, std::string(bytes, 'x')});
}

}  // namespace

/// A queue of one camera, whose images come 10 ms after the scans.
class FrameQueueTest : public testing::Test {
 protected:
  FrameQueueTest() { queue_.use({{}, {0}, {}, {{10 * kMs, 60 * kMs}}, kStep}, 4); }

  void add_scan(TimeNs stamp) { queue_.add_scan(scan(stamp), {}); }
  FrameQueue::Added add_image(TimeNs stamp) { return queue_.add_image(0, image(stamp)); }
  /// Stamp of the image of the next frame; absent: it has none.
  std::optional<TimeNs> next_image() {
    const RawFrame frame = queue_.take();
    if (!frame.images.at(0)) return std::nullopt;
    return frame.images[0]->stamp;
  }

  FrameQueue queue_{0, 1, {}};
};

TEST_F(FrameQueueTest, TakesTheNearestImage) {
  add_scan(0);
  for (const TimeNs stamp : {-20 * kMs, 5 * kMs, 16 * kMs}) add_image(stamp);
  EXPECT_EQ(next_image(), 5 * kMs);
}

TEST_F(FrameQueueTest, TakesNoImageBeyondTheTolerance) {
  add_scan(0);
  add_image(-51 * kMs);
  EXPECT_EQ(next_image(), std::nullopt);
}

TEST_F(FrameQueueTest, LeavesAnImageToTheNextScanThatItIsNearerTo) {
  add_scan(0);
  add_scan(80 * kMs);
  add_image(55 * kMs);
  EXPECT_EQ(next_image(), std::nullopt);
  EXPECT_EQ(next_image(), 55 * kMs);
}

TEST_F(FrameQueueTest, ExpectsTheNextScanByThePeriod) {
  add_scan(0);
  add_image(65 * kMs);
  EXPECT_EQ(next_image(), std::nullopt);
  add_scan(kStep);
  EXPECT_EQ(next_image(), 65 * kMs);
}

TEST_F(FrameQueueTest, TakesAnImageOnce) {
  add_scan(0);
  add_scan(kStep);
  add_image(58 * kMs);
  EXPECT_EQ(next_image(), 58 * kMs);
  EXPECT_EQ(next_image(), std::nullopt);
}

TEST_F(FrameQueueTest, WaitsForAnImageAtTheExpectedTime) {
  add_scan(0);
  EXPECT_FALSE(queue_.is_complete());
  add_image(-40 * kMs);
  EXPECT_FALSE(queue_.is_complete());
  add_image(10 * kMs);
  EXPECT_TRUE(queue_.is_complete());
}

TEST_F(FrameQueueTest, DoesNotWaitForAnImageThatASteadyCameraTakesLater) {
  for (int i = 0; i < 10; ++i) add_image(i * kStep + 5 * kMs);  // 5 ms early
  add_scan(9 * kStep);
  EXPECT_TRUE(queue_.is_complete());
  EXPECT_EQ(next_image(), 9 * kStep + 5 * kMs);
}

TEST_F(FrameQueueTest, DoesNotWaitForASlowCamera) {
  for (int i = 0; i < 10; ++i) add_image(3 * i * kStep + 10 * kMs);
  add_scan(28 * kStep);
  EXPECT_TRUE(queue_.is_complete());
  EXPECT_EQ(next_image(), std::nullopt);
}

TEST_F(FrameQueueTest, DoesNotWaitForACameraThatHasStopped) {
  add_image(0);
  for (int i = 1; i < 21; ++i) {
    add_scan(i * kStep);
    EXPECT_EQ(queue_.is_complete(), i * kStep + 10 * kMs > kStoppedAfter) << i;
    queue_.take();
  }
}

TEST_F(FrameQueueTest, WaitsForACameraAfterAPause) {
  add_image(10 * kMs);
  add_scan(0);
  EXPECT_EQ(next_image(), 10 * kMs);
  add_scan(100 * kStep);
  EXPECT_FALSE(queue_.is_complete());
}

TEST_F(FrameQueueTest, KeepsTheImagesOfScansThatWait) {
  FrameQueueLimits limits;
  limits.image_bytes = 100;
  FrameQueue queue(0, 1, limits);
  queue.use({{}, {0}, {}, {{10 * kMs, 60 * kMs}}, kStep}, 4);
  for (int i = 0; i < 4; ++i) {
    queue.add_scan(scan(i * kStep), {});
    for (const TimeNs phase : {10, 35, 60, 85}) {
      queue.add_image(0, image(i * kStep + phase * kMs, 12));  // 8 of 16 fit
    }
  }
  for (int i = 0; i < 4; ++i) {
    const RawFrame frame = queue.take();
    ASSERT_TRUE(frame.images[0]);
    EXPECT_EQ(frame.images[0]->stamp, i * kStep + 10 * kMs);
  }
}

TEST_F(FrameQueueTest, CountsImagesAfterTheirFrame) {
  add_scan(0);
  EXPECT_EQ(next_image(), std::nullopt);
  EXPECT_EQ(add_image(-70 * kMs), FrameQueue::Added::kTaken);  // of no scan
  EXPECT_EQ(add_image(-70 * kMs), FrameQueue::Added::kOutOfOrder);
  EXPECT_EQ(add_image(12 * kMs), FrameQueue::Added::kLate);
  EXPECT_EQ(add_image(70 * kMs), FrameQueue::Added::kTaken);  // of the next scan
  EXPECT_EQ(queue_.images(0).unused(), 1u);
}

TEST_F(FrameQueueTest, AFastCameraHasImagesOfNoScanAndNoneIsLate) {
  for (int i = 0; i < 5; ++i) {
    add_scan(i * kStep);
    EXPECT_EQ(add_image(i * kStep + 10 * kMs), FrameQueue::Added::kTaken);
    EXPECT_EQ(next_image(), i * kStep + 10 * kMs);
    EXPECT_EQ(add_image(i * kStep + 40 * kMs), FrameQueue::Added::kTaken);
    EXPECT_EQ(add_image(i * kStep + 75 * kMs), FrameQueue::Added::kTaken);
  }
  EXPECT_EQ(queue_.images(0).unused(), 8u);
}

TEST_F(FrameQueueTest, AFloodOfImagesDoesNotGrow) {
  for (int i = 0; i < 1'000'000; ++i) add_image(i * kMs);
  EXPECT_LE(queue_.images(0).items().size(), 1024u);
  EXPECT_GT(queue_.images(0).items().size(), 100u);
  EXPECT_FALSE(queue_.has_room_for_image(0));
  for (int i = 0; i < 100; ++i) queue_.add_image(0, image(1000 * kNsPerSecond + i, 10 << 20));
  EXPECT_LE(queue_.images(0).bytes(), std::size_t(64) << 20);
  // Slow images: a few seconds of them.
  for (int i = 0; i < 1000; ++i) add_image(2000 * kNsPerSecond + i * kNsPerSecond);
  EXPECT_LE(queue_.images(0).items().size(), 5u);
}

TEST_F(FrameQueueTest, AnImageOverTheBoundIsKeptAlone) {
  add_scan(0);
  queue_.add_image(0, image(10 * kMs, 70 << 20));
  EXPECT_EQ(next_image(), 10 * kMs);
}

TEST_F(FrameQueueTest, DropsTheOldestOfTooManyScans) {
  for (int i = 0; i < 6; ++i) add_scan(i * kStep);
  EXPECT_EQ(queue_.scans().size(), 4u);
  EXPECT_EQ(queue_.scans_dropped(), 2u);
  EXPECT_EQ(queue_.take().stamp, 2 * kStep);
  EXPECT_EQ(queue_.add_scan(scan(5 * kStep), {}), FrameQueue::Added::kOutOfOrder);
}

}  // namespace fovea::frame_queue_test
