#include "fovea/mapping/surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "fovea/mapping/surface_test_support.h"

namespace fovea::surface_test {

TEST(Surface, GroundBetweenDistantRingsIsFilled) {
  constexpr double kHeight = 1.653;
  const BoxScene ground{{{{-50, kHeight, -5}, {50, kHeight + 1, 60}}}};
  const auto density = [&](const PointCloud& points, double near, double far) {
    std::size_t count = 0;
    for (const Eigen::Vector3f& p : points.position) {
      count += std::abs(p.x()) < 2 && p.z() > near && p.z() < far;
    }
    return double(count) * kCell * kCell / (4 * (far - near));
  };
  for (const double noise : {0.0, 0.015}) {
    const PointCloud measured = scan(ground, {.noise = noise});
    const PointCloud points =
        sample_surfaces(measured, test_camera(), {.max_per_pixel = 0}, plain_grid());
    for (std::size_t i = 0; i < points.size(); ++i) {
      ASSERT_NEAR(points.position[i].y(), kHeight, noise == 0 ? 1e-5 : 0.05);
    }
    // Rings are 0.43 m apart at 10 m, 1 m at 15 m: beyond that it is not measured as flat.
    EXPECT_NEAR(density(points, 8.5, 10), 1, noise == 0 ? 0.002 : 0.05) << noise;
    EXPECT_NEAR(density(points, 12, 14), 1, noise == 0 ? 0.002 : 0.05) << noise;
    EXPECT_LT(density(points, 16, 18), 0.05) << noise;
    const PointCloud tau_alone = sample_surfaces(
        measured, test_camera(), {.max_edge = 0.3, .planar_edge = 0.1}, plain_grid());
    EXPECT_LT(density(tau_alone, 9, 14), 0.05) << noise;
  }
}

// Rings 0.3 to 1 m apart: a sample states whether short edges or flat ground admitted it. The edges
// of triangles between two known rings are at least as long as the gap. They are at most as long as
// its diagonal with a step along the ring.
TEST(Surface, SamplesStateTheRuleThatAdmittedThem) {
  constexpr double kHeight = 1.653, kMaxEdge = 0.55;
  const Rings rings;
  const PointCloud measured = scan({{{{-50, kHeight, -5}, {50, kHeight + 1, 60}}}}, rings);
  const PointCloud points =
      sample_surfaces(measured, test_camera(), {.max_edge = kMaxEdge}, plain_grid());
  std::array<std::size_t, kPointRules> count{};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint8_t rule = points.reason[i];
    ASSERT_LT(rule, kPointRules);
    ++count[rule];
    ASSERT_EQ(rule == reason_of(PointRule::kMeasured), points.interpolated[i] == 0);
    const Eigen::Vector3f p = points.position[i] - Eigen::Vector3f(0.01f, -0.08f, -0.27f);
    if (points.interpolated[i] == 0) continue;
    const double out = std::hypot(p.x(), p.z()), height = kHeight + 0.08;
    const double below = (rings.first + std::atan2(height, out) / kDegree) / rings.step;
    const auto radius = [&](double ring) {
      return height / std::tan((ring * rings.step - rings.first) * kDegree);
    };
    // Skips points near a ring, since its chords are inside its circle.
    if (std::abs(below - std::round(below)) < 0.02) continue;
    const double gap = radius(std::floor(below)) - radius(std::ceil(below));
    const double along = radius(std::floor(below)) * rings.azimuth_step * kDegree;
    if (std::hypot(gap, 2 * along) < kMaxEdge) {
      ASSERT_EQ(rule, reason_of(PointRule::kShortEdges)) << out;
    }
    if (gap > kMaxEdge) {
      ASSERT_EQ(rule, reason_of(PointRule::kPlanar)) << out;
    }
  }
  EXPECT_GT(count[reason_of(PointRule::kMeasured)], 1000u);
  EXPECT_GT(count[reason_of(PointRule::kShortEdges)], 10000u);
  EXPECT_GT(count[reason_of(PointRule::kPlanar)], 10000u);
  EXPECT_EQ(count[reason_of(PointRule::kCentroid)], 0u);
}

