#include "fovea/world/noise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/random.h"

namespace fovea::noise_test {

Eigen::Vector2f random_place(Random& random, double half_width) {
  return {float(random.uniform(-half_width, half_width)),
          float(random.uniform(-half_width, half_width))};
}

/// Mean of f over the interval of width `footprint` around x.
template <class F>
double mean_around(double x, double footprint, F&& f) {
  constexpr int kSteps = 20'000;
  double sum = 0;
  for (int k = 0; k < kSteps; ++k) sum += f(x + ((k + 0.5) / kSteps - 0.5) * footprint);
  return sum / kSteps;
}

TEST(Noise, CellsAreUniformAndDoNotDependOnEachOther) {
  constexpr int kSide = 200;
  double sum = 0, sum2 = 0, neighbours = 0, seeds = 0;
  for (int x = -kSide / 2; x < kSide / 2; ++x) {
    for (int y = -kSide / 2; y < kSide / 2; ++y) {
      const double a = cell_random(x, y, 7);
      ASSERT_GE(a, 0);
      ASSERT_LT(a, 1);
      EXPECT_EQ(cell_random(x, y, 7), a);
      sum += a;
      sum2 += (a - 0.5) * (a - 0.5);
      neighbours += (a - 0.5) * (cell_random(x + 1, y, 7) + cell_random(x, y + 1, 7) - 1);
      seeds += (a - 0.5) * (cell_random(x, y, 8) - 0.5);
    }
  }
  const double n = kSide * kSide;
  EXPECT_NEAR(sum / n, 0.5, 5 / std::sqrt(12 * n));
  EXPECT_NEAR(sum2 / n, 1 / 12.0, 5 * std::sqrt(1 / 180.0 / n));
  EXPECT_NEAR(neighbours / n, 0, 5 * std::sqrt(2.0 / n) / 12);
  EXPECT_NEAR(seeds / n, 0, 5 / std::sqrt(n) / 12);
}

TEST(Noise, IsItsCellsAtWholePlacesAndStaysWithinOne) {
  Random random(1);
  float lowest = 0, highest = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Eigen::Vector2f p = random_place(random, 300);
    const float value = value_noise(p, 3);
    EXPECT_EQ(value_noise(p, 3), value);
    lowest = std::min(lowest, value);
    highest = std::max(highest, value);
    const int x = int(std::floor(p.x())), y = int(std::floor(p.y()));
    EXPECT_NEAR(value_noise({float(x), float(y)}, 3), 2 * cell_random(x, y, 3) - 1, 1e-6);
  }
  EXPECT_GE(lowest, -1);
  EXPECT_LE(highest, 1);
  EXPECT_LT(lowest, -0.9);  // it does vary
  EXPECT_GT(highest, 0.9);
}

TEST(Noise, IsSmooth) {
  Random random(2);
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector2f p = random_place(random, 40);
    const Eigen::Vector2f q = p + 1e-3f * Eigen::Vector2f(1, -1);
    // The steepest place of 3 x^2 - 2 x^3 has slope 1.5, along two axes, over a range of 2.
    EXPECT_LT(std::abs(value_noise(p, 3) - value_noise(q, 3)), 6.1e-3f);
  }
}

TEST(Noise, LayersFadeWithTheFootprint) {
  constexpr float kLongest = 3, kShortest = 0.1f;
  Random random(3);
  double energy[4] = {};
  const float footprints[4] = {0, 0.5f, 1.2f, 2.3f};
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector2f p = random_place(random, 100);
    for (int k = 0; k < 4; ++k) {
      const float value = layered_noise(p, kLongest, kShortest, footprints[k], 5);
      ASSERT_LT(std::abs(value), 1.5f);  // 0.6 + 0.36 + ...
      energy[k] += value * value;
    }
  }
  for (int k = 0; k < 3; ++k) EXPECT_GT(energy[k], 1.05 * energy[k + 1]) << k;
  EXPECT_EQ(energy[3], 0);  // three quarters of the longest wave: nothing is left
}

TEST(Noise, FinestLayerIsNotFinerThanAsked) {
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector2f p = random_place(random, 10);
    const Eigen::Vector2f q = p + Eigen::Vector2f(1e-3f, 0);
    EXPECT_LT(std::abs(layered_noise(p, 2, 1, 0, 5) - layered_noise(q, 2, 1, 0, 5)), 3e-3f);
  }
}

TEST(Noise, ResolvesWhatIsLargerThanTheFootprint) {
  EXPECT_EQ(resolved(1, 0), 1);
  EXPECT_EQ(resolved(1, 0.5f), 1);
  EXPECT_FLOAT_EQ(resolved(1, 1), 0.5f);
  EXPECT_EQ(resolved(1, 1.5f), 0);
  EXPECT_EQ(resolved(0, 1), 0);
}

TEST(Band, IsTheShareOfTheInterval) {
  for (const double footprint : {1e-3, 0.05, 0.4, 3.0}) {
    for (const double x : {-2.0, -0.21, -0.2, 0.0, 0.149, 0.3, 0.31, 1.4}) {
      const double expected =
          mean_around(x, footprint, [](double y) { return y >= -0.2 && y <= 0.3 ? 1.0 : 0.0; });
      EXPECT_NEAR(band(float(x), -0.2f, 0.3f, float(footprint)), expected, 2e-4)
          << x << ' ' << footprint;
    }
  }
  EXPECT_EQ(band(0.29f, -0.2f, 0.3f, 0), 1);
  EXPECT_EQ(band(0.31f, -0.2f, 0.3f, 0), 0);
}

TEST(Band, RepeatsExactly) {
  const double period = 0.75, width = 0.25;
  for (const double footprint : {1e-3, 0.05, 0.4, 0.75, 3.0}) {
    for (const double x : {-2.0, -0.25, 0.0, 0.149, 0.3, 0.7, 0.80, 1.4, 41.93}) {
      const double expected = mean_around(x, footprint, [&](double y) {
        return y - period * std::floor(y / period) < width ? 1.0 : 0.0;
      });
      EXPECT_NEAR(repeated_band(float(x), float(period), float(width), float(footprint)), expected,
                  4e-3)
          << x << ' ' << footprint;
    }
  }
}

// Markings of a road are metres of way; a drive is kilometres long.
TEST(Band, RepeatsExactlyFarFromItsBegin) {
  for (const double x : {5000.0, 5000.125, 5000.25, 5000.5, -5000.0, -4999.875}) {
    const double into = x - std::floor(x);  // exact: a power of two
    for (const float footprint : {1e-3f, 0.0625f}) {
      const double expected = mean_around(
          into, footprint, [](double y) { return y - std::floor(y) < 0.25 ? 1.0 : 0.0; });
      EXPECT_NEAR(repeated_band(float(x), 1, 0.25f, footprint), expected, 2e-3)
          << x << ' ' << footprint;
    }
  }
}

}  // namespace fovea::noise_test
