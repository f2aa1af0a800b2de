#include "fovea/mapping/depth_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "fovea/core/random.h"

namespace fovea::depth_buffer_test {

Camera camera_of(int width, int height) {
  return {
      0, width, height, 100, 100, (width - 1) / 2.0, (height - 1) / 2.0, RigidMotion::Identity()};
}

/// @param radius  pixels
void add(DepthBuffer& buffer, const Eigen::Vector2f& pixel, float depth, float radius) {
  ProjectedPoints samples;
  samples.put(0, pixel, depth);
  buffer.add(samples, 1, radius * depth);
}

TEST(DepthBuffer, AnEmptyBufferHidesNothing) {
  const DepthBuffer buffer(camera_of(100, 50));
  EXPECT_FALSE(buffer.hides({0, 0}, 1000.f));
  EXPECT_FALSE(buffer.hides({99, 49}, 1000.f));
}

TEST(DepthBuffer, HidesOnlyPointsBehindASample) {
  DepthBuffer buffer(camera_of(100, 50));
  add(buffer, {40, 20}, 5, 6);
  const float margin = DepthBuffer::kBehind + DepthBuffer::kBehindShare * 5.2f;
  EXPECT_FALSE(buffer.hides({40, 20}, 4));
  EXPECT_FALSE(buffer.hides({40, 20}, 5));
  EXPECT_FALSE(buffer.hides({40, 20}, 5 + margin - 0.02f));
  EXPECT_TRUE(buffer.hides({40, 20}, 5 + margin + 0.02f));
  EXPECT_TRUE(buffer.hides({40, 20}, 100));
  for (const Eigen::Vector2f& inside :
       {Eigen::Vector2f(45, 20), {35, 20}, {40, 25}, {40, 15}, {45, 25}}) {
    EXPECT_TRUE(buffer.hides(inside, 8)) << inside.transpose();
  }
  for (const Eigen::Vector2f& outside :
       {Eigen::Vector2f(48, 20), {32, 20}, {40, 28}, {40, 12}, {90, 40}}) {
    EXPECT_FALSE(buffer.hides(outside, 8)) << outside.transpose();
  }
}

TEST(DepthBuffer, TheNearestSampleCounts) {
  DepthBuffer buffer(camera_of(100, 50));
  add(buffer, {40, 20}, 5, 2);
  add(buffer, {40, 20}, 3, 2);
  add(buffer, {40, 20}, 9, 2);
  EXPECT_TRUE(buffer.hides({40, 20}, 4));
  EXPECT_FALSE(buffer.hides({40, 20}, 3.1f));
}

TEST(DepthBuffer, ASampleCoversAtLeastItsOwnPixel) {
  DepthBuffer buffer(camera_of(100, 50));
  for (float u = 0; u <= 99; u += 0.37f) {
    for (float v = 0; v <= 49; v += 1.13f) {
      DepthBuffer alone(camera_of(100, 50));
      add(alone, {u, v}, 2, 0);
      ASSERT_TRUE(alone.hides({u, v}, 3)) << u << " " << v;
    }
  }
}

TEST(DepthBuffer, CornersOfEvenAndOddImagesAreInside) {
  for (const auto& [width, height] : {std::pair(100, 50), {101, 51}, {1, 1}, {2, 3}}) {
    for (const float u : {0.f, float(width - 1)}) {
      for (const float v : {0.f, float(height - 1)}) {
        for (const float radius : {0.f, 3.f, 100.f}) {
          DepthBuffer buffer(camera_of(width, height));
          add(buffer, {u, v}, 2, radius);
          ASSERT_TRUE(buffer.hides({u, v}, 3));
          ASSERT_FALSE(buffer.hides({u, v}, 2));
        }
      }
    }
  }
}

// Ground at a grazing angle, sampled every 2 cm. It does not hide itself, although discs of near
// samples overlap farther ones. It hides points below it.
TEST(DepthBuffer, ASlantSurfaceDoesNotHideItself) {
  Camera camera = camera_of(1242, 375);
  camera.fx = camera.fy = 720;
  DepthBuffer buffer(camera);
  constexpr double kHeight = 1.65;
  const auto pixel_of = [&](double x, double y, double z) -> Eigen::Vector2f {
    return camera.project({x, y, z})->cast<float>();
  };
  std::vector<std::pair<Eigen::Vector2f, float>> samples;
  for (double z = 5; z < 15; z += 0.02) {
    for (double x = -2; x <= 2; x += 0.02) {
      const Eigen::Vector2f pixel = pixel_of(x, kHeight, z);
      if (!camera.in_view(pixel.cast<double>())) continue;
      samples.emplace_back(pixel, static_cast<float>(z));
      add(buffer, pixel, samples.back().second, static_cast<float>(0.75 * 0.02 * camera.fx / z));
    }
  }
  ASSERT_GT(samples.size(), 50'000u);
  std::size_t hidden = 0;
  for (const auto& [pixel, depth] : samples) hidden += buffer.hides(pixel, depth);
  EXPECT_LT(double(hidden), 0.01 * double(samples.size()));
  for (double z = 7; z < 11; z += 0.1) {
    EXPECT_TRUE(buffer.hides(pixel_of(0.3, kHeight * 1.3, z * 1.3), static_cast<float>(z * 1.3)));
  }
}

TEST(DepthBuffer, ABlockOfSamplesAndAJoinedBufferAreAsAllOneByOne) {
  const Camera camera = camera_of(101, 51);
  DepthBuffer one_by_one(camera), first(camera), second(camera);
  Random random(1);
  ProjectedPoints samples;
  for (int half = 0; half < 2; ++half) {
    for (std::size_t i = 0; i < ProjectedPoints::kSize; ++i) {
      const Eigen::Vector2f pixel(float(random.uniform(0, 100)), float(random.uniform(0, 50)));
      const auto depth = static_cast<float>(random.uniform(1, 9));
      samples.put(i, pixel, depth);
      add(one_by_one, pixel, depth, 7 / depth);
    }
    (half == 0 ? first : second).add(samples, ProjectedPoints::kSize, 7);
  }
  first.add(second);
  for (float u = 0; u <= 100; ++u) {
    for (float v = 0; v <= 50; ++v) {
      for (float depth = 0.5; depth < 10; depth += 0.37f) {
        ASSERT_EQ(first.hides({u, v}, depth), one_by_one.hides({u, v}, depth)) << u << " " << v;
      }
    }
  }
}

/// Plain version of DepthBuffer::add() for one sample: all pixels within the radius.
/// @param pixel, radius  pixels of the buffer
void add_plainly(const Eigen::Vector2f& pixel, float depth, float radius, int width, int height,
                 std::vector<float>& depths) {
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (std::abs(float(x) - pixel.x()) > radius || std::abs(float(y) - pixel.y()) > radius) {
        continue;
      }
      float& nearest = depths[static_cast<std::size_t>(y * width + x)];
      nearest = std::min(nearest, depth);
    }
  }
}

