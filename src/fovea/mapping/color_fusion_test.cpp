#include "fovea/mapping/color_fusion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "fovea/core/image.h"
#include "fovea/core/random.h"

namespace fovea::color_fusion_test {

struct SeenView {
  Eigen::Vector3f color;
  std::uint16_t weight;
};

void put(FusedColors& points, std::size_t i, const FusedColor& point) {
  const Rgb color = to_rgb(point.color);
  points.red[i] = color.r;
  points.green[i] = color.g;
  points.blue[i] = color.b;
  points.views[i] = point.views;
  points.spread[i] = point.spread;
  points.weight[i] = point.weight;
}

FusedColor get(const FusedColors& points, std::size_t i) {
  return {{points.red[i], points.green[i], points.blue[i]},
          points.views[i],
          points.spread[i],
          points.weight[i]};
}

void put(ColorObservations& seen, std::size_t i, const SeenView& view, std::uint64_t noise) {
  seen.color.red[i] = view.color.x();
  seen.color.green[i] = view.color.y();
  seen.color.blue[i] = view.color.z();
  seen.weight[i] = view.weight;
  seen.noise[0][i] = static_cast<std::uint32_t>(noise);
  seen.noise[1][i] = static_cast<std::uint32_t>(noise >> 32);
}

FusedColor fuse(const FusedColor& point, const Eigen::Vector3f& color, std::uint16_t weight,
                std::uint64_t noise) {
  FusedColors points;
  ColorObservations seen;
  put(points, 0, point);
  put(seen, 0, {color, weight}, noise);
  fuse(points, seen, 1);
  return get(points, 0);
}

/// The fused color without rounding.
struct Exact {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double deviation = 0;
};

Exact exact(const std::vector<SeenView>& views) {
  Exact result;
  double weight = 0;
  for (const SeenView& view : views) {
    result.mean += view.weight * view.color.cast<double>();
    weight += view.weight;
  }
  result.mean /= weight;
  double sum = 0;
  for (const SeenView& view : views) {
    sum += view.weight * (view.color.cast<double>() - result.mean).squaredNorm() / 3;
  }
  result.deviation = std::sqrt(sum / weight);
  return result;
}

FusedColor fuse_all(const std::vector<SeenView>& views, std::uint64_t seed) {
  Random random(seed);
  FusedColor fused;
  for (const SeenView& view : views) fused = fuse(fused, view.color, view.weight, random.next());
  return fused;
}

/// Means over many points with the same views.
struct Average {
  Eigen::Vector3d color = Eigen::Vector3d::Zero();
  double spread = 0;
  double deviation = 0;  // of a point's color from the average, RMS of channels
};

Average average(const std::vector<SeenView>& views, int points) {
  Average result;
  std::vector<Eigen::Vector3d> colors;
  for (int i = 0; i < points; ++i) {
    const FusedColor fused = fuse_all(views, std::uint64_t(i) * 977 + 5);
    colors.push_back(to_float(fused.color).cast<double>());
    result.color += colors.back() / points;
    result.spread += double(fused.spread) / points;
  }
  for (const Eigen::Vector3d& color : colors) {
    result.deviation += (color - result.color).squaredNorm() / (3.0 * points);
  }
  result.deviation = std::sqrt(result.deviation);
  return result;
}

std::vector<SeenView> random_views(std::size_t count, double sigma, std::uint64_t seed) {
  Random random(seed);
  std::vector<SeenView> views;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d color(90.3 + sigma * random.normal(), 120.8 + sigma * random.normal(),
                                60.5 + sigma * random.normal());
    views.push_back({color.cast<float>(), static_cast<std::uint16_t>(5 + random.below(20))});
  }
  // The first view's color is rounded to the nearest and does not count here.
  views[0].color = to_float(to_rgb(views[0].color));
  return views;
}

TEST(ColorFusion, TheFirstViewIsTheColor) {
  const FusedColor fused = fuse({}, {10.4f, 200.6f, 300.f}, 17, ~std::uint64_t{0});
  EXPECT_EQ(fused.color, (Rgb{10, 201, 255}));
  EXPECT_EQ(fused.views, 1);
  EXPECT_EQ(fused.spread, 0);
  EXPECT_EQ(fused.weight, 17);
}

