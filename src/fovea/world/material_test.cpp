#include "fovea/world/material.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fovea/core/random.h"

namespace fovea::material_test {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kPatterns = 13;

/// A material of each pattern, as a city has them.
Material of_pattern(Pattern pattern) {
  Material m;
  m.pattern = pattern;
  m.color = {0.45f, 0.30f, 0.20f};
  m.color_2 = {0.10f, 0.60f, 0.55f};
  m.seed = 41;
  switch (pattern) {
    case Pattern::kChecker:
      m.scale = 0.3f;
      break;
    case Pattern::kRoad:
      m.size = {5.7f, 6.0f};
      m.color = Vector3f::Constant(0.12f);
      m.color_2 = Vector3f::Constant(0.73f);
      break;
    case Pattern::kSlabs:
      m.size = {0.8f, 0.4f};
      break;
    case Pattern::kBricks:
      m.size = {0.24f, 0.075f};
      break;
    case Pattern::kBoards:
      m.scale = 0.12f;
      break;
    case Pattern::kLettering:
      m.size = {3.2f, 0.55f};
      m.text = "BICYCLES";
      break;
    case Pattern::kFacade:
      m.size = {2.6f, 3.0f};
      break;
    default:
      break;
  }
  return m;
}

/// Places as a surface of that pattern has them.
Vector3f random_place(Pattern pattern, Random& random) {
  if (pattern == Pattern::kLettering) {
    return {float(random.uniform(0.2, 3)), float(random.uniform(0.1, 0.45)), 0};
  }
  if (pattern == Pattern::kRoad) {
    return {float(random.uniform(-5.7, 5.7)), float(random.uniform(0, 160)), 0};
  }
  return {float(random.uniform(-40, 40)), float(random.uniform(-40, 40)),
          float(random.below(30)) + 0.5f};
}

/// Albedo as point samples see it in the mean of a square.
Vector3f mean_albedo(const Material& m, const Vector3f& place, float side, Random& random) {
  constexpr int kSteps = 20;
  Vector3f sum = Vector3f::Zero();
  for (int x = 0; x < kSteps; ++x) {
    for (int y = 0; y < kSteps; ++y) {
      const Vector3f offset((float(x) + float(random.uniform())) / kSteps - 0.5f,
                            (float(y) + float(random.uniform())) / kSteps - 0.5f, 0);
      sum += albedo(m, place + side * offset, 0);
    }
  }
  return sum / (kSteps * kSteps);
}

struct Errors {
  double bias = 0, rms = 0, worst = 0;
};

Errors footprint_errors(const Material& m, float footprint) {
  constexpr int kPlaces = 120;
  Random random(17);
  Vector3f bias = Vector3f::Zero();
  Errors errors;
  for (int i = 0; i < kPlaces; ++i) {
    const Vector3f place = random_place(m.pattern, random);
    const Vector3f error = albedo(m, place, footprint) - mean_albedo(m, place, footprint, random);
    bias += error / kPlaces;
    errors.rms += error.squaredNorm() / 3 / kPlaces;
    errors.worst = std::max(errors.worst, double(error.cwiseAbs().maxCoeff()));
  }
  errors.bias = bias.cwiseAbs().maxCoeff();
  errors.rms = std::sqrt(errors.rms);
  return errors;
}

TEST(Material, PatternNamesRoundTrip) {
  for (int k = 0; k < kPatterns; ++k) {
    const auto pattern = static_cast<Pattern>(k);
    EXPECT_EQ(parse_pattern(to_string(pattern)), pattern);
    for (int j = 0; j < k; ++j) EXPECT_NE(to_string(pattern), to_string(static_cast<Pattern>(j)));
  }
  EXPECT_EQ(to_string(Pattern::kBricks), "bricks");
  EXPECT_EQ(to_string(Pattern::kFacade), "facade");
  EXPECT_THROW(parse_pattern("marble"), std::invalid_argument);
  EXPECT_THROW(parse_pattern(""), std::invalid_argument);
}

TEST(Material, AlbedoLiesBetweenBlackAndWhite) {
  for (int k = 0; k < kPatterns; ++k) {
    Random random(3);
    Material m = of_pattern(static_cast<Pattern>(k));
    for (const float level : {0.0f, 0.4f, 1.0f}) {
      m.color = Vector3f(level, 1, 0.3f);
      for (int i = 0; i < 500; ++i) {
        const auto footprint = float(std::exp(random.uniform(-7, 1)));
        const Vector3f a = albedo(m, random_place(m.pattern, random), footprint);
        EXPECT_TRUE(a.minCoeff() >= 0 && a.maxCoeff() <= 1 && a.allFinite())
            << to_string(m.pattern) << ' ' << a.transpose();
      }
    }
  }
}

TEST(Material, PlainIsPlain) {
  const Material m = of_pattern(Pattern::kPlain);
  EXPECT_EQ(albedo(m, {1, 2, 3}, 0.1f), m.color);
}

TEST(Material, EveryOtherPatternVaries) {
  for (int k = 1; k < kPatterns; ++k) {
    Random random(4);
    const Material m = of_pattern(static_cast<Pattern>(k));
    Vector3f low = Vector3f::Ones(), high = Vector3f::Zero();
    for (int i = 0; i < 300; ++i) {
      const Vector3f a = albedo(m, random_place(m.pattern, random), 0.002f);
      low = low.cwiseMin(a);
      high = high.cwiseMax(a);
    }
    EXPECT_GT((high - low).maxCoeff(), 0.05f) << to_string(m.pattern);
  }
}

TEST(Material, CheckerIsExact) {
  const Material m = of_pattern(Pattern::kChecker);
  const auto at = [&](float x, float y, float f) { return albedo(m, {x, y, 0}, f); };
  EXPECT_LT((at(0.1f, 0.1f, 0) - m.color).norm(), 1e-6f);
  EXPECT_LT((at(0.4f, 0.1f, 0) - m.color_2).norm(), 1e-6f);
  EXPECT_LT((at(0.4f, 0.4f, 0) - m.color).norm(), 1e-6f);
  EXPECT_LT((at(-0.1f, 0.1f, 0) - m.color_2).norm(), 1e-6f);
  const Vector3f half = 0.5f * (m.color + m.color_2);
  EXPECT_LT((at(0.3f, 0.1f, 0.1f) - half).norm(), 1e-6f);    // on an edge
  EXPECT_LT((at(0.3f, 0.3f, 0.1f) - half).norm(), 1e-6f);    // on a corner
  EXPECT_LT((at(0.17f, 0.22f, 0.6f) - half).norm(), 1e-5f);  // over a whole period
  const Vector3f quarter = m.color + 0.25f * (m.color_2 - m.color);
  EXPECT_LT((at(0.275f, 0.1f, 0.1f) - quarter).norm(), 1e-6f);
  const Errors errors = footprint_errors(m, 0.13f);
  EXPECT_LT(errors.worst, 0.01);  // of the sampling
}

// What "band-limited" means. Noise fades sooner than its mean over a square does, so that a single
// place may differ by what the noise still has there; the mean over places must not.
TEST(Material, AlbedoOfAFootprintIsTheMeanOverIt) {
  for (int k = 0; k < kPatterns; ++k) {
    const Material m = of_pattern(static_cast<Pattern>(k));
    const bool noisy = m.pattern == Pattern::kBark || m.pattern == Pattern::kGrass;
    for (const float footprint : {0.003f, 0.01f, 0.03f, 0.1f, 0.3f, 1.0f}) {
      const Errors errors = footprint_errors(m, footprint);
      EXPECT_LT(errors.bias, noisy ? 0.01 : 0.005) << to_string(m.pattern) << ' ' << footprint;
      EXPECT_LT(errors.rms, noisy ? 0.06 : 0.022) << to_string(m.pattern) << ' ' << footprint;
      EXPECT_LT(errors.worst, noisy ? 0.18 : 0.08) << to_string(m.pattern) << ' ' << footprint;
    }
  }
}

TEST(Srgb, RoundTripsEveryNumber) {
  for (int i = 0; i < 256; ++i) {
    const Rgb color{std::uint8_t(i), std::uint8_t(255 - i), std::uint8_t(i)};
    EXPECT_EQ(encode_srgb(decode_srgb(color)), color);
  }
}

TEST(Srgb, IsTheStandards) {
  EXPECT_EQ(decode_srgb({0, 0, 0}), Vector3f::Zero());
  EXPECT_EQ(decode_srgb({255, 255, 255}), Vector3f::Ones());
  EXPECT_NEAR(decode_srgb({188, 0, 0}).x(), 0.5029f, 1e-4f);
  EXPECT_NEAR(decode_srgb({10, 0, 0}).x(), 10 / 255.0f / 12.92f, 1e-6f);
  EXPECT_EQ(encode_srgb({0.5f, -1, 7}), (Rgb{188, 0, 255}));
  EXPECT_GT(encode_srgb_float({2, 0, 0}).x(), 255);
  for (float x = 0; x < 1; x += 0.001f) {
    const Vector3f encoded = encode_srgb_float({x, x + 0.001f, -x});
    EXPECT_LT(encoded.x(), encoded.y());
    EXPECT_EQ(encoded.z(), 0);
  }
}

}  // namespace fovea::material_test
