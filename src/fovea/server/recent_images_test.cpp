#include "fovea/server/recent_images.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/core/random.h"

namespace fovea::recent_images_test {

constexpr int kSide = 64;  // pixels
constexpr std::size_t kRawSize = std::size_t{3} * kSide * kSide;
constexpr int kFirst = 100;  // frame

/// A live drive with the cameras 2 and 3, which continues a map of 100 frames.
static DriveInfo robot() {
  DriveInfo drive;
  drive.kind = kLiveDrive;
  drive.calibration.cameras.resize(2);
  drive.calibration.cameras[0].index = 2;
  drive.calibration.cameras[1].index = 3;
  drive.begin = kFirst;
  drive.end = kFirst + 10;
  return drive;
}

/// Noise, which hardly compresses.
static Image noise(Random& random) {
  Image image(kSide, kSide, 3);
  for (auto& value : image.data) value = static_cast<std::uint8_t>(random.below(256));
  return image;
}

class RecentImagesOfRobot : public testing::Test {
 protected:
  static Frame frame(int index, std::vector<Image> images) {
    Frame frame;
    frame.index = index;
    frame.images = std::move(images);
    return frame;
  }
  static WebResponse get(const RecentImages& images, int frame, int camera) {
    return images.response(fmt::format("images/{}/{}.jpg", frame, camera));
  }

  Random random_{1};
};

TEST_F(RecentImagesOfRobot, ImagesOfTheLatestFramesAreJpegs) {
  RecentImages images(robot());
  images.add(frame(kFirst, {noise(random_), noise(random_)}));
  images.add(frame(kFirst + 1, {noise(random_), noise(random_)}));
  for (const int index : {kFirst, kFirst + 1}) {
    for (const int camera : {2, 3}) {
      const WebResponse image = get(images, index, camera);
      EXPECT_EQ(image.status, 200);
      EXPECT_EQ(image.type, "image/jpeg");
      EXPECT_THAT(*image.body, testing::StartsWith("\xff\xd8"));
    }
  }
  EXPECT_NE(*get(images, kFirst, 2).body, *get(images, kFirst, 3).body);
  EXPECT_NE(*get(images, kFirst, 2).body, *get(images, kFirst + 1, 2).body);
}

TEST_F(RecentImagesOfRobot, AnImageThatNeverWasIsNotFound) {
  RecentImages images(robot());
  images.add(frame(kFirst, {noise(random_), Image()}));
  EXPECT_EQ(get(images, kFirst, 3).status, 404);      // missing
  EXPECT_EQ(get(images, kFirst, 7).status, 404);      // no such camera
  EXPECT_EQ(get(images, kFirst + 1, 2).status, 404);  // not yet mapped
  EXPECT_EQ(images.response("images/100/2.png").status, 404);
}

TEST_F(RecentImagesOfRobot, ImagesOfAnEarlierRunAreNoLongerKept) {
  const RecentImages images(robot());
  EXPECT_EQ(get(images, kFirst - 1, 2).status, 410);
  EXPECT_EQ(get(images, kFirst, 2).status, 404);
}

TEST_F(RecentImagesOfRobot, MemoryIsBoundedAndTheOldestFramesLeave) {
  constexpr std::size_t kCapacity = 7 * kRawSize;
  RecentImages images(robot(), kCapacity);
  constexpr int kEnd = kFirst + 200;
  for (int index = kFirst; index < kEnd; ++index) {
    images.add(frame(index, {noise(random_), noise(random_)}));
  }
  std::size_t bytes = 0;
  int kept = 0;
  for (int index = kFirst; index < kEnd; ++index) {
    const bool is_kept = get(images, index, 2).status == 200;
    EXPECT_EQ(get(images, index, 3).status, is_kept ? 200 : 410);
    EXPECT_TRUE(is_kept || kept == 0) << "a later frame has left before frame " << index;
    kept += is_kept;
    if (is_kept) bytes += get(images, index, 2).body->size() + get(images, index, 3).body->size();
  }
  EXPECT_GE(kept, 3);  // as many as fit without compression
  EXPECT_LE(bytes, kCapacity);
}

TEST_F(RecentImagesOfRobot, TheNewestFrameStaysHoweverLarge) {
  RecentImages images(robot(), /*capacity=*/1);
  for (const int index : {kFirst, kFirst + 1}) {
    images.add(frame(index, {noise(random_), noise(random_)}));
  }
  EXPECT_EQ(get(images, kFirst, 2).status, 410);
  EXPECT_EQ(get(images, kFirst + 1, 2).status, 200);
}

}  // namespace fovea::recent_images_test
