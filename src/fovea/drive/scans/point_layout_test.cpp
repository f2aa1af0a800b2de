#include "fovea/drive/scans/point_layout.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>
#include <random>
#include <vector>

#include "fovea/core/angle.h"

namespace fovea::point_layout_test {

using Numbers = std::vector<double>;

/// Points of a street that a spinning LiDAR of 32 rings sees: ground, and walls at both sides.
/// @return x, y, z, intensity (0-255), ring, time of each
std::vector<Numbers> street(bool ring_by_ring, int columns = 360) {
  constexpr int kRings = 32;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> intensity(0, 255);
  std::vector<Numbers> points;
  for (int i = 0; i < columns * kRings; ++i) {
    const int ring = ring_by_ring ? i / columns : i % kRings;
    const int column = ring_by_ring ? i % columns : i / kRings;
    const double elevation = (-25 + ring) * kDegree,
                 azimuth = 2 * std::numbers::pi * column / columns;
    const double to_wall = 8 / std::max(std::abs(std::sin(azimuth)), 0.1);
    const double to_ground = elevation < 0 ? 1.7 / std::tan(-elevation) : 1e9;
    const double distance = std::min(to_wall, to_ground);
    points.push_back({distance * std::cos(azimuth), distance * std::sin(azimuth),
                      distance * std::tan(elevation), std::floor(intensity(random)), double(ring),
                      0.1 * column / columns});
  }
  return points;
}

template <class Float>
std::vector<std::uint8_t> bytes_of(const std::vector<Numbers>& points,
                                   const std::vector<int>& columns) {
  std::vector<std::uint8_t> bytes;
  for (const Numbers& point : points) {
    for (const int column : columns) {
      // -1 is padding with 0, -2 is padding with 1.
      const auto value = static_cast<Float>(column == -1   ? 0
                                            : column == -2 ? 1
                                                           : point[std::size_t(column)]);
      std::uint8_t raw[sizeof value];
      std::memcpy(raw, &value, sizeof value);
      bytes.insert(bytes.end(), raw, raw + sizeof value);
    }
  }
  return bytes;
}

TEST(PointLayout, TheNumbersOfAPointAreFoundInAnyOrderOfPoints) {
  for (const bool ring_by_ring : {true, false}) {
    const std::vector<Numbers> points = street(ring_by_ring);
    const auto found = [&](const std::vector<int>& columns) {
      return numbers_per_point(bytes_of<float>(points, columns));
    };
    EXPECT_EQ(found({0, 1, 2}), 3u) << ring_by_ring;
    EXPECT_EQ(found({0, 1, 2, 3}), 4u) << ring_by_ring;
    EXPECT_EQ(found({0, 1, 2, 3, 4}), 5u) << ring_by_ring;
    EXPECT_EQ(found({0, 1, 2, 3, 5}), 5u) << ring_by_ring;
    EXPECT_EQ(found({0, 1, 2, 3, 4, 5}), 6u) << ring_by_ring;
    EXPECT_EQ(found({0, 1, 2, -2, 3, -1, -1, -1}), 8u) << ring_by_ring;  // PCL's XYZI
    EXPECT_EQ(numbers_per_point(bytes_of<double>(points, {0, 1, 2, 3})), 8u) << ring_by_ring;
  }
}

TEST(PointLayout, PartsOfAScanAndScaledIntensitiesAreFound) {
  std::vector<Numbers> points = street(false);
  std::erase_if(points, [](const Numbers& p) { return p[0] < 0 || p[1] < 0; });  // one quadrant
  EXPECT_EQ(numbers_per_point(bytes_of<float>(points, {0, 1, 2, 3})), 4u);
  EXPECT_EQ(numbers_per_point(bytes_of<float>(points, {0, 1, 2, 3, 4})), 5u);
  for (Numbers& point : points) point[3] /= 255;
  EXPECT_EQ(numbers_per_point(bytes_of<float>(points, {0, 1, 2, 3})), 4u);
  EXPECT_EQ(numbers_per_point(bytes_of<float>(points, {0, 1, 2, 3, 4})), 5u);
  for (Numbers& point : points) point[3] = 0;
  EXPECT_EQ(numbers_per_point(bytes_of<float>(points, {0, 1, 2, 3})), 4u);
  EXPECT_EQ(numbers_per_point(bytes_of<float>(points, {0, 1, 2, 3, 4})), 5u);
}

TEST(PointLayout, FewValuesAndNoiseDecideNothing) {
  std::vector<Numbers> points = street(false);
  points.resize(25);
  EXPECT_EQ(numbers_per_point(bytes_of<float>(points, {0, 1, 2, 3, 4})), std::nullopt);
  std::mt19937 random(5);
  std::vector<std::uint8_t> noise(80'000);
  for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
  EXPECT_EQ(numbers_per_point(noise), std::nullopt);
  EXPECT_EQ(numbers_per_point(std::vector<std::uint8_t>(16'000)), std::nullopt);
}

}  // namespace fovea::point_layout_test
