#include "fovea/upsample.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "fovea/core/random.h"
#include "fovea/mapping/camera_test_support.h"
#include "fovea/mapping/grid_predicates.h"

namespace fovea::upsample_test {

Eigen::Vector3f at_pixel(const Camera& camera, double u, double v, double depth) {
  return Eigen::Vector3d((u - camera.cx) / camera.fx * depth, (v - camera.cy) / camera.fy * depth,
                         depth)
      .cast<float>();
}

// Intersection of the pixel's ray with the plane normal . x = offset.
Eigen::Vector3f on_plane(const Camera& camera, double u, double v, const Eigen::Vector3d& normal,
                         double offset) {
  const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
  return (ray * (offset / normal.dot(ray))).cast<float>();
}

// A lattice of pixels, each moved by up to `jitter` pixels.
std::vector<Eigen::Vector2d> jittered_pixels(double step, double jitter, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector2d> pixels;
  for (double v = 100; v < 300; v += step) {
    for (double u = 300; u < 700; u += step) {
      pixels.emplace_back(u + random.uniform(-jitter, jitter), v + random.uniform(-jitter, jitter));
    }
  }
  return pixels;
}

struct Plane {
  Eigen::Vector3d normal;  // towards the camera
  double offset;
};

PointCloud plane_cloud(const Camera& camera, const Plane& plane) {
  PointCloud cloud;
  for (const auto& pixel : jittered_pixels(10, 3, 1)) {
    cloud.position.push_back(on_plane(camera, pixel.x(), pixel.y(), plane.normal, plane.offset));
  }
  return cloud;
}

TEST(Upsample, PointsOfAPlaneStayOnItAndHaveItsNormal) {
  const Camera camera = test_camera();
  const Plane planes[] = {{{0, 0, -1}, -8},
                          {Eigen::Vector3d(0.6, 0, -0.8), -7},
                          {Eigen::Vector3d(-0.2, -0.7, -0.6).normalized(), -6}};
  for (const auto& [normal, offset] : planes) {
    const PointCloud cloud = plane_cloud(camera, {normal, offset});
    const PointCloud dense = upsample(cloud, camera, {.rate = 3, .max_edge = 0.6});
    ASSERT_GT(dense.size(), 15 * cloud.size());
    for (std::size_t i = 0; i < dense.size(); ++i) {
      ASSERT_NEAR(dense.position[i].cast<double>().dot(normal), offset, 5e-6);
      ASSERT_NEAR(dense.normal[i].norm(), 1, 1e-6) << i;
      ASSERT_LT((dense.normal[i].cast<double>() - normal).norm(), 0.01) << i;
    }
  }
}

TEST(Upsample, InterpolatesNothingBetweenSurfacesFurtherApartThanTau) {
  const Camera camera = test_camera();
  Random random(2);
  PointCloud cloud;
  for (const auto& pixel : jittered_pixels(6, 2, 3)) {
    const double depth = random.below(2) == 0 ? 6.0 : 6.31;
    cloud.position.push_back(at_pixel(camera, pixel.x(), pixel.y(), depth));
  }
  const PointCloud dense = upsample(cloud, camera, {.rate = 3, .max_edge = 0.3});
  ASSERT_GT(dense.size(), cloud.size() + 100);
  for (std::size_t i = cloud.size(); i < dense.size(); ++i) {
    const double z = dense.position[i].z();
    EXPECT_TRUE(std::abs(z - 6.0) < 1e-5 || std::abs(z - 6.31) < 1e-5) << z;
  }
  const PointCloud bridged = upsample(cloud, camera, {.rate = 1, .max_edge = 0.5});
  EXPECT_GT(bridged.size(), dense.size() / 5);
  EXPECT_TRUE(std::any_of(bridged.position.begin(), bridged.position.end(),
                          [](const Eigen::Vector3f& p) { return std::abs(p.z() - 6.1) < 0.05; }));
}

// The Delaunay triangles of a few points, by definition: no point is inside their circle. Rate 1
// must add exactly their centroids.
TEST(Upsample, AddsTheCentroidsOfTheTrianglesBelowTau) {
  const Camera camera = test_camera();
  Random random(4);
  PointCloud cloud;
  std::vector<GridPoint> grid;
  for (int i = 0; i < 60; ++i) {
    cloud.position.push_back(
        at_pixel(camera, random.uniform(500, 600), random.uniform(100, 200), random.uniform(5, 6)));
    const auto pixel = *camera.project(cloud.position.back().cast<double>());
    grid.push_back({static_cast<std::int32_t>(std::lround(pixel.x() * 1024)),
                    static_cast<std::int32_t>(std::lround(pixel.y() * 1024))});
  }
  constexpr double kTau = 0.5;
  std::vector<Eigen::Vector3f> expected;
  for (std::size_t a = 0; a < grid.size(); ++a) {
    for (std::size_t b = 0; b < grid.size(); ++b) {
      for (std::size_t c = b + 1; c < grid.size(); ++c) {
        if (a >= b) continue;
        const bool left = orientation(grid[a], grid[b], grid[c]) > 0;
        const auto inside = [&](GridPoint p) {
          return left ? in_circle_exact(grid[a], grid[b], grid[c], p)
                      : in_circle_exact(grid[a], grid[c], grid[b], p);
        };
        const auto& p = cloud.position;
        const float longest =
            std::max({(p[a] - p[b]).norm(), (p[b] - p[c]).norm(), (p[c] - p[a]).norm()});
        if (longest < kTau && std::none_of(grid.begin(), grid.end(), inside)) {
          expected.push_back((p[a] + p[b] + p[c]) / 3.f);
        }
      }
    }
  }
  const PointCloud dense = upsample(cloud, camera, {.rate = 1, .max_edge = kTau});
  ASSERT_GT(expected.size(), 20u);
  ASSERT_EQ(dense.size(), cloud.size() + expected.size());
  for (const Eigen::Vector3f& e : expected) {
    EXPECT_TRUE(std::any_of(dense.position.begin() + 60, dense.position.end(),
                            [&](const Eigen::Vector3f& p) { return (p - e).norm() < 1e-6f; }));
  }
}

// Each point inside splits its triangle in three: T triangles become 3 T. With four points on the
// hull T = 2 n - 6.
TEST(Upsample, GrowsByItsTriangles) {
  const Camera camera = test_camera();
  Random random(5);
  PointCloud cloud;
  for (const double u : {200, 1000}) {
    for (const double v : {20, 350}) cloud.position.push_back(at_pixel(camera, u, v, 10));
  }
  for (int i = 0; i < 100; ++i) {
    cloud.position.push_back(
        at_pixel(camera, random.uniform(210, 990), random.uniform(30, 340), 10));
  }
  const std::size_t n = cloud.size(), triangles = 2 * n - 6;
  EXPECT_EQ(upsample(cloud, camera, {.rate = 0, .max_edge = 100}).size(), n);
  EXPECT_EQ(upsample(cloud, camera, {.rate = 1, .max_edge = 100}).size(), n + triangles);
  EXPECT_EQ(upsample(cloud, camera, {.rate = 2, .max_edge = 100}).size(), n + 4 * triangles);
  EXPECT_EQ(upsample(cloud, camera, {.rate = 3, .max_edge = 100}).size(), n + 13 * triangles);
}

TEST(Upsample, AveragesQuantitiesAndKeepsProvenance) {
  const Camera camera = test_camera();
  PointCloud cloud;
  cloud.position = {at_pixel(camera, 600, 100, 5), at_pixel(camera, 610, 100, 5),
                    at_pixel(camera, 600, 110, 5)};
  cloud.intensity = {0.1f, 0.2f, 0.6f};
  cloud.range = {5.f, 6.f, 7.f};
  cloud.incidence = {0.1f, 0.2f, std::numeric_limits<float>::quiet_NaN()};
  cloud.color = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  cloud.frame = {17, 17, 17};
  cloud.camera = {2, 2, 2};
  cloud.interpolated = {0, 1, 0};
  const PointCloud dense = upsample(cloud, camera, {.rate = 1, .max_edge = 0.3});
  ASSERT_EQ(dense.size(), 4u);
  EXPECT_NO_THROW(dense.check());
  EXPECT_NEAR(dense.intensity[3], 0.3f, 1e-6f);
  EXPECT_NEAR(dense.range[3], 6.f, 1e-6f);
  EXPECT_TRUE(std::isnan(dense.incidence[3]));
  EXPECT_EQ(dense.color[3], (Rgb{1, 2, 3}));
  EXPECT_EQ(dense.frame[3], 17);
  EXPECT_EQ(dense.camera[3], 2);
  EXPECT_EQ(dense.interpolated, (std::vector<std::uint8_t>{0, 1, 0, 1}));
  EXPECT_EQ(dense.reason, (std::vector<std::uint8_t>{0, 0, 0, 3}));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(dense.position[i], cloud.position[i]);
    EXPECT_EQ(dense.intensity[i], cloud.intensity[i]);
  }

