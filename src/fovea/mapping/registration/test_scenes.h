// Analytic scenes for the tests of registration: rectangles, sampled at random.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "fovea/core/random.h"
#include "fovea/rigid_motion.h"

namespace fovea::test {

struct Rectangle {
  Eigen::Vector3d corner, edge_u, edge_v;
};

inline double gaussian(Random& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));
  return radius * std::cos(2 * std::numbers::pi * random.uniform());
}

/// Points at random on the rectangles, `density` per square meter, each axis with noise of `sigma`
/// m.
inline std::vector<Eigen::Vector3f> sample(const std::vector<Rectangle>& scene, double density,
                                           std::uint64_t seed, double sigma = 0) {
  Random random(seed);
  std::vector<Eigen::Vector3f> points;
  for (const Rectangle& r : scene) {
    const double area = r.edge_u.cross(r.edge_v).norm();
    for (int i = 0; i < static_cast<int>(area * density); ++i) {
      const double u = random.uniform();
      const double v = random.uniform();
      Eigen::Vector3d p = r.corner + u * r.edge_u + v * r.edge_v;
      for (int axis = 0; axis < 3; ++axis) p[axis] += sigma * gaussian(random);
      points.push_back(p.cast<float>());
    }
  }
  return points;
}

/// The upper and the four lateral faces of a box on the floor.
inline void add_box(std::vector<Rectangle>& scene, const Eigen::Vector3d& low,
                    const Eigen::Vector3d& size) {
  const Eigen::Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  scene.push_back({low, x, z});
  scene.push_back({low + y, x, z});
  scene.push_back({low, y, z});
  scene.push_back({low + x, y, z});
  scene.push_back({low + z, x, y});
}

/// Floor 1.7 m under the origin, two walls that meet in a corner, and three boxes.
inline std::vector<Rectangle> room_corner() {
  std::vector<Rectangle> scene = {
      {{-6, -6, -1.7}, {12, 0, 0}, {0, 12, 0}},
      {{6, -6, -1.7}, {0, 12, 0}, {0, 0, 4}},
      {{-6, 6, -1.7}, {12, 0, 0}, {0, 0, 4}},
  };
  add_box(scene, {2, -3, -1.7}, {1.5, 1, 1.2});
  add_box(scene, {-4, 2, -1.7}, {1, 2, 2.5});
  add_box(scene, {-3, -4, -1.7}, {2, 1, 0.8});
  return scene;
}

/// Floor and two walls along x, `half_length` to either side. They do not determine a position
/// along x.
inline std::vector<Rectangle> corridor(double half_length) {
  const Eigen::Vector3d along(2 * half_length, 0, 0);
  return {{{-half_length, -2, -1.7}, along, {0, 4, 0}},
          {{-half_length, -2, -1.7}, along, {0, 0, 4}},
          {{-half_length, 2, -1.7}, along, {0, 0, 4}}};
}

/// An open place: floor 1.7 m under the origin, and a few boxes far apart.
inline std::vector<Rectangle> open_place() {
  std::vector<Rectangle> scene = {{{-60, -60, -1.7}, {120, 0, 0}, {0, 120, 0}}};
  add_box(scene, {14, 5, -1.7}, {2, 2, 3});
  add_box(scene, {-18, -9, -1.7}, {3, 2, 4});
  add_box(scene, {6, -16, -1.7}, {2, 3, 3});
  add_box(scene, {-8, 20, -1.7}, {4, 2, 4});
  return scene;
}

/// Sixteen rings, 2 degrees apart.
inline std::vector<double> sixteen_rings() {
  std::vector<double> elevations;
  for (int ring = 0; ring < 16; ++ring) {
    elevations.push_back((15 - 2 * ring) * std::numbers::pi / 180);
  }
  return elevations;
}

/// A LiDAR scan of a scene: the nearest point of each ray, in the LiDAR's frame.
/// @param elevations  of the rings, rad
/// @param sigma       noise of a range, m
inline std::vector<Eigen::Vector3f> ring_scan(const std::vector<Rectangle>& scene,
                                              const RigidMotion& T_scene_lidar,
                                              const std::vector<double>& elevations,
                                              std::uint64_t seed, double sigma) {
  constexpr int kColumns = 900;
  Random random(seed);
  std::vector<Eigen::Vector3f> points;
  for (const double elevation : elevations) {
    for (int column = 0; column < kColumns; ++column) {
      const double azimuth = 2 * std::numbers::pi * column / kColumns;
      const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3d from = T_scene_lidar.translation();
      const Eigen::Vector3d along = T_scene_lidar.linear() * beam;
      double nearest = 100;
      for (const Rectangle& r : scene) {
        Eigen::Matrix3d M;  // from + range * along = corner + u * edge_u + v * edge_v
        M << along, -r.edge_u, -r.edge_v;
        const Eigen::Vector3d hit = M.fullPivLu().solve(r.corner - from);
        const bool inside = hit[1] >= 0 && hit[1] <= 1 && hit[2] >= 0 && hit[2] <= 1;
        if (inside && hit[0] > 0.5) nearest = std::min(nearest, hit[0]);
      }
      if (nearest == 100) continue;
      points.push_back(((nearest + sigma * gaussian(random)) * beam).cast<float>());
    }
  }
  return points;
}

inline std::vector<Eigen::Vector3f> transformed(const RigidMotion& T,
                                                const std::vector<Eigen::Vector3f>& points) {
  std::vector<Eigen::Vector3f> moved;
  moved.reserve(points.size());
  for (const Eigen::Vector3f& p : points) moved.push_back((T * p.cast<double>()).cast<float>());
  return moved;
}

inline RigidMotion motion(double rx, double ry, double rz, double tx, double ty, double tz) {
  Twist twist;
  twist << rx, ry, rz, tx, ty, tz;
  return exp_se3(twist);
}

}  // namespace fovea::test
