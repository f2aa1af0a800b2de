#include "fovea/rendering/virtual_lidar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fovea/core/angle.h"
#include "fovea/core/parallel.h"
#include "fovea/rendering/lidar_beams.h"
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

const LidarPattern kHdl64 = lidar_pattern(LidarModel::kHdl64);

TEST(VirtualLidar, BeamsOfEveryModelAreThoseOfTheSimulatedOne) {
  for (const LidarDataSheet& sheet : lidar_data_sheets()) {
    const LidarPattern pattern = lidar_pattern(sheet.model);
    LidarOptions simulated;
    set_model(simulated, sheet.model);
    EXPECT_EQ(pattern.elevation, ring_elevations(simulated)) << sheet.name;
    EXPECT_EQ(pattern.columns, sweep_columns(simulated)) << sheet.name;
    EXPECT_EQ(pattern.period, simulated.period) << sheet.name;
    EXPECT_EQ(pattern.rosette.has_value(), sheet.rosette.has_value()) << sheet.name;
  }
}

/// A plane across the view, 10 m ahead.
MapSurfels wall_ahead() {
  MapSurfels surfels;
  surfels.origin = {100, 200, 0};
  add_rectangle({10, -9, -9}, {0, 18, 0}, {0, 0, 18}, 0.04f, 0.5f, surfels);
  return surfels;
}

TEST(VirtualLidar, EveryModelMeetsAWallAlongItsBeams) {
  for (const LidarDataSheet& sheet : lidar_data_sheets()) {
    LidarPattern pattern = lidar_pattern(sheet.model);
    const PointCloud scan = cast_lidar(wall_ahead(), kPose, pattern, 3);
    std::size_t expected = 0;
    const LidarBeams beams(pattern, 3);
    for (std::uint32_t beam = 0; beam < beams.size(); ++beam) {
      const Eigen::Vector3f d = beams.direction(beam);
      if (d.x() > 0.1f && std::abs(d.y() / d.x()) < 0.89f && std::abs(d.z() / d.x()) < 0.89f) {
        ++expected;
      }
    }
    ASSERT_GT(expected, 1000u) << sheet.name;
    EXPECT_NEAR(double(scan.size()), double(expected), 0.03 * double(expected)) << sheet.name;
    for (const Eigen::Vector3f& p : scan.position) ASSERT_NEAR(p.x(), 10, 1e-3) << sheet.name;
  }
}

TEST(VirtualLidar, ARosetteIsFoundNearAnyDirection) {
  const LidarPattern pattern = lidar_pattern(LidarModel::kLivoxHap);
  const LidarBeams beams(pattern, 1.5);
  for (const double azimuth : {-1.0, -0.2, 0.0, 0.5}) {
    for (const double elevation : {-0.15, 0.0, 0.07}) {
      const Eigen::Vector3f d =
          Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                          std::cos(elevation) * std::sin(azimuth), std::sin(elevation))
              .cast<float>();
      std::set<std::uint32_t> near, found;
      for (std::uint32_t beam = 0; beam < beams.size(); ++beam) {
        if (beams.direction(beam).dot(d) > std::cos(0.04)) near.insert(beam);
      }
      beams.for_each_near(5 * d, 5, 0.0401, [&](std::uint32_t beam) { found.insert(beam); });
      EXPECT_TRUE(std::includes(found.begin(), found.end(), near.begin(), near.end()));
      EXPECT_LE(found.size(), 3 * near.size() + 100);
    }
  }
}

TEST(VirtualLidar, ARosetteIsElsewhereInTheNextSweep) {
  const LidarPattern pattern = lidar_pattern(LidarModel::kLivoxAvia);
  const MapSurfels wall = wall_ahead();
  EXPECT_EQ(cast_lidar(wall, kPose, pattern, 1).position,
            cast_lidar(wall, kPose, pattern, 1).position);
  EXPECT_NE(cast_lidar(wall, kPose, pattern, 1).position,
            cast_lidar(wall, kPose, pattern, 1.1).position);
}

TEST(VirtualLidar, PointsLieOnTheFirstSurfaceThatABeamMeets) {
  const PointCloud scan = cast_lidar(ground_and_wall(), kPose, kHdl64);
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
  const LidarPattern pattern = kHdl64;
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
  for (const Eigen::Vector3f& p : cast_lidar(surfels, turned, kHdl64).position) {
    EXPECT_LT(p.y(), -3.9f);  // what was ahead is to the right
  }
}

TEST(VirtualLidar, SeesNothingWhereNothingIsOrTooNear) {
  EXPECT_TRUE(cast_lidar({}, kPose, kHdl64).empty());
  LidarPattern near = kHdl64;
  near.max_range = 3;
  EXPECT_TRUE(cast_lidar(ground_and_wall(), kPose, near).empty());
}

TEST(VirtualLidar, IsTheSameAtAnyNumberOfThreads) {
  const MapSurfels surfels = ground_and_wall();
  PointCloud once;
  for (const int threads : {1, 2, 4}) {
    const ThreadLimit limit(threads);
    const PointCloud scan = cast_lidar(surfels, kPose, kHdl64);
    if (once.empty()) once = scan;
    EXPECT_EQ(scan.position, once.position) << threads;
    EXPECT_EQ(scan.intensity, once.intensity) << threads;
  }
}

}  // namespace fovea::virtual_lidar_test