  PointCloud positions;
  positions.position = cloud.position;
  const PointCloud bare = upsample(positions, camera, {.rate = 1, .max_edge = 0.3});
  EXPECT_TRUE(bare.intensity.empty() && bare.frame.empty() && bare.color.empty());
  EXPECT_EQ(bare.interpolated.size(), 4u);
}

TEST(Upsample, NormalsAreThoseOfTheMeasuredTriangles) {
  const Camera camera = test_camera();
  PointCloud cloud;
  cloud.position = {at_pixel(camera, 600, 100, 5), at_pixel(camera, 620, 100, 5),
                    at_pixel(camera, 600, 120, 5), at_pixel(camera, 900, 300, 5)};
  const PointCloud same = upsample(cloud, camera, {.rate = 0, .max_edge = 0.3});
  ASSERT_EQ(same.size(), 4u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT((same.normal[i] - Eigen::Vector3f(0, 0, -1)).norm(), 1e-5f);
  }
  EXPECT_EQ(same.normal[3], Eigen::Vector3f(0, 0, 0));  // no triangle below tau
}

TEST(Upsample, NearestPointOfAPixelIsItsVertex) {
  const Camera camera = test_camera();
  PointCloud cloud;
  cloud.position = {at_pixel(camera, 600, 100, 8),    at_pixel(camera, 600, 100, 5),
                    at_pixel(camera, 600, 100, 5.03), at_pixel(camera, 610, 100, 5),
                    at_pixel(camera, 600, 110, 5),    at_pixel(camera, 610, 100, 9)};
  const PointCloud dense = upsample(cloud, camera, {.rate = 1, .max_edge = 0.3});
  ASSERT_EQ(dense.size(), 7u);
  EXPECT_NEAR(dense.position[6].z(), 5, 1e-5);
  const Eigen::Vector3f towards_camera(0, 0, -1), unknown(0, 0, 0);
  const Eigen::Vector3f expected[] = {unknown,        towards_camera, towards_camera,
                                      towards_camera, towards_camera, unknown};
  for (int i = 0; i < 6; ++i) EXPECT_LT((dense.normal[i] - expected[i]).norm(), 1e-5f) << i;
}

