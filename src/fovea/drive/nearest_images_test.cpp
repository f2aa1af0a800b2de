#include "fovea/drive/nearest_images.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fovea::nearest_images_test {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

constexpr TimeNs kMs = 1'000'000;

TEST(NearestImages, ScansGetTheImageNearestInTime) {
  // A camera of 30 Hz beside a LiDAR of 10 Hz, 4 ms late.
  NumberedTimes scans, images;
  for (int i = 0; i < 4; ++i) scans[i] = i * 100 * kMs;
  for (int i = 0; i < 12; ++i) images[100 + i] = i * 33 * kMs + 4 * kMs;
  const ImageMatches matches = match_nearest(scans, images, 0, 0.02);
  EXPECT_THAT(matches.image_of_scan,
              ElementsAre(Pair(0, 100), Pair(1, 103), Pair(2, 106), Pair(3, 109)));
  EXPECT_NEAR(matches.max_delay, 0.004, 1e-12);
  EXPECT_NEAR(matches.min_delay, 0.001, 1e-12);
  EXPECT_NEAR(matches.median_delay, 0.003, 1e-12);
}

TEST(NearestImages, ACameraHalfWayBetweenScansStaysOnOneSide) {
  NumberedTimes scans, images;
  for (int i = 0; i < 20; ++i) {
    scans[i] = i * 100 * kMs;
    images[i] = i * 100 * kMs + 50 * kMs + (i % 3 - 1) * 2 * kMs;  // and some jitter
  }
  const ImageMatches matches = match_nearest(scans, images, 0, 0.06);
  ASSERT_GE(matches.image_of_scan.size(), 19u);
  const int side = matches.image_of_scan.begin()->second - matches.image_of_scan.begin()->first;
  for (const auto& [scan, image] : matches.image_of_scan) EXPECT_EQ(image - scan, side);
  EXPECT_LT(matches.max_delay - matches.min_delay, 0.0041);
}

TEST(NearestImages, ScansStampedAtTheirBeginningGetTheImageOfTheirMiddle) {
  NumberedTimes scans, images;
  for (int i = 0; i < 5; ++i) {
    scans[i] = i * 100 * kMs;
    images[i] = i * 100 * kMs + 50 * kMs;
  }
  const ImageMatches matches = match_nearest(scans, images, 0.05, 0.06);
  ASSERT_EQ(matches.image_of_scan.size(), 5u);
  for (const auto& [scan, image] : matches.image_of_scan) EXPECT_EQ(image, scan);
  EXPECT_NEAR(matches.median_delay, 0.05, 1e-12);
}

TEST(NearestImages, NoneBeyondTheToleranceAndNoneTwice) {
  const NumberedTimes scans = {{0, 0}, {1, 100 * kMs}, {2, 200 * kMs}};
  const ImageMatches far = match_nearest(scans, {{0, 30 * kMs}, {7, 195 * kMs}}, 0, 0.02);
  EXPECT_THAT(far.image_of_scan, ElementsAre(Pair(2, 7)));
  EXPECT_NEAR(far.median_delay, -0.005, 1e-12);
  // One image between two scans is the nearer one's.
  EXPECT_THAT(match_nearest(scans, {{5, 60 * kMs}}, 0, 0.1).image_of_scan, ElementsAre(Pair(1, 5)));
  EXPECT_THAT(match_nearest(scans, {{5, 50 * kMs}}, 0, 0.1).image_of_scan, ElementsAre(Pair(0, 5)));
  EXPECT_THAT(match_nearest(scans, {}, 0, 0.1).image_of_scan, IsEmpty());
  EXPECT_THAT(match_nearest({}, {{0, 0}}, 0, 0.1).image_of_scan, IsEmpty());
}

}  // namespace fovea::nearest_images_test
