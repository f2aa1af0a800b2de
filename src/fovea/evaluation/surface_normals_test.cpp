#include "fovea/evaluation/surface_normals.h"

#include <gtest/gtest.h>

#include "fovea/core/random.h"

namespace fovea::surface_normals_test {

TEST(SurfaceNormals, ArePerpendicularToAPlane) {
  const Eigen::Vector3f normal = Eigen::Vector3f(1, 2, -0.5f).normalized();
  const Eigen::Vector3f u = normal.unitOrthogonal(), v = normal.cross(u);
  const Eigen::Vector3f center(800, -700, 3);
  Random random(3);
  std::vector<Eigen::Vector3f> points;
  for (int i = -20; i <= 20; ++i) {
    for (int k = -20; k <= 20; ++k) {
      const auto noise = static_cast<float>(0.004 * random.normal());
      points.push_back(center + 0.03f * float(i) * u + 0.03f * float(k) * v + noise * normal);
    }
  }
  std::size_t known = 0;
  for (const Eigen::Vector3f& found : surface_normals(points)) {
    if (found.isZero()) continue;
    ++known;
    EXPECT_GT(std::abs(found.dot(normal)), std::cos(0.1f));
  }
  EXPECT_GT(known, points.size() * 95 / 100);
}

TEST(SurfaceNormals, AreUnknownWithoutASurface) {
  std::vector<Eigen::Vector3f> line, heap;
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    line.emplace_back(0.01f * float(i), 0, 0);
    heap.emplace_back(float(random.uniform(5, 5.3)), float(random.uniform(5, 5.3)),
                      float(random.uniform(5, 5.3)));
  }
  for (const auto& points : {line, {Eigen::Vector3f(1, 2, 3)}}) {
    for (const Eigen::Vector3f& normal : surface_normals(points)) EXPECT_TRUE(normal.isZero());
  }
  std::size_t unknown = 0;
  for (const Eigen::Vector3f& normal : surface_normals(heap)) unknown += normal.isZero() ? 1 : 0;
  EXPECT_GT(unknown, heap.size() * 8 / 10);
  EXPECT_TRUE(surface_normals({}).empty());
}

}  // namespace fovea::surface_normals_test