TEST(ColorFusion, TwoViewsGiveTheWeightedMeanAndDeviation) {
  const FusedColor first = fuse({}, {100, 50, 200}, 10, 0);
  const FusedColor fused = fuse(first, {140, 50, 160}, 30, 0);
  EXPECT_EQ(fused.color, (Rgb{130, 50, 170}));
  EXPECT_EQ(fused.views, 2);
  EXPECT_EQ(fused.weight, 40);
  // Channels deviate by 17.32, 0 and 17.32: 14.14 together, rounded down without noise, ...
  EXPECT_EQ(fused.spread, 14);
  EXPECT_EQ(fuse(first, {140, 50, 160}, 30, ~std::uint64_t{0}).spread, 15);  // ... or up
}

TEST(ColorFusion, TwoSetsOfViewsFuseIntoOne) {
  // Weight 40: mean 130 50 170, mean square deviation (300 + 0 + 300) / 3; weight 60: 180 100 90.
  const FusedColor a{{130, 50, 170}, 2, 14, 40}, b{{180, 100, 90}, 3, 5, 60};
  const FusedColor both = fused(a, b);
  EXPECT_EQ(both.color, (Rgb{160, 80, 122}));
  EXPECT_EQ(both.views, 5);
  EXPECT_EQ(both.weight, 100);
  const double square = (2 * 50.0 * 50 + 80.0 * 80) / 3;
  EXPECT_NEAR(both.spread, std::sqrt(0.4 * 14 * 14 + 0.6 * 5 * 5 + 0.24 * square), 0.5);
  const FusedColor unseen;
  EXPECT_EQ(fused(a, unseen).color, a.color);
  EXPECT_EQ(fused(unseen, a).weight, a.weight);
  const FusedColor many{{1, 2, 3}, 250, 0, 65000};
  EXPECT_EQ(fused(many, many).views, 255);
  EXPECT_EQ(fused(many, many).weight, 65535);
  EXPECT_EQ(fused(many, many).color, many.color);
}

TEST(ColorFusion, RoundsUpWithTheProbabilityOfTheFraction) {
  const FusedColor first = fuse({}, {100, 100, 100}, 10, 0);
  Random random(1);
  int up = 0;
  constexpr int kDraws = 20'000;
  for (int i = 0; i < kDraws; ++i) {
    const Rgb color = to_rgb(fuse(first, {103, 103, 103}, 1, random.next()).color);  // mean 100.27
    for (const int channel : {color.r, color.g, color.b}) {
      ASSERT_TRUE(channel == 100 || channel == 101);
      up += channel - 100;
    }
  }
  EXPECT_NEAR(up / (3.0 * kDraws), 3.0 / 11, 0.008);  // 4 standard deviations
}