// The space between a board and the wall behind it was never measured.
TEST(Surface, NothingIsSampledBetweenABoardAndTheWallBehind) {
  for (const double azimuth_step : {0.17, 0.09, 0.4}) {
    for (double gap = 0.42; gap < 1.1; gap += 0.06) {
      const Box board{{-1.03, -0.12, 6}, {0.91, 0.57, 6.01}};
      const BoxScene scene{{board, wall_at(6 + gap)}};
      const PointCloud measured = scan(scene, {.step = 0.3, .azimuth_step = azimuth_step});
      const PointCloud points = sample_surfaces(measured, test_camera(), {}, plain_grid());
      ASSERT_GT(sample_count(points), 10'000u);
      std::size_t between = 0;
      for (const Eigen::Vector3f& p : points.position) {
        between += std::abs(p.z() - 6) > 0.005f && std::abs(p.z() - 6 - gap) > 0.005f;
      }
      // The gap bends at the board's corners, where a small triangle may count as flat.
      EXPECT_LE(between, 2u) << "gap " << gap << " m, azimuth step " << azimuth_step << ", of "
                             << points.size();
    }
  }
}

// Chords cut corners by less than tau; elsewhere samples are on the surfaces.
TEST(Surface, ABoxOnTheGroundKeepsItsShape) {
  const BoxScene scene{{{{-50, 1.653, -5}, {50, 3, 60}}, {{-1.31, 0.4, 8.2}, {1.12, 1.653, 12}}}};
  const PointCloud points = sample_surfaces(scan(scene), test_camera(), {}, plain_grid());
  ASSERT_GT(sample_count(points), 50'000u);
  std::size_t off = 0;
  for (const Eigen::Vector3f& p : points.position) {
    const double distance = scene.distance(p.cast<double>());
    ASSERT_LT(distance, 0.15) << p.transpose();  // half of tau
    off += distance > 0.005;
  }
  EXPECT_LT(double(off), 0.01 * double(points.size()));
}

// A corner of a house, an edge of 90 degrees towards the camera, and its two normals.
TEST(Surface, NormalsAreThoseOfTheSidesOfAnEdge) {
  const Eigen::Vector3d left_normal = Eigen::Vector3d(-1, 0, -1).normalized();
  const Eigen::Vector3d right_normal = Eigen::Vector3d(1, 0, -1).normalized();
  const Eigen::Vector3d edge(0.2, 0, 7);
  const Camera camera = test_camera();
  PointCloud measured;
  for (double u = 400; u < 850; u += 4) {
    for (double v = 20; v < 380; v += 4) {
      const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
      const Eigen::Vector3d& n =
          ray.x() / ray.z() < edge.x() / edge.z() ? left_normal : right_normal;
      measured.position.push_back((ray * (n.dot(edge) / n.dot(ray))).cast<float>());
    }
  }
  const PointCloud points = sample_surfaces(measured, camera, {}, plain_grid());
  std::size_t on_left = 0, on_right = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d p = points.position[i].cast<double>();
    const bool left = p.x() < edge.x();
    const Eigen::Vector3d& n = left ? left_normal : right_normal;
    ASSERT_LT(std::abs(n.dot(p - edge)), 0.04);       // 4 pixels at 7 m
    if (std::abs(p.x() - edge.x()) < 0.25) continue;  // smoothed over the edge
    ASSERT_LT((points.normal[i].cast<double>() - n).norm(), 0.01);
    (left ? on_left : on_right) += points.interpolated[i];
  }
  EXPECT_GT(on_left, 1000u);
  EXPECT_GT(on_right, 1000u);
}

TEST(Surface, FewCollinearAndEqualPointsAreNormalInput) {
  const Eigen::Vector3f a(0, 0, 5), b(0.1f, 0, 5), c(0.2f, 0, 5);
  for (const auto& positions :
       std::vector<std::vector<Eigen::Vector3f>>{{}, {a}, {a, b}, {a, b, c}, {a, a, a}}) {
    PointCloud cloud;
    cloud.position = positions;
    const PointCloud points = sample_surfaces(cloud, test_camera(), {}, plain_grid());
    EXPECT_NO_THROW(points.check());
    EXPECT_TRUE(points.intensity.empty());
    const std::set<float> places = [&] {
      std::set<float> x;
      for (const Eigen::Vector3f& p : positions) x.insert(p.x());
      return x;
    }();
    EXPECT_EQ(points.size(), places.size());
    EXPECT_EQ(points.normal, std::vector<Eigen::Vector3f>(places.size(), {0.f, 0.f, 0.f}));
    EXPECT_EQ(points.interpolated, std::vector<std::uint8_t>(places.size(), 0));
  }
}

// Two points of one pixel: the nearer is a corner of the surface, the other stays unchanged.
TEST(Surface, TheNearestPointOfAPixelIsItsCorner) {
  PointCloud cloud;
  for (const double depth : {9.0, 5.0}) {
    cloud.position.push_back(Eigen::Vector3d(0.02 * depth, 0.02 * depth, depth).cast<float>());
  }
  cloud.position.push_back({0.3f, 0.1f, 5});
  cloud.position.push_back({0.1f, 0.3f, 5});
  const PointCloud points = sample_surfaces(cloud, test_camera(), {}, plain_grid());
  ASSERT_GT(points.size(), 20u);
  EXPECT_EQ(points.position[0], cloud.position[0]);
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_NEAR(points.position[i].z(), 5, 1e-5);
}

TEST(Surface, RejectsPointsThatAreNotInFrontOfTheCamera) {
  PointCloud cloud;
  cloud.position = {{0, 0, 5}, {0, 1, -1}};
  EXPECT_THROW(sample_surfaces(cloud, test_camera(), {}, plain_grid()), std::invalid_argument);
}

}  // namespace fovea::surface_test
