#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>
#include <set>
#include <thread>

#include "fovea/core/parallel.h"
#include "fovea/core/printable.h"
#include "fovea/core/random.h"
#include "fovea/errors.h"
#include "fovea/image.h"
#include "fovea/point_cloud.h"

namespace fovea::base_test {

TEST(Errors, ReadWhatWhereRemedy) {
  const InputError error("matrix has 11 numbers", "calib.txt:3", "restore the file");
  EXPECT_STREQ(error.what(), "matrix has 11 numbers, calib.txt:3, restore the file");
}

TEST(Printable, ControlCharactersDoNotReachATerminal) {
  EXPECT_EQ(printable("a\x1b[2Jb\n\x7f"), "a?[2Jb??");
  EXPECT_EQ(printable("Straße ~"), "Straße ~");
}

TEST(Image, BilinearIsExactOnLinearRampAndAtPixelCentres) {
  Image image(8, 6, 3);
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 8; ++x) {
      image.pixel(x, y)[0] = static_cast<std::uint8_t>(10 * x);
      image.pixel(x, y)[1] = static_cast<std::uint8_t>(20 * y);
      image.pixel(x, y)[2] = static_cast<std::uint8_t>(5 * x + 7 * y);
    }
  }
  for (const auto& [u, v] : {std::pair{0.0, 0.0}, {7.0, 5.0}, {2.25, 3.5}, {6.999, 0.125}}) {
    const Eigen::Vector3f expected(float(10 * u), float(20 * v), float(5 * u + 7 * v));
    EXPECT_LT((bilinear(image, u, v) - expected).norm(), 1e-4f) << u << ' ' << v;
  }
  EXPECT_EQ(bilinear(image, -3, 99), bilinear(image, 0, 5));  // clamped
}

TEST(Image, ColourRoundsAndClamps) {
  EXPECT_EQ(to_rgb(Eigen::Vector3f{-3.f, 12.5f, 300.f}), (Rgb{0, 13, 255}));
}

TEST(PointCloud, CheckNamesTheUnequalColumn) {
  PointCloud cloud;
  cloud.position.resize(3);
  cloud.range.resize(2);
  EXPECT_THROW(cloud.check(), std::logic_error);
  cloud.range.resize(3);
  EXPECT_NO_THROW(cloud.check());
}

TEST(PointCloud, SelectAndAppendKeepColumnsTogether) {
  PointCloud cloud;
  for (int i = 0; i < 5; ++i) {
    cloud.position.emplace_back(float(i), 0.f, 0.f);
    cloud.frame.push_back(i);
  }
  PointCloud chosen = cloud.select({4, 1});
  ASSERT_EQ(chosen.size(), 2u);
  EXPECT_EQ(chosen.frame[0], 4);
  EXPECT_EQ(chosen.position[1].x(), 1.f);
  EXPECT_TRUE(chosen.range.empty());
  chosen.append(cloud);
  EXPECT_EQ(chosen.size(), 7u);
  EXPECT_EQ(chosen.frame[6], 4);
  PointCloud other;
  other.position.resize(1);
  EXPECT_THROW(chosen.append(other), std::logic_error);
}

TEST(Parallel, SumIsTheSameAtAnyThreadCount) {
  const auto sum = [](int threads) {
    const ThreadLimit limit(threads);
    return parallel_sum(100'003, 1000, 0.0, [](std::size_t begin, std::size_t end) {
      double s = 0;
      for (std::size_t i = begin; i < end; ++i) s += std::sin(double(i)) * 1e-3;
      return s;
    });
  };
  const double one = sum(1);
  EXPECT_EQ(one, sum(2));
  EXPECT_EQ(one, sum(4));
}

TEST(Parallel, EveryItemOnce) {
  std::vector<std::atomic<int>> seen(1003);
  parallel_for(seen.size(), 17, [&](std::size_t i) { ++seen[i]; });
  for (const auto& count : seen) EXPECT_EQ(count, 1);
  parallel_for(0, 17, [&](std::size_t) { FAIL(); });
}

TEST(PointCloud, KeepsAsItSelects) {
  Random random(2);
  PointCloud cloud;
  for (int i = 0; i < 500; ++i) {
    cloud.position.push_back(Eigen::Vector3f::Constant(float(i)));
    cloud.range.push_back(float(i));
    cloud.color.push_back({std::uint8_t(i), 1, 2});
  }
  for (const double share : {0.0, 0.02, 0.5, 0.98, 1.0}) {
    for (const bool with_first : {false, true}) {
      std::vector<std::uint32_t> indices;
      for (std::uint32_t i = 0; i < cloud.size(); ++i) {
        if (i == 0 ? with_first : random.uniform() < share) indices.push_back(i);
      }
      const PointCloud selected = cloud.select(indices);
      PointCloud kept = cloud;
      kept.keep(indices);
      EXPECT_EQ(kept.position, selected.position);
      EXPECT_EQ(kept.range, selected.range);
      EXPECT_EQ(kept.color, selected.color);
      EXPECT_TRUE(kept.frame.empty());
      std::vector<std::uint8_t> marks(cloud.size(), 1);
      for (const std::uint32_t i : indices) marks[i] = 0;
      PointCloud rest = cloud;
      EXPECT_EQ(rest.drop(marks), cloud.size() - indices.size());
      EXPECT_EQ(rest.position, selected.position);
      EXPECT_EQ(rest.color, selected.color);
    }
  }
}

