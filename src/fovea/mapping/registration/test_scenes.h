// Analytic scenes for the tests of registration: rectangles, sampled at random.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <vector>

#include "fovea/base/random.h"
#include "fovea/geometry/rigid_motion.h"

namespace fovea::test {

struct Rectangle {
  Eigen::Vector3d corner, edge_u, edge_v;
};

inline double gaussian(Random& random) {
  const double radius = std::sqrt(-2 * std::log(1 - random.uniform()));
  return radius * std::cos(2 * std::numbers::pi * random.uniform());
}

/// Points at random on the rectangles, `density` a square metre, each axis with noise of `sigma` m.
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

/// The upper and the four lateral faces of a box that stands on the floor.
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

/// Floor and two walls along x, `half_length` to either side: nothing tells where along x one is.
inline std::vector<Rectangle> corridor(double half_length) {
  const Eigen::Vector3d along(2 * half_length, 0, 0);
  return {{{-half_length, -2, -1.7}, along, {0, 4, 0}},
          {{-half_length, -2, -1.7}, along, {0, 0, 4}},
          {{-half_length, 2, -1.7}, along, {0, 0, 4}}};
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
