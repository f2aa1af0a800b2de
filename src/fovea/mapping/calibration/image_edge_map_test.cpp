#include "fovea/mapping/calibration/image_edge_map.h"

#include <gtest/gtest.h>

namespace fovea::image_edge_map_test {

constexpr double kFocal = 360;
constexpr int kFinest = ImageEdgeMap::kLevels - 1;

/// Dark before the pixel `place` and bright after it, to the right (upright) or downwards.
Image step_image(int width, int height, int place, bool upright, int step = 100, int scale = 1) {
  Image image(width * scale, height * scale, 1);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const bool past = (upright ? x : y) >= place * scale;
      image.pixel(x, y)[0] = static_cast<std::uint8_t>(past ? 80 + step : 80);
    }
  }
  return image;
}

TEST(ImageEdgeMap, IsHighestAtAStep) {
  const ImageEdgeMap map(step_image(300, 120, 150, true), kFocal);
  for (int level = 0; level < ImageEdgeMap::kLevels; ++level) {
    const float at = map.at(level, 149.5f, 60, 1);
    EXPECT_GT(at, 1) << level;
    const auto width = float(ImageEdgeMap::kWidths[std::size_t(level)] * kFocal);
    float before = at;
    for (const float away : {0.7f * width, 1.3f * width, 2 * width}) {
      const float left = map.at(level, 149.5f - away, 60, 1),
                  right = map.at(level, 149.5f + away, 60, 1);
      EXPECT_LT(left, before) << level << " " << away;
      EXPECT_NEAR(left, right, 0.7) << level << " " << away;
      before = std::max(left, right);
    }
    EXPECT_LT(map.at(level, 20, 60, 1), 0) << level;
  }
}

// The coarse levels show an edge from afar.
TEST(ImageEdgeMap, IsWiderAtCoarseLevels) {
  const ImageEdgeMap map(step_image(300, 120, 150, true), kFocal);
  for (int level = 1; level < ImageEdgeMap::kLevels; ++level) {
    const auto drop = [&](int l) { return map.at(l, 149.5f, 60, 1) - map.at(l, 140, 60, 1); };
    EXPECT_GT(drop(level), drop(level - 1)) << level;
  }
}

TEST(ImageEdgeMap, SeparatesUprightFromLevelEdges) {
  const ImageEdgeMap upright(step_image(300, 120, 150, true), kFocal);
  EXPECT_GT(upright.at(kFinest, 150, 60, 1), 1);
  EXPECT_NEAR(upright.at(kFinest, 150, 60, 0), 0, 1e-4);  // no level edge anywhere
  EXPECT_NEAR(upright.at(kFinest, 150, 60, 0.25f), 0.25f * upright.at(kFinest, 150, 60, 1), 1e-4);
  const ImageEdgeMap level(step_image(300, 120, 60, false), kFocal);
  EXPECT_GT(level.at(kFinest, 150, 60, 0), 1);
  EXPECT_NEAR(level.at(kFinest, 150, 60, 1), 0, 1e-4);
}

TEST(ImageEdgeMap, IsZeroOutsideTheImage) {
  const ImageEdgeMap map(step_image(300, 120, 1, true), kFocal);
  EXPECT_NE(map.at(kFinest, 0, 60, 1), 0);
  EXPECT_NE(map.at(kFinest, 299, 119, 1), 0);
  for (const auto& [u, v] : {std::pair(-0.6f, 60.0f),
                             {0.0f, -0.6f},
                             {299.6f, 60.0f},
                             {1.0f, 119.6f},
                             {-1e6f, 60.0f},
                             {1e6f, 1e6f}}) {
    EXPECT_EQ(map.at(kFinest, u, v, 1), 0) << u << " " << v;
  }
}

TEST(ImageEdgeMap, HasAMeanOfZero) {
  const ImageEdgeMap map(step_image(300, 120, 100, true), kFocal);
  for (int level = 0; level < ImageEdgeMap::kLevels; ++level) {
    double sum = 0;
    for (int y = 0; y < 120; ++y) {
      for (int x = 0; x < 300; ++x) sum += double(map.at(level, float(x), float(y), 1));
    }
    EXPECT_NEAR(sum / (300 * 120), 0, 1e-3) << level;
  }
}

// Foliage does not outweigh a plain wall's corner.
TEST(ImageEdgeMap, ComparesAnEdgeWithItsNeighborhood) {
  Image image = step_image(400, 120, 330, true, 30);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < 200; ++x) image.pixel(x, y)[0] = x / 2 % 2 == 0 ? 40 : 220;
  }
  const ImageEdgeMap map(image, kFocal);
  EXPECT_GT(map.at(kFinest, 330, 60, 1), map.at(kFinest, 100, 60, 1));
}

TEST(ImageEdgeMap, AnImageWithoutEdgesIsZero) {
  Image noisy(100, 80, 1);
  for (std::size_t i = 0; i < noisy.data.size(); ++i) {
    noisy.data[i] = static_cast<std::uint8_t>(100 + i % 3);  // below the noise
  }
  const ImageEdgeMap map(noisy, kFocal);
  for (int level = 0; level < ImageEdgeMap::kLevels; ++level) {
    EXPECT_NEAR(map.at(level, 50, 40, 0.5f), 0, 1e-5) << level;
  }
}

// A map of an image that is three times as large has the same values at the same directions.
TEST(ImageEdgeMap, IsTheSameAtAnyResolution) {
  const ImageEdgeMap small(step_image(300, 120, 150, true), kFocal),
      large(step_image(300, 120, 150, true, 100, 3), 3 * kFocal);
  for (float u = 120; u < 180; u += 2.5f) {
    // Pixel centers are at integers: the block of small pixel u has its center at 3 u + 1.
    EXPECT_NEAR(large.at(kFinest, 3 * u + 1, 181, 1), small.at(kFinest, u, 60, 1), 1e-4) << u;
  }
}

TEST(ImageEdgeMap, OfNoImageIsZero) {
  EXPECT_EQ(ImageEdgeMap(Image(), kFocal).at(0, 0, 0, 0.5f), 0);
}

}  // namespace fovea::image_edge_map_test