TEST(Parallel, BothRunAndEitherMayFail) {
  for (const int threads : {1, 2}) {
    const ThreadLimit limit(threads);
    int a = 0, b = 0;
    run_both([&] { a = 1; }, [&] { b = 2; });
    EXPECT_EQ(a, 1);
    EXPECT_EQ(b, 2);
    const auto fails = [] { throw InputError("a", "b", "c"); };
    EXPECT_THROW(run_both(fails, [] {}), InputError);
    EXPECT_THROW(run_both([] {}, fails), InputError);
  }
}

TEST(Parallel, LimitIsKept) {
  const auto threads_used = [](int limit) {
    const ThreadLimit guard(limit);
    std::mutex mutex;
    std::set<std::thread::id> seen;
    parallel_for(64, 1, [&](std::size_t) {
      std::this_thread::sleep_for(
          std::chrono::milliseconds(1));  // so that others would get a share
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
    });
    return seen.size();
  };
  EXPECT_EQ(threads_used(1), 1u);
  {
    const ThreadLimit guard(3);
    EXPECT_EQ(available_threads(), 3);
  }
  EXPECT_LE(threads_used(2), 2u);
}

TEST(Parallel, ErrorsReachTheCaller) {
  EXPECT_THROW(parallel_for(100, 1,
                            [](std::size_t i) {
                              if (i == 57) throw InputError("a", "b", "c");
                            }),
               InputError);
}

TEST(Random, UniformHasTheRightMoments) {
  Random random(7);
  double sum = 0, square = 0;
  constexpr int n = 100'000;
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform();
    sum += x;
    square += x * x;
  }
  EXPECT_NEAR(sum / n, 0.5, 0.005);
  EXPECT_NEAR(square / n, 1.0 / 3, 0.005);
  for (int i = 0; i < 1000; ++i) EXPECT_LT(random.below(6), 6u);
}

TEST(Random, NormalHasTheRightMomentsAndTails) {
  Random random(11);
  double sum = 0, square = 0, fourth = 0;
  int beyond_two = 0;
  constexpr int n = 200'000;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal();
    ASSERT_TRUE(std::isfinite(x));
    sum += x;
    square += x * x;
    fourth += x * x * x * x;
    if (std::abs(x) > 2) ++beyond_two;
  }
  // Five standard errors: 1, sqrt(2), sqrt(96) and sqrt(0.0434) over sqrt(n).
  const double five = 5 / std::sqrt(n);
  EXPECT_NEAR(sum / n, 0, five);
  EXPECT_NEAR(square / n, 1, five * std::sqrt(2));
  EXPECT_NEAR(fourth / n, 3, five * std::sqrt(96));
  EXPECT_NEAR(double(beyond_two) / n, 0.0455, five * std::sqrt(0.0434));
}

TEST(Random, QuickBitsAreUniformAndIndependentOfNeighboursAndKinds) {
  constexpr std::uint32_t n = 100'000;
  double sum = 0, square = 0, neighbours = 0, kinds = 0, halves = 0;
  const auto centred = [](std::uint32_t bits) { return double(bits) / 0x1p32 - 0.5; };
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t bits = quick_bits(i, 0x12345678u);
    const double x = centred(bits);
    sum += x;
    square += x * x;
    neighbours += x * centred(quick_bits(i + 1, 0x12345678u));
    kinds += x * centred(quick_bits(i, 0x12345679u));
    halves += x * (double(bits & 0xffff) / 0x1p16 - 0.5);
  }
  // Five standard errors of the means.
  const double five = 5 / std::sqrt(double(n)), variance = 1. / 12;
  EXPECT_NEAR(sum / n, 0, five * std::sqrt(variance));
  EXPECT_NEAR(square / n, variance, five * std::sqrt(1. / 180));
  EXPECT_NEAR(neighbours / n, 0, five * variance);
  EXPECT_NEAR(kinds / n, 0, five * variance);
  EXPECT_NEAR(halves / n, 0, five * variance);
}

TEST(Random, ItemsAreIndependent) {
  EXPECT_EQ(Random::of_item(1, 2, 3).next(), Random::of_item(1, 2, 3).next());
  EXPECT_NE(Random::of_item(1, 2, 3).next(), Random::of_item(1, 3, 2).next());
  EXPECT_NE(Random::of_item(1, 2, 3).next(), Random::of_item(2, 1, 3).next());
  // Neighbouring items do not correlate.
  double product = 0;
  constexpr int n = 100'000;
  for (int i = 0; i < n; ++i) {
    product += Random::of_item(1, 7, std::uint64_t(i)).normal() *
               Random::of_item(1, 7, std::uint64_t(i) + 1).normal();
  }
  EXPECT_NEAR(product / n, 0, 5 / std::sqrt(n));
}

}  // namespace fovea::base_test