// Most samples cover at most 2 x 2 pixels, a case of its own.
TEST(DepthBuffer, SamplesOfEachSizeCoverThePixelsWithinTheirRadius) {
  constexpr int kWidth = 61, kHeight = 31;  // of the buffer
  for (const float radius : {0.2f, 0.6f, 0.9f, 1.3f, 3.2f}) {
    DepthBuffer buffer(camera_of(2 * kWidth - 1, 2 * kHeight - 1));
    std::vector<float> plain(kWidth * kHeight, std::numeric_limits<float>::infinity());
    Random random(3);
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector2f pixel(float(random.uniform(0, 2 * kWidth - 2)),
                                  float(random.uniform(0, 2 * kHeight - 2)));
      const auto depth = static_cast<float>(random.uniform(1, 9));
      add(buffer, pixel, depth, 2 * radius);
      add_plainly(pixel / 2, depth, std::max(radius, 0.5f), kWidth, kHeight, plain);
    }
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const float front = plain[static_cast<std::size_t>(y * kWidth + x)];
        const Eigen::Vector2f pixel = 2 * Eigen::Vector2f(float(x), float(y));
        EXPECT_FALSE(buffer.hides(pixel, std::min(front, 100.f))) << radius << " " << pixel;
        EXPECT_EQ(buffer.hides(pixel, front + 1), front < 100) << radius << " " << pixel;
      }
    }
  }
}

