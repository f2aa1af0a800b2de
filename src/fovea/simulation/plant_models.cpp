#include <cmath>
#include <numbers>

#include "fovea/core/random.h"
#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/models.h"

namespace fovea {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

Vector3d random_direction(Random& random) {
  const double z = random.uniform(-1, 1), a = random.uniform(0, 2 * std::numbers::pi);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(a), r * std::sin(a), z};
}

/// Leaves in the outer part of a ball, each a bent pair of triangles turned anyhow.
void add_leaves(MeshBuilder& make, Random& random, const Vector3d& center, double radius, int count,
                double size, int& leaf) {
  for (int i = 0; i < count; ++i, ++leaf) {
    const Vector3d away = random_direction(random);
    const Vector3d place = center + radius * std::cbrt(random.uniform(0.25, 1)) * away;
    const Vector3d u = random_direction(random), v = u.unitOrthogonal();
    const double s = size * random.uniform(0.7, 1.3);
    const auto id = static_cast<float>(leaf) + 0.5f;
    const auto at = [&](double a, double b) { return Vector3f(float(a * s), float(b * s), id); };
    make.quad({place - s * u, place - 0.45 * s * v, place + s * u, place + 0.45 * s * v},
              {at(0, 1), at(0.5, 0.5), at(2, 1), at(1, 1.5)});
  }
}

}  // namespace

Model make_tree(const Palette& palette, int variant) {
  Random random(1000 + static_cast<std::uint64_t>(variant));
  MeshBuilder make;
  make.material = palette.bark;
  const double trunk = random.uniform(2.3, 3.0), radius = random.uniform(0.12, 0.18);
  const double fork_y = random.uniform(-0.1, 0.1);
  const Vector3d fork(random.uniform(-0.1, 0.1), fork_y, trunk);
  make.bar(Vector3d::Zero(), fork, 1.25 * radius, radius, 12);
  std::vector<std::pair<Vector3d, double>> balls{{fork + Vector3d(0, 0, 1.6), 1.15}};
  const int branches = 6;
  for (int k = 0; k < branches; ++k) {
    const double a = 2 * std::numbers::pi * (k + random.uniform(-0.2, 0.2)) / branches;
    const double reach = random.uniform(0.8, 1.3), rise = random.uniform(0.7, 1.7);
    const Vector3d tip = fork + Vector3d(reach * std::cos(a), reach * std::sin(a), rise);
    make.bar(fork - Vector3d(0, 0, 0.15), tip, 0.45 * radius, 0.2 * radius, 6);
    balls.emplace_back(tip, random.uniform(0.75, 1.05));
  }
  make.bar(fork, fork + Vector3d(0, 0, 1.6), 0.6 * radius, 0.25 * radius, 6);
  make.material = palette.leaves[static_cast<std::size_t>(variant) % palette.leaves.size()];
  int leaf = 0;
  for (const auto& [center, size] : balls) {
    add_leaves(make, random, center, size, static_cast<int>(260 * size * size), 0.13, leaf);
  }
  return {"tree", make.take(), 7.5, {}};
}

Model make_bush(const Palette& palette, int variant) {
  Random random(2000 + static_cast<std::uint64_t>(variant));
  MeshBuilder make;
  make.material = palette.bark;
  for (int k = 0; k < 4; ++k) {
    make.bar(Vector3d::Zero(), {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0.6}, 0.02,
             0.01, 5);
  }
  make.material = palette.leaves[static_cast<std::size_t>(variant) % palette.leaves.size()];
  int leaf = 0;
  for (int k = 0; k < 3; ++k) {
    const double y = random.uniform(-0.25, 0.25);
    const Vector3d center(random.uniform(-0.25, 0.25), y, 0.45);
    add_leaves(make, random, center, 0.45, 150, 0.06, leaf);
  }
  return {"bush", make.take(), 1.6, {}};
}

}  // namespace fovea
