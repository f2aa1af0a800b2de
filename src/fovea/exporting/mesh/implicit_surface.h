// Signed distances to the surface at the corners of voxels.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "fovea/exporting/mesh/surfels.h"
#include "fovea/geometry/voxel_table.h"

namespace fovea {

/// The surface as one side of it was seen.
struct SurfaceSide {
  float distance = 0;                                ///< voxels, positive on the side of the sensor
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit
};

/// The implicit moving least squares of Kolluri (Provably Good Moving Least Squares, SODA 2005):
/// the weighted mean of the distances from the surfels' planes. Where surfels with opposite normals
/// are near, the two sides of something thin, each side has a distance of its own, so that they do
/// not annihilate one another.
class ImplicitSurface {
 public:
  /// How far a surfel is felt, in cells.
  static constexpr int kReach = 3;
  /// Cosine between the mean normals of two sides of something thin; between two walls of a corner
  /// it is larger, and these are one surface.
  static constexpr float kOpposite = -0.5f;

  explicit ImplicitSurface(const Surfels& surfels);

  /// Corners near surfels, by numbers; corner (0, 0, 0) is the block's lowest one. From -1 to
  /// kBlockVoxels on each axis.
  const VoxelTable& corners() const { return corners_; }
  struct Sides {
    std::array<SurfaceSide, 2> side;
    std::size_t count = 0;
    auto begin() const { return side.begin(); }
    auto end() const { return side.begin() + static_cast<std::ptrdiff_t>(count); }
  };
  const Sides& sides(std::uint32_t corner) const { return sides_[corner]; }

 private:
  VoxelTable corners_{1.f};
  std::vector<Sides> sides_;  // by the corner's number
};

}  // namespace fovea
