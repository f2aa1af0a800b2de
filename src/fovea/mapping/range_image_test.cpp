#include "fovea/mapping/range_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fovea::range_image_test {

/// A scan of 64 rings, or fewer with a larger spacing. The sensor is in a round room of `radius` m,
/// 1.7 m above the floor. `nearer` gives nearer returns (m; 0: none).
template <class Nearer>
std::vector<Eigen::Vector3f> room_scan(float radius, Nearer&& nearer, int every = 1) {
  std::vector<Eigen::Vector3f> scan;
  for (int ring = 0; ring < 64; ring += every) {
    const float elevation = (2.0f - 0.42f * float(ring)) * std::numbers::pi_v<float> / 180;
    for (int k = 0; k < 2000; ++k) {
      const float azimuth = (float(k) - 1000) * std::numbers::pi_v<float> / 1000;
      const Eigen::Vector3f ray(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      float range = radius / std::cos(elevation);
      if (elevation < 0) range = std::min(range, 1.7f / -std::sin(elevation));
      const float object = nearer(azimuth, elevation);
      scan.push_back(ray * (object > 0 ? std::min(object, range) : range));
    }
  }
  return scan;
}

float nothing(float, float) { return 0; }

TEST(RangeImage, ClassifiesFreeSurfaceAndUnknown) {
  const RangeImage image(room_scan(20, nothing));
  EXPECT_EQ(image.visibility({10, 0, -0.5f}), Visibility::kFree);
  EXPECT_EQ(image.visibility({-4, -3, -0.3f}), Visibility::kFree);
  EXPECT_EQ(image.visibility({20, 0, -0.5f}), Visibility::kSurface);
  EXPECT_EQ(image.visibility({-19.8f, 0, -0.5f}), Visibility::kSurface);
  EXPECT_EQ(image.visibility({25, 0, -0.5f}), Visibility::kUnknown) << "behind the wall";
  EXPECT_EQ(image.visibility({5, 0, 3}), Visibility::kUnknown) << "above the highest beam";
  EXPECT_EQ(image.visibility({0.1f, 0, 0}), Visibility::kUnknown);
}

TEST(RangeImage, SparseRingsNeedHighRows) {
  // Sixteen rings, 1.7 degrees apart. Of rows of 0.6 degrees, two of three have no return.
  const std::vector<Eigen::Vector3f> scan = room_scan(20, nothing, 4);
  const RangeImage narrow(scan), image(scan, 1.85 * std::numbers::pi / 180);
  std::size_t places = 0, free_in_narrow = 0;
  for (float y = -6; y < 6; y += 0.5f) {
    const Eigen::Vector3f place(13, y, -0.5f);
    EXPECT_EQ(image.visibility(place), Visibility::kFree) << y;
    free_in_narrow += narrow.visibility(place) == Visibility::kFree ? 1 : 0;
    ++places;
  }
  EXPECT_LT(free_in_narrow, places / 2);
  EXPECT_EQ(image.visibility({20, 0, -0.5f}), Visibility::kSurface);
  EXPECT_EQ(image.visibility({25, 0, -0.5f}), Visibility::kUnknown) << "behind the wall";
  for (float x = 3; x < 25; x += 0.37f) {
    EXPECT_NE(image.visibility({x, 1, -1.7f}), Visibility::kFree) << "the floor at " << x;
  }
}

TEST(RangeImage, TheFloorIsNeverFree) {
  const RangeImage image(room_scan(60, nothing));
  for (float x = 3; x < 25; x += 0.37f) {
    for (const float z : {-1.7f, -1.6f}) {
      EXPECT_NE(image.visibility({x, 1, z}), Visibility::kFree) << x << " " << z;
    }
  }
}

TEST(RangeImage, AThinPoleIsSeenAndItsShadowUnknown) {
  // 2 cm wide at 8 m: one ray in each ring.
  const RangeImage image(room_scan(
      20, [](float azimuth, float) { return std::abs(azimuth) < 0.0016f ? 8.0f : 0.0f; }));
  EXPECT_EQ(image.visibility({8, 0, -0.2f}), Visibility::kSurface);
  EXPECT_EQ(image.visibility({8, 0.1f, -0.2f}), Visibility::kSurface);
  EXPECT_EQ(image.visibility({12, 0, -0.2f}), Visibility::kUnknown);
  EXPECT_EQ(image.visibility({8, 1, -0.2f}), Visibility::kFree);
}

TEST(RangeImage, DirectionsWithoutReturnsAreUnknown) {
  std::vector<Eigen::Vector3f> scan = room_scan(20, nothing);
  std::erase_if(scan, [](const Eigen::Vector3f& p) { return p.x() > 0 && std::abs(p.y()) < 6; });
  EXPECT_EQ(RangeImage(scan).visibility({10, 0, -0.5f}), Visibility::kUnknown);
  EXPECT_EQ(RangeImage({}).visibility({10, 0, -0.5f}), Visibility::kUnknown);
  scan.assign(3, Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()));
  EXPECT_EQ(RangeImage(scan).visibility({10, 0, -0.5f}), Visibility::kUnknown);
}

}  // namespace fovea::range_image_test