TEST(DepthBuffer, VisiblePointsAreThoseThatNothingHides) {
  DepthBuffer buffer(camera_of(101, 51));
  Random random(2);
  const auto any_pixel = [&] {
    return Eigen::Vector2f(float(random.uniform(0, 100)), float(random.uniform(0, 50)));
  };
  const auto any_depth = [&] { return float(random.uniform(1, 9)); };
  for (int i = 0; i < 300; ++i) add(buffer, any_pixel(), any_depth(), 1);
  for (const std::size_t count : {0, 1, 37, 256}) {
    ProjectedPoints points;
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Eigen::Vector2f pixel = any_pixel();
      points.put(i, pixel, any_depth());
      if (!buffer.hides(pixel, points.depth[i])) expected.push_back(i);
    }
    std::array<std::uint32_t, ProjectedPoints::kSize> visible;
    const std::size_t found = buffer.find_visible(points, count, visible);
    EXPECT_EQ(std::vector(visible.begin(), visible.begin() + std::ptrdiff_t(found)), expected);
  }
}

// A board at 5 m before a wall at 10 m.
TEST(DepthBuffer, EdgesOfDepthAreDoubtful) {
  DepthBuffer buffer(camera_of(100, 60));
  for (int x = 0; x < 100; ++x) {
    for (int y = 0; y < 60; ++y) add(buffer, {float(x), float(y)}, x < 50 ? 5 : 10, 1);
  }
  EXPECT_FALSE(buffer.is_doubtful({50, 30}));  // not asked for yet
  buffer.find_edges();
  for (int x = 4; x < 96; ++x) {
    const bool at_edge = std::abs(x - 50) <= 1;
    if (at_edge || std::abs(x - 50) > 4) {
      EXPECT_EQ(buffer.is_doubtful({float(x), 30}), at_edge) << x;
    }
  }
}

TEST(DepthBuffer, TheBorderOfWhatIsKnownIsDoubtfulAndASlantSurfaceIsNot) {
  DepthBuffer buffer(camera_of(100, 60));
  for (int x = 20; x < 80; ++x) {
    for (int y = 0; y < 60; ++y) add(buffer, {float(x), float(y)}, 5 + 0.03f * float(x), 1);
  }
  buffer.find_edges();
  EXPECT_TRUE(buffer.is_doubtful({20, 30}));
  EXPECT_TRUE(buffer.is_doubtful({79, 30}));
  for (int x = 26; x < 74; ++x) EXPECT_FALSE(buffer.is_doubtful({float(x), 30})) << x;
}

TEST(DepthBuffer, DoubtReachesAsFarAsItsRadius) {
  DepthBuffer buffer(camera_of(100, 60));
  buffer.doubt({40, 20}, 10);
  buffer.doubt({99, 59}, 10);
  buffer.doubt({-200, 20}, 10);
  for (int x = 0; x < 100; ++x) {
    for (int y = 0; y < 60; ++y) {
      const double distance = std::min(std::hypot(x - 40, y - 20), std::hypot(x - 99, y - 59));
      if (std::abs(distance - 10) > 2) {
        ASSERT_EQ(buffer.is_doubtful({float(x), float(y)}), distance < 10) << x << " " << y;
      }
    }
  }
}

}  // namespace fovea::depth_buffer_test
