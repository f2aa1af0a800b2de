// The triangles of one block.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fovea/platform.h"

namespace fovea {

/// Vertices lie on a grid of so many steps a voxel: neighbours round them alike.
inline constexpr int kVoxelSteps = 256;

struct MeshVertex {
  Eigen::Array3i place;                ///< steps from the block's lowest corner
  Eigen::Vector3f normal;              ///< unit
  std::array<std::uint16_t, 3> light;  ///< linear light, 0-65535
  bool colored;                        ///< else grey: no camera has coloured a point near it
  /// The block's faces where its voxel is shared with a neighbour, a bit each: low x, y, z, high x,
  /// y, z.
  std::uint8_t faces;
};

struct MeshPatch {
  std::vector<MeshVertex> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise from the seen side

  bool empty() const { return triangles.empty(); }
};

/// A vertex from the block's lowest corner, in voxels.
inline Eigen::Vector3d place_of(const MeshVertex& vertex) {
  return vertex.place.matrix().cast<double>() / kVoxelSteps;
}

}  // namespace fovea