// Steps of late views are far below one gray value; rounding to the nearest would lose them.
TEST(ColorFusion, TheAverageOverPointsIsTheWeightedMean) {
  for (const std::size_t count : {2u, 5u, 20u, 200u}) {
    for (const double sigma : {3.0, 10.0}) {
      const std::vector<SeenView> views = random_views(count, sigma, count);
      const Exact truth = exact(views);
      const Average fused = average(views, 20'000);
      EXPECT_LT((fused.color - truth.mean).cwiseAbs().maxCoeff(), 0.05) << count << " " << sigma;
      EXPECT_NEAR(fused.spread, truth.deviation, 0.05 * sigma + 0.2) << count << " " << sigma;
    }
  }
}

// The rounding of a step of |d| / n gray values has at most that variance, and later views reduce
// its error in proportion. The total variance is |d| / 2 for any number of views.
TEST(ColorFusion, RoundingNoiseDoesNotGrowWithTheViews) {
  for (const std::size_t count : {5u, 30u, 250u}) {
    const double sigma = 8, mean_difference = sigma * std::sqrt(2 / 3.14159265);
    const Average fused = average(random_views(count, sigma, count), 5'000);
    EXPECT_GT(fused.deviation, 0.2) << count;
    EXPECT_LT(fused.deviation, std::sqrt(mean_difference / 2) + 0.3) << count;
  }
}

TEST(ColorFusion, ABlockIsFusedAsEachPointAlone) {
  Random random(6);
  const auto byte = [&] { return static_cast<std::uint8_t>(random.below(256)); };
  constexpr std::size_t kPoints = 251;
  std::vector<FusedColor> alone(kPoints);
  FusedColors points;
  ColorObservations seen;
  for (std::size_t i = 0; i < kPoints; ++i) {
    FusedColor point;
    point = {{byte(), byte(), byte()}, byte(), byte(), static_cast<std::uint16_t>(byte() + 1)};
    if (i % 7 == 0) point.views = 0;  // the other values are then meaningless
    const SeenView view{{float(byte()), float(byte()), float(byte())},
                        static_cast<std::uint16_t>(1 + random.below(100))};
    const std::uint64_t noise = random.next();
    put(points, i, point);
    put(seen, i, view, noise);
    alone[i] = fuse(point, view.color, view.weight, noise);
    if (i % 7 == 0) {
      EXPECT_EQ(alone[i].color, to_rgb(view.color));
      EXPECT_EQ(alone[i].weight, view.weight);
      EXPECT_EQ(alone[i].spread, 0);
      EXPECT_EQ(alone[i].views, 1);
    }
  }
  fuse(points, seen, kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const FusedColor together = get(points, i);
    ASSERT_EQ(together.color, alone[i].color) << i;
    ASSERT_EQ(together.views, alone[i].views) << i;
    ASSERT_EQ(together.spread, alone[i].spread) << i;
    ASSERT_EQ(together.weight, alone[i].weight) << i;
  }
}

TEST(ColorFusion, LateChangesStillArrive) {
  std::vector<SeenView> views(50, {{80, 80, 80}, 10});
  views.resize(100, {{120, 120, 120}, 10});
  const Average fused = average(views, 10'000);
  EXPECT_NEAR(fused.color.x(), 100, 0.05);
  EXPECT_NEAR(fused.spread, 20, 0.3);
}

TEST(ColorFusion, OneColorStays) {
  const FusedColor fused = fuse_all(std::vector<SeenView>(300, {{0, 255, 128}, 13}), 3);
  EXPECT_EQ(fused.color, (Rgb{0, 255, 128}));
  EXPECT_EQ(fused.spread, 0);
}

TEST(ColorFusion, ViewsAndWeightsSaturate) {
  FusedColor fused;
  Random random(2);
  for (int i = 1; i <= 2000; ++i) {
    fused = fuse(fused, {50, 60, 70}, 100, random.next());
    ASSERT_EQ(fused.views, std::min(i, 255));
    ASSERT_EQ(fused.weight, std::min(100 * i, 65535));
  }
  EXPECT_EQ(fused.color, (Rgb{50, 60, 70}));
  // From there on later views count as if the former weight were the largest.
  Average average_color;
  constexpr int kPoints = 20'000;
  for (int i = 0; i < kPoints; ++i) {
    average_color.color +=
        to_float(fuse(fused, {250, 60, 70}, 100, random.next()).color).cast<double>() / kPoints;
  }
  EXPECT_NEAR(average_color.color.x(), 50 + 200 * 100.0 / 65535, 0.02);
}

TEST(ColorFusion, ColorsStayInRange) {
  Random random(4);
  for (int i = 0; i < 2000; ++i) {
    const FusedColor before{{255, 0, 255}, 3, 255, 30};
    const FusedColor fused = fuse(before, {255, 0, 0}, 10, random.next());
    ASSERT_EQ(to_rgb(fused.color).r, 255);
    ASSERT_EQ(to_rgb(fused.color).g, 0);
    ASSERT_NEAR(to_rgb(fused.color).b, 191.25, 1);
  }
}

TEST(ViewWeight, FallsWithTheDistance) {
  EXPECT_EQ(view_weight(1), 100);
  EXPECT_EQ(view_weight(4), 25);
  EXPECT_EQ(view_weight(15), 7);
  std::uint16_t last = view_weight(0);
  EXPECT_EQ(last, 100);
  for (float distance = 0.1f; distance < 500; distance *= 1.07f) {
    const std::uint16_t weight = view_weight(distance);
    ASSERT_LE(weight, last);
    ASSERT_GE(weight, 1);
    last = weight;
  }
  EXPECT_EQ(last, 1);
}

}  // namespace fovea::color_fusion_test
