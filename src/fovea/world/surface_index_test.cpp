#include "fovea/world/surface_index.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "fovea/core/parallel.h"
#include "fovea/core/random.h"

namespace fovea::surface_index_test {

void add_triangle(TriangleMesh& mesh, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                  const Eigen::Vector3d& c) {
  const auto first = static_cast<std::uint32_t>(mesh.position.size());
  for (const Eigen::Vector3d& p : {a, b, c}) {
    mesh.position.push_back(p);
    mesh.texture.push_back((2 * p).cast<float>());
  }
  mesh.triangle.push_back({first, first + 1, first + 2});
  mesh.material.push_back(0);
  mesh.surface.push_back(0);
}

Eigen::Vector3d random_point(Random& random, double half_width) {
  return {random.uniform(-half_width, half_width), random.uniform(-half_width, half_width),
          random.uniform(-half_width, half_width)};
}

TriangleMesh random_mesh(int triangles, double half_width, double size,
                         const Eigen::Vector3d& center) {
  TriangleMesh mesh;
  Random random(5);
  for (int i = 0; i < triangles; ++i) {
    const Eigen::Vector3d a = center + random_point(random, half_width);
    add_triangle(mesh, a, a + random_point(random, size), a + random_point(random, size));
  }
  return mesh;
}

SurfacePoint nearest_by_force(const TriangleMesh& mesh, const Eigen::Vector3d& p) {
  SurfacePoint nearest;
  double distance = std::numeric_limits<double>::infinity();
  for (std::uint32_t t = 0; t < mesh.size(); ++t) {
    const SurfacePoint candidate = nearest_on_triangle(mesh, t, p);
    const double d = (candidate.position - p).squaredNorm();
    if (d < distance) distance = d, nearest = candidate;
  }
  return nearest;
}

TEST(SurfaceIndex, FindsWhatASearchOfAllTrianglesFinds) {
  // Far from the frame's origin, where a float could not tell the triangles apart.
  const Eigen::Vector3d center(40'000, -70'000, 120);
  const TriangleMesh mesh = random_mesh(3000, 20, 1, center);
  const SurfaceIndex index(mesh);
  Random random(6);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p = center + random_point(random, i % 5 == 0 ? 200 : 22);
    const SurfacePoint expected = nearest_by_force(mesh, p), found = index.nearest(p);
    EXPECT_EQ(found.triangle, expected.triangle);
    EXPECT_EQ(found.position, expected.position);
    EXPECT_EQ(found.texture, expected.texture);
  }
}

TEST(SurfaceIndex, OfEquallyNearTrianglesTheLowestNumberWins) {
  TriangleMesh mesh;
  for (int copy = 0; copy < 20; ++copy) {
    add_triangle(mesh, {0, 0, 0.1}, {1, 0, 0.1}, {0, 1, 0.1});
  }
  const SurfaceIndex index(mesh);
  EXPECT_EQ(index.nearest({0.2, 0.2, 5}).triangle, 0u);
  EXPECT_EQ(index.nearest({0.2, 0.2, 0.1}).triangle, 0u);
}

TEST(SurfaceIndex, TellsSurfacesApartThatFloatsRoundTogether) {
  TriangleMesh mesh;  // 1 km wide, so that a float's last place is 0.06 mm
  for (const double z : {2e-6, 1e-6, 3e-6}) {
    add_triangle(mesh, {-500, -500, z}, {500, -500, z}, {0, 500, z});
  }
  const SurfaceIndex index(mesh);
  EXPECT_EQ(index.nearest({123.4, -50, -1}).triangle, 1u);
  EXPECT_EQ(index.nearest({123.4, -50, 1}).triangle, 2u);
  EXPECT_EQ(index.nearest({123.4, -50, 1.9e-6}).triangle, 0u);
}

TEST(SurfaceIndex, DistancesAreExact) {
  TriangleMesh mesh;
  add_triangle(mesh, {100, 0, 0}, {101, 0, 0}, {100, 1, 0});
  const SurfaceIndex index(mesh);
  const SurfacePoint above = index.nearest({100.25, 0.25, 0.01});
  EXPECT_NEAR((above.position - Eigen::Vector3d(100.25, 0.25, 0)).norm(), 0, 1e-12);
  EXPECT_TRUE(above.texture.isApprox(Eigen::Vector3f(200.5f, 0.5f, 0)));
  EXPECT_EQ(index.nearest({99, -1, 0}).position, Eigen::Vector3d(100, 0, 0));
  EXPECT_EQ(index.nearest({1e6, 0, 0}).position, Eigen::Vector3d(101, 0, 0));
}

TEST(SurfaceIndex, ATriangleWithoutAreaDoesNoHarm) {
  TriangleMesh mesh;
  add_triangle(mesh, {1, 1, 1}, {1, 1, 1}, {1, 1, 1});
  add_triangle(mesh, {0, 0, 0}, {1, 0, 0}, {2, 0, 0});
  add_triangle(mesh, {0, 0, -1}, {1, 0, -1}, {0, 1, -1});
  const SurfaceIndex index(mesh);
  EXPECT_EQ(index.nearest({0.2, 0.2, -0.9}).triangle, 2u);
  EXPECT_EQ(index.nearest({1, 1, 1.1}).triangle, 0u);
}

TEST(SurfaceIndex, AnswersManyThreads) {
  const TriangleMesh mesh = random_mesh(500, 10, 1, Eigen::Vector3d::Zero());
  const SurfaceIndex index(mesh);
  std::vector<Eigen::Vector3d> queries;
  Random random(8);
  for (int i = 0; i < 2000; ++i) queries.push_back(random_point(random, 12));
  std::vector<std::uint32_t> parallel(queries.size());
  parallel_for(queries.size(), 16,
               [&](std::size_t i) { parallel[i] = index.nearest(queries[i]).triangle; });
  for (std::size_t i = 0; i < queries.size(); ++i) {
    EXPECT_EQ(parallel[i], index.nearest(queries[i]).triangle);
  }
}

TEST(SurfaceIndex, RefusesAnEmptyMesh) {
  EXPECT_THROW(SurfaceIndex{TriangleMesh{}}, std::invalid_argument);
}

}  // namespace fovea::surface_index_test
