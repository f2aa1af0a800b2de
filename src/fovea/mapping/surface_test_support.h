// Scans of boxes, and grids, for tests of surfaces and of the samples on them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "../../../tests/synthetic_drive.h"
#include "fovea/core/angle.h"
#include "fovea/core/random.h"
#include "fovea/mapping/camera_test_support.h"
#include "fovea/surface_samples.h"

namespace fovea::surface_test {

inline constexpr double kCell = 0.02;

/// Rings of a LiDAR that stands a little above and behind the camera, cut to about its view.
struct Rings {
  double first = 2, last = -12, step = 0.4;  // elevations, degrees
  double azimuth_step = 0.17;                // degrees
  double noise = 0;                          // of ranges, standard deviation, m
};

// In the camera's frame: x right, y down, z forward; boxes of the scene likewise.
inline PointCloud scan(const BoxScene& scene, const Rings& rings = {}) {
  const Eigen::Vector3d lidar(0.01, -0.08, -0.27);
  Random random(1);
  PointCloud points;
  for (double elevation = rings.first; elevation > rings.last; elevation -= rings.step) {
    for (double azimuth = -35; azimuth < 35; azimuth += rings.azimuth_step) {
      const double e = elevation * kDegree, a = azimuth * kDegree;
      const Eigen::Vector3d ray(std::cos(e) * std::sin(a), -std::sin(e), std::cos(e) * std::cos(a));
      const auto hit = scene.cast(lidar, ray);
      if (!hit) continue;
      points.position.push_back(
          (lidar + (*hit + rings.noise * random.normal()) * ray).cast<float>());
      points.intensity.push_back(0.25f);
    }
  }
  return points;
}

inline Box wall_at(double depth) { return {{-20, -10, depth}, {20, 10, depth + 1}}; }

inline bool nothing_taken(const Eigen::Vector3d&, int) { return false; }

inline SampleGrid grid_at(const RigidMotion& T_grid_cam) {
  return {T_grid_cam, kCell, nothing_taken};
}

inline SampleGrid plain_grid() { return grid_at(RigidMotion::Identity()); }

inline std::size_t sample_count(const PointCloud& points) {
  return std::size_t(std::count(points.interpolated.begin(), points.interpolated.end(), 1));
}

inline RigidMotion random_motion(Random& random) {
  Twist twist;
  for (int i = 0; i < 3; ++i) twist[i] = random.uniform(-3, 3);
  for (int i = 3; i < 6; ++i) twist[i] = random.uniform(-100, 100);
  return exp_se3(twist);
}

using CellKey = std::array<int, 3>;

inline CellKey cell_of(const Eigen::Vector3d& p_grid, int level = 0) {
  const Eigen::Array3i cell = (p_grid.array() / (kCell * (1 << level))).floor().cast<int>();
  return {cell.x(), cell.y(), cell.z()};
}

inline double off_center(double coordinate, int level = 0) {
  const double edge = kCell * (1 << level), cells = coordinate / edge - 0.5;
  return std::abs(cells - std::round(cells)) * edge;
}

}  // namespace fovea::surface_test
