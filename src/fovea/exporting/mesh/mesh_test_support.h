// Known surfaces for tests of meshes.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "fovea/core/random.h"
#include "fovea/exporting/mesh/mesh_levels.h"

namespace fovea {

inline constexpr double kTestVoxel = 0.1;

/// Points of surfaces, by blocks that count from the coordinates' origin.
class TestPoints {
 public:
  explicit TestPoints(double voxel = kTestVoxel) : points_(voxel) {}

  void add(const Eigen::Vector3d& p, const Eigen::Vector3d& sensor, Rgb color = {90, 100, 110},
           bool colored = true) {
    const double edge = block_edge(points_.voxel());
    const Eigen::Array3i block = (p / edge).array().floor().cast<int>();
    const Eigen::Vector3d corner = edge * block.matrix().cast<double>();
    SeenPoint point = seen_point((p - corner).cast<float>(), (sensor - p).cast<float>());
    point.colored = colored;
    point.color = color;
    waiting_[BlockKey::of(block)].push_back(point);
  }

  /// A square of points 2 cm apart, with noise along its normal.
  /// @param u, v  its edges, m
  void add_square(const Eigen::Vector3d& low, const Eigen::Vector3d& u, const Eigen::Vector3d& v,
                  const Eigen::Vector3d& sensor, double noise = 0, Rgb color = {90, 100, 110}) {
    const Eigen::Vector3d normal = u.cross(v).normalized();
    const double step_u = 0.02 / u.norm(), step_v = 0.02 / v.norm();
    for (double a = step_u / 2; a < 1; a += step_u) {
      for (double b = step_v / 2; b < 1; b += step_v) {
        add(low + a * u + b * v + noise * random_.uniform(-1, 1) * normal, sensor, color);
      }
    }
  }

  /// A sphere seen from all around, points about 2 cm apart.
  void add_sphere(const Eigen::Vector3d& center, double radius) {
    const int count = static_cast<int>(4 * M_PI * radius * radius / (0.02 * 0.02));
    for (int i = 0; i < count; ++i) {  // Fibonacci's lattice
      const double z = 1 - (2 * i + 1.0) / count, turn = M_PI * (3 - std::sqrt(5.0)) * i;
      const double r = std::sqrt(1 - z * z);
      const Eigen::Vector3d out(r * std::cos(turn), r * std::sin(turn), z);
      add(center + radius * out, center + 10 * out);
    }
  }

  const PointBlocks& blocks() {
    for (const auto& [key, points] : waiting_) points_.append(key, points);
    waiting_.clear();
    return points_;
  }

 private:
  PointBlocks points_;
  std::map<BlockKey, std::vector<SeenPoint>> waiting_;
  Random random_{7};
};

/// The blocks' triangles in one, vertices that are the same being one.
struct TestMesh {
  std::vector<MeshVertex> vertices;  // `place` from the coordinates' origin
  std::vector<std::array<std::uint32_t, 3>> triangles;
  double voxel;

  Eigen::Vector3d position(std::size_t vertex) const { return voxel * place_of(vertices[vertex]); }
  Eigen::Vector3d normal(std::size_t t) const {
    const auto [a, b, c] = triangles[t];
    return (position(b) - position(a)).cross(position(c) - position(a));
  }
};

inline TestMesh mesh_of(const PointBlocks& points) {
  TestMesh whole{{}, {}, points.voxel()};
  std::map<std::array<int, 3>, std::uint32_t> number_of_place;
  for_each_block_mesh(points, [&](const BlockKey& key, const BlockMesh& mesh) {
    std::vector<std::uint32_t> number;
    for (MeshVertex vertex : mesh.patch.vertices) {
      vertex.place += key.array() * kBlockVoxels * kVoxelSteps;
      const auto [found, is_new] =
          number_of_place.try_emplace({vertex.place.x(), vertex.place.y(), vertex.place.z()},
                                      static_cast<std::uint32_t>(whole.vertices.size()));
      if (is_new) whole.vertices.push_back(vertex);
      number.push_back(found->second);
    }
    for (const auto& t : mesh.patch.triangles) {
      whole.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
    }
  });
  return whole;
}

/// What holds of every mesh.
inline void expect_sound(const MeshPatch& patch) {
  std::set<std::uint32_t> used;
  for (const auto& t : patch.triangles) {
    for (const std::uint32_t vertex : t) ASSERT_LT(vertex, patch.vertices.size());
    const auto place = [&](std::size_t i) -> Eigen::Vector3d {
      return patch.vertices[t[i]].place.matrix().cast<double>();
    };
    EXPECT_GT((place(1) - place(0)).cross(place(2) - place(0)).norm(), 0);
    used.insert(t.begin(), t.end());
  }
  EXPECT_EQ(used.size(), patch.vertices.size());
  for (const MeshVertex& vertex : patch.vertices) EXPECT_NEAR(vertex.normal.norm(), 1, 1e-5);
}

/// Edges that only one triangle has: the mesh's border.
inline std::size_t open_edges(const TestMesh& mesh) {
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) edges.insert({t[i], t[(i + 1) % 3]});
  }
  std::size_t open = 0;
  for (const auto& [a, b] : edges) open += edges.count({b, a}) == 0;
  return open;
}

}  // namespace fovea