TEST(Upsample, FewCollinearAndEqualPointsAreNormalInput) {
  const Camera camera = test_camera();
  const Eigen::Vector3f a = at_pixel(camera, 100, 100, 5), b = at_pixel(camera, 110, 100, 5),
                        c = at_pixel(camera, 120, 100, 5);
  for (const auto& positions :
       std::vector<std::vector<Eigen::Vector3f>>{{}, {a}, {a, b}, {a, a, a}, {a, b, c, b}}) {
    PointCloud cloud;
    cloud.position = positions;
    const PointCloud dense = upsample(cloud, camera, {.rate = 2, .max_edge = 0.3});
    EXPECT_EQ(dense.position, positions);
    EXPECT_EQ(dense.normal, std::vector<Eigen::Vector3f>(positions.size(), {0.f, 0.f, 0.f}));
    EXPECT_EQ(dense.interpolated, std::vector<std::uint8_t>(positions.size(), 0));
  }
}

TEST(Upsample, KeepsPointsFarOutsideTheImage) {
  const Camera camera = test_camera();
  PointCloud cloud = plane_cloud(camera, {{0, 0, -1}, -8});
  const PointCloud without = upsample(cloud, camera, {.rate = 1, .max_edge = 0.6});
  cloud.position.insert(cloud.position.begin(), Eigen::Vector3f(1000, 3, 0.2f));
  const PointCloud with = upsample(cloud, camera, {.rate = 1, .max_edge = 0.6});
  ASSERT_EQ(with.size(), without.size() + 1);
  EXPECT_EQ(with.position[0], Eigen::Vector3f(1000, 3, 0.2f));
  EXPECT_EQ(with.normal[0], Eigen::Vector3f(0, 0, 0));
}

TEST(Upsample, IsRelativeToTheOriginOfTheCloud) {
  const Camera camera = test_camera();
  const PointCloud cloud = plane_cloud(camera, {Eigen::Vector3d(0.6, 0, -0.8), -7});
  PointCloud moved = cloud;
  moved.origin = {0, 0, 4};
  for (auto& p : moved.position) p.z() -= 4;
  const PointCloud a = upsample(cloud, camera, {.rate = 1, .max_edge = 0.6});
  const PointCloud b = upsample(moved, camera, {.rate = 1, .max_edge = 0.6});
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(b.origin, moved.origin);
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_LT((a.normal[i] - b.normal[i]).norm(), 1e-3f);
    EXPECT_NEAR((b.position[i] + Eigen::Vector3f(0, 0, 4)).dot(Eigen::Vector3f(0.6f, 0, -0.8f)),
                -7.f, 1e-5f);
  }
}

TEST(Upsample, GivesTheSameForTheSame) {
  const Camera camera = test_camera();
  const PointCloud cloud = plane_cloud(camera, {{0, 0, -1}, -8});
  const UpsampleOptions options{.rate = 3, .max_edge = 0.3};
  const PointCloud a = upsample(cloud, camera, options), b = upsample(cloud, camera, options);
  EXPECT_EQ(a.position, b.position);
  EXPECT_EQ(a.normal, b.normal);
}

TEST(Upsample, RejectsPointsThatAreNotInFrontOfTheCamera) {
  const Camera camera = test_camera();
  for (const float z : {-1.f, 0.f, 0.05f, std::numeric_limits<float>::quiet_NaN()}) {
    PointCloud cloud;
    cloud.position = {{0, 0, 5}, {0, 1, z}};
    EXPECT_THROW(upsample(cloud, camera, {}), std::invalid_argument) << z;
  }
}

}  // namespace fovea::upsample_test
