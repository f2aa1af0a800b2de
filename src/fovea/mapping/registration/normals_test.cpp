#include "fovea/mapping/registration/normals.h"

#include <gtest/gtest.h>

#include <numbers>

#include "fovea/geometry/voxel_grid.h"
#include "fovea/mapping/registration/test_scenes.h"

namespace fovea::normals_test {

using test::Rectangle;

TEST(Normals, OfPlanesPointToTheSensor) {
  // Walls and floor of a corridor, without the points near edges.
  const std::vector<Eigen::Vector3f> points = test::sample(test::corridor(5), 40, 1);
  const std::vector<Eigen::Vector3f> normals = estimate_normals(points, {10});
  ASSERT_EQ(normals.size(), points.size());
  std::size_t checked = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool floor = points[i].z() == -1.7f;
    if (floor ? std::abs(points[i].y()) > 1 : points[i].z() < -0.7f) continue;
    const Eigen::Vector3f truth =
        floor ? Eigen::Vector3f(0, 0, 1) : Eigen::Vector3f(0, points[i].y() < 0 ? 1 : -1, 0);
    EXPECT_GT(normals[i].dot(truth), 0.99999f);
    ++checked;
  }
  EXPECT_GT(checked, points.size() / 2);
}

TEST(Normals, FarFromTheOriginAndObliqueStayExact) {
  const RigidMotion T = test::motion(0.4, -0.3, 0.7, 90, -40, 5);
  const std::vector<Eigen::Vector3f> points =
      test::transformed(T, test::sample({{{-2, -2, 0}, {4, 0, 0}, {0, 4, 0}}}, 40, 2));
  const Eigen::Vector3f truth = T.linear().col(2).cast<float>();
  for (const Eigen::Vector3f& normal : estimate_normals(points, {10})) {
    EXPECT_GT(std::abs(normal.dot(truth)), 0.9999f);
    EXPECT_NEAR(normal.norm(), 1, 1e-6);
  }
}

TEST(Normals, NoiseTiltsThemLittle) {
  const std::vector<Eigen::Vector3f> points =
      test::sample({{{5, -3, -3}, {0, 6, 0}, {0, 0, 6}}}, 30, 3, 0.01);
  double sum = 0;
  for (const Eigen::Vector3f& normal : estimate_normals(points, {15})) sum -= normal.x();
  EXPECT_GT(sum / static_cast<double>(points.size()), 0.998);  // 3.6 degrees
}

TEST(Normals, OfThinnedPointsAreCorrectAtAnyDensity) {
  // Walls of three densities. Only the widest radius contains enough points of the sparsest one.
  for (const double density : {16.0, 1.5, 0.12}) {
    const std::vector<Eigen::Vector3f> points =
        test::sample({{{20, -12, -8}, {0, 24, 3}, {1, 0, 16}}}, density, 6, 0.005);
    const Eigen::Vector3f truth = -Eigen::Vector3f(24 * 16, 3, -24).normalized();
    std::size_t known = 0;
    for (const Eigen::Vector3f& normal : estimate_normals(points, {10, 0.25})) {
      if (normal.isZero()) continue;
      EXPECT_GT(std::abs(normal.dot(truth)), 0.996f) << density;
      ++known;
    }
    EXPECT_GT(known, points.size() * 9 / 10) << density;
  }
}

TEST(Normals, OfThinnedPointsFarFromAllOthersAreUnknown) {
  std::vector<Eigen::Vector3f> points = test::sample(test::corridor(5), 12, 1);
  points.emplace_back(300, 0, 0);
  EXPECT_TRUE(estimate_normals(points, {10, 0.25}).back().isZero());
}

TEST(Normals, OfSomePointsAreFittedToAllPoints) {
  const std::vector<Eigen::Vector3f> points = test::sample(test::corridor(5), 12, 1);
  for (const double spacing : {0.0, 0.25}) {
    const std::vector<Eigen::Vector3f> all = estimate_normals(points, {10, spacing});
    const std::vector<std::uint32_t> of{7, 300, 301, std::uint32_t(points.size() - 1)};
    const std::vector<Eigen::Vector3f> some = estimate_normals(points, of, {10, spacing});
    ASSERT_EQ(some.size(), of.size());
    for (std::size_t k = 0; k < of.size(); ++k) EXPECT_EQ(some[k], all[of[k]]) << spacing;
  }
}

TEST(Normals, OfAFewPointsByTheirNearest) {
  const std::vector<Eigen::Vector3f> points{{5, 0, 0}, {5, 1, 0}, {5, 0, 1}, {5, 1, 1.5f}};
  for (const Eigen::Vector3f& normal : estimate_normals(points, {10})) {
    EXPECT_NEAR(normal.x(), -1, 1e-5);
  }
}

TEST(Normals, OfOneRingOnAWallAreUnknown) {
  const std::vector<Rectangle> wall = {{{30, -12, -3}, {0, 24, 0}, {0, 0, 12}}};
  const auto rings = [&](std::vector<double> degrees) {
    for (double& elevation : degrees) elevation *= std::numbers::pi / 180;
    return voxel_thinned(test::ring_scan(wall, RigidMotion::Identity(), degrees, 1, 0.02), 0.25f);
  };
  for (const auto& normal : estimate_normals(rings({2}), {10, 0.25})) {
    EXPECT_TRUE(normal.isZero());
  }
  // Two rings lie 1 m apart there.
  const std::vector<Eigen::Vector3f> two = rings({2, 4});
  std::size_t known = 0;
  for (const Eigen::Vector3f& normal : estimate_normals(two, {10, 0.25})) {
    if (normal.isZero()) continue;
    EXPECT_LT(normal.x(), -std::cos(5 * std::numbers::pi / 180));
    ++known;
  }
  EXPECT_GT(known, two.size() * 9 / 10);
}

TEST(Normals, NeedMorePointsOfNoisierRanges) {
  const std::vector<Eigen::Vector3f> points =
      test::sample({{{20, -0.5, -0.5}, {0, 1, 0}, {0, 0, 1}}}, 12, 6, 0.005);
  const auto known = [&](double range_noise) {
    std::size_t with_plane = 0;
    for (const auto& normal : estimate_normals(points, {10, 0.25, range_noise})) {
      with_plane += normal.isZero() ? 0 : 1;
    }
    return with_plane;
  };
  // 12 points of variance 1/12 m^2: 0.02 m tilts their plane by 1.1 degrees, 0.2 m by 11.
  EXPECT_EQ(known(0.02), points.size());
  EXPECT_EQ(known(0.2), 0u);
}

TEST(Normals, UndeterminedAreZero) {
  std::vector<Eigen::Vector3f> line;
  for (int i = 0; i < 20; ++i) line.emplace_back(5, 0.1f * static_cast<float>(i), 1);
  for (const auto& cloud : {line, std::vector<Eigen::Vector3f>(20, Eigen::Vector3f(1, 2, 3)),
                            std::vector<Eigen::Vector3f>{{1, 2, 3}, {2, 3, 4}}}) {
    for (const double spacing : {0.0, 0.25}) {
      for (const Eigen::Vector3f& normal : estimate_normals(cloud, {10, spacing})) {
        EXPECT_EQ(normal, Eigen::Vector3f::Zero());
      }
    }
  }
  EXPECT_TRUE(estimate_normals({}, {10}).empty());
}

}  // namespace fovea::normals_test
