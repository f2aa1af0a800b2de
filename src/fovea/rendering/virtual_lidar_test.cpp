#include "fovea/rendering/virtual_lidar.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/base/angle.h"
#include "fovea/base/parallel.h"
#include "fovea/simulation/lidar_model.h"

namespace fovea::virtual_lidar_test {

/// Samples of a rectangle, `spacing` apart.
void add_rectangle(const Eigen::Vector3f& corner, const Eigen::Vector3f& a,
                   const Eigen::Vector3f& b, float spacing, float intensity, MapSurfels& surfels) {
  const Eigen::Vector3f normal = a.cross(b).normalized();
  for (float i = 0; i <= a.norm(); i += spacing) {
    for (float j = 0; j <= b.norm(); j += spacing) {
      surfels.position.push_back(corner + i * a.normalized() + j * b.normalized());
      surfels.normal.push_back(normal);
      surfels.spacing.push_back(spacing);
      surfels.intensity.push_back(intensity);
      surfels.color.push_back({});
      surfels.colored.push_back(1);
    }
  }
}

/// The ground from 4 m before the sensor on, and a wall 12 m away that hides what lies behind it.
MapSurfels ground_and_wall() {
  MapSurfels surfels;
  surfels.origin = {100, 200, 0};
  add_rectangle({4, -6, -1.73f}, {20, 0, 0}, {0, 12, 0}, 0.03f, 0.25f, surfels);
  add_rectangle({12, -3, -1.73f}, {0, 6, 0}, {0, 0, 3}, 0.03f, 0.75f, surfels);
  return surfels;
}

const RigidMotion kPose(Eigen::Translation3d(100, 200, 0));

TEST(Hdl64, HasTheBeamsOfTheSimulatedOne) {
  const LidarPattern pattern = hdl64();
  ASSERT_EQ(pattern.elevation.size(), std::size_t{kRings});
  for (int ring = 0; ring < kRings; ++ring) {
    EXPECT_NEAR(pattern.elevation[std::size_t(ring)], beam_elevation(ring), 1e-4) << ring;
  }
  EXPECT_EQ(pattern.columns, LidarOptions().columns);
}

TEST(VirtualLidar, PointsLieOnTheFirstSurfaceThatABeamMeets) {
  const PointCloud scan = cast_lidar(ground_and_wall(), kPose, hdl64());
  std::size_t on_ground = 0, on_wall = 0;
  for (std::size_t i = 0; i < scan.size(); ++i) {
    const Eigen::Vector3f& p = scan.position[i];
    if (std::abs(p.z() + 1.73f) < 0.1f && std::abs(p.x() - 12) < 0.1f) continue;  // in the corner
    const bool wall = std::abs(p.x() - 12) < 0.002f && std::abs(p.y()) < 3.05f && p.z() < 1.3f;
    const bool ground = std::abs(p.z() + 1.73f) < 0.002f && p.x() > 3.95f && p.x() < 24.05f;
    ASSERT_TRUE(wall || ground) << p.transpose();
    // Nothing lies behind the wall, seen from the sensor.
    if (!wall && p.x() > 12.01f) {
      EXPECT_GT(std::abs(p.y() / p.x()), 3.0f / 12.1f);
    }
    on_wall += wall && p.z() > -1.5f;
    on_ground += ground && p.x() < 11.5f;
    const float expected = wall ? 0.75f : 0.25f;
    EXPECT_NEAR(scan.intensity[i], expected, 1e-5) << p.transpose();
  }
  // Every beam that should meet the wall does: none slips through between its samples.
  std::size_t beams = 0;
  const LidarPattern pattern = hdl64();
  for (const double elevation : pattern.elevation) {
    for (int c = 0; c < pattern.columns; ++c) {
      const double azimuth = (0.5 - (c + 0.5) / pattern.columns) * 360 * kDegree;
      if (std::abs(azimuth) > 80 * kDegree) continue;
      const double range = 12 / std::cos(azimuth), z = range * std::tan(elevation);
      beams += std::abs(12 * std::tan(azimuth)) < 2.95 && z > -1.5 && z < 1.2;
    }
  }
  EXPECT_GT(beams, 3000u);
  EXPECT_NEAR(double(on_wall), double(beams), 0.03 * double(beams));
  EXPECT_GT(on_ground, 1000u);
}

TEST(VirtualLidar, TurnsWithItsPose) {
  const MapSurfels surfels = ground_and_wall();
  RigidMotion turned = kPose;
  turned.rotate(Eigen::AngleAxisd(90 * kDegree, Eigen::Vector3d::UnitZ()));
  for (const Eigen::Vector3f& p : cast_lidar(surfels, turned, hdl64()).position) {
    EXPECT_LT(p.y(), -3.9f);  // what was ahead is to the right
  }
}

TEST(VirtualLidar, SeesNothingWhereNothingIsOrTooNear) {
  EXPECT_TRUE(cast_lidar({}, kPose, hdl64()).empty());
  LidarPattern near = hdl64();
  near.max_range = 3;
  EXPECT_TRUE(cast_lidar(ground_and_wall(), kPose, near).empty());
}

TEST(VirtualLidar, IsTheSameAtAnyNumberOfThreads) {
  const MapSurfels surfels = ground_and_wall();
  PointCloud once;
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    const PointCloud scan = cast_lidar(surfels, kPose, hdl64());
    if (once.empty()) once = scan;
    EXPECT_EQ(scan.position, once.position) << threads;
    EXPECT_EQ(scan.intensity, once.intensity) << threads;
  }
}

}  // namespace fovea::virtual_lidar_test
