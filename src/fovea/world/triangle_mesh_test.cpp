#include "fovea/world/triangle_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "fovea/core/random.h"

namespace fovea::triangle_mesh_test {

using Eigen::Vector3d;
using Eigen::Vector3f;

TriangleMesh one_triangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  TriangleMesh mesh;
  mesh.position = {a, b, c};
  mesh.texture = {Vector3f(0, 0, 5), Vector3f(1, 0, 5), Vector3f(0, 1, 5)};
  mesh.triangle = {{0, 1, 2}};
  mesh.material = {3};
  mesh.surface = {7};
  return mesh;
}

Vector3d random_point(Random& random, double half_width) {
  return {random.uniform(-half_width, half_width), random.uniform(-half_width, half_width),
          random.uniform(-half_width, half_width)};
}

TEST(TriangleMesh, NormalPointsToWhereCornersRunCounterClockwise) {
  EXPECT_EQ(one_triangle({0, 0, 0}, {2, 0, 0}, {0, 3, 0}).normal(0), Vector3d(0, 0, 1));
  EXPECT_EQ(one_triangle({0, 0, 0}, {0, 3, 0}, {2, 0, 0}).normal(0), Vector3d(0, 0, -1));
  EXPECT_EQ(one_triangle({1, 1, 1}, {2, 2, 2}, {3, 3, 3}).normal(0), Vector3d::Zero());
}

TEST(TriangleMesh, AppendsWhatIsMoved) {
  TriangleMesh mesh = one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  TriangleMesh other = one_triangle({1, 1, 0}, {2, 1, 0}, {1, 2, 0});
  other.material = {4};
  other.surface = {8};
  Eigen::Affine3d T(Eigen::Translation3d(0, 0, 10));
  T.scale(2);
  mesh.append(other, T);
  EXPECT_NO_THROW(mesh.check());
  ASSERT_EQ(mesh.size(), 2u);
  EXPECT_EQ(mesh.corner(0, 1), Vector3d(1, 0, 0));
  EXPECT_EQ(mesh.corner(1, 0), Vector3d(2, 2, 10));
  EXPECT_EQ(mesh.corner(1, 2), Vector3d(2, 4, 10));
  EXPECT_EQ(mesh.texture[mesh.triangle[1][1]], Vector3f(1, 0, 5));
  EXPECT_EQ(mesh.material, (std::vector<std::uint16_t>{3, 4}));
  EXPECT_EQ(mesh.surface, (std::vector<std::uint32_t>{7, 8}));
  TriangleMesh empty;
  EXPECT_TRUE(empty.empty());
  empty.append(mesh, Eigen::Affine3d::Identity());
  EXPECT_EQ(empty.position, mesh.position);
  EXPECT_EQ(empty.triangle, mesh.triangle);
}

TEST(TriangleMesh, CheckFindsWhatDoesNotFitTogether) {
  const TriangleMesh good = one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_NO_THROW(good.check());
  EXPECT_NO_THROW(TriangleMesh{}.check());
  TriangleMesh bad = good;
  bad.texture.pop_back();
  EXPECT_THROW(bad.check(), std::logic_error);
  bad = good;
  bad.material.clear();
  EXPECT_THROW(bad.check(), std::logic_error);
  bad = good;
  bad.surface.push_back(1);
  EXPECT_THROW(bad.check(), std::logic_error);
  bad = good;
  bad.triangle[0][2] = 3;
  EXPECT_THROW(bad.check(), std::logic_error);
}

TEST(NearestOnTriangle, IsNoFartherThanAnyOfItsPoints) {
  constexpr int kSteps = 60;
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const Vector3d a = random_point(random, 1), b = random_point(random, 1),
                   c = random_point(random, 1), p = random_point(random, 2);
    const SurfacePoint nearest = nearest_on_triangle(one_triangle(a, b, c), 0, p);
    const double distance = (nearest.position - p).norm();
    double sampled = std::numeric_limits<double>::infinity();
    for (int v = 0; v <= kSteps; ++v) {
      for (int w = 0; v + w <= kSteps; ++w) {
        const Vector3d q = a + double(v) / kSteps * (b - a) + double(w) / kSteps * (c - a);
        sampled = std::min(sampled, (q - p).norm());
      }
    }
    EXPECT_LE(distance, sampled + 1e-12);
    const double step = ((b - a).norm() + (c - a).norm()) / kSteps;
    EXPECT_GE(distance, sampled - step);
    // Texture and position name the same place, which lies on the triangle.
    const double v = nearest.texture.x(), w = nearest.texture.y();
    EXPECT_GE(std::min(v, w), -1e-6);
    EXPECT_LE(v + w, 1 + 1e-6);
    EXPECT_EQ(nearest.texture.z(), 5);
    EXPECT_LT((a + v * (b - a) + w * (c - a) - nearest.position).norm(), 1e-6);
  }
}

TEST(NearestOnTriangle, KnowsCornersEdgesAndInside) {
  const TriangleMesh mesh = one_triangle({0, 0, 0}, {2, 0, 0}, {0, 2, 0});
  const auto nearest = [&](const Vector3d& p) { return nearest_on_triangle(mesh, 0, p).position; };
  EXPECT_EQ(nearest({-1, -1, 1}), Vector3d(0, 0, 0));
  EXPECT_EQ(nearest({4, -1, 1}), Vector3d(2, 0, 0));
  EXPECT_EQ(nearest({-1, 5, 1}), Vector3d(0, 2, 0));
  EXPECT_EQ(nearest({0.5, -3, 1}), Vector3d(0.5, 0, 0));
  EXPECT_EQ(nearest({-3, 0.5, 1}), Vector3d(0, 0.5, 0));
  EXPECT_EQ(nearest({2, 2, -1}), Vector3d(1, 1, 0));
  EXPECT_LT((nearest({0.5, 0.25, 7}) - Vector3d(0.5, 0.25, 0)).norm(), 1e-15);
}

}  // namespace fovea::triangle_mesh_test
