// Pieces of surface in and around a block: points with normals.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "fovea/exporting/mesh/point_blocks.h"
#include "fovea/geometry/voxel_table.h"

namespace fovea {

/// Lengths are cells. Whatever is computed of surfels takes their places relative to each other, by
/// the difference of their cells, an integer: it comes out bit for bit the same in each block that
/// has them.
struct Surfel {
  Eigen::Vector3i cell;     ///< from the block's first one; negative before it
  Eigen::Vector3f offset;   ///< in its cell, 0 to 1
  Eigen::Vector3f towards;  ///< the sensor that saw it; unit
  Eigen::Vector3f normal;   ///< unit, on that side; zero where too few points are around
  bool colored;
  Eigen::Vector3f color;  ///< sRGB, 0-255; meaningful where colored
};

class Surfels {
 public:
  /// How far around the block there are surfels, and up to where these have their normals.
  static constexpr int kMargin = 10, kNormalMargin = 6;

  /// OutputError if a scratch file cannot be read.
  Surfels(const PointBlocks& points, const BlockKey& block);

  /// In the order of their cells' z, y, x.
  const std::vector<Surfel>& all() const { return surfels_; }
  /// How many of the block itself have no normal.
  std::size_t lonely() const { return lonely_; }
  /// How many the block itself has.
  std::size_t own() const { return own_; }

  /// Calls f(surfel, place) for those near a place, in the order of all(); `place` is theirs
  /// relative to it.
  /// @param cell, offset  the place
  /// @param reach         at least all within so many cells
  template <class F>
  void for_each_near(const Eigen::Vector3i& cell, const Eigen::Vector3f& offset, int reach,
                     F&& f) const {
    Eigen::Vector3i step;
    for (step.z() = -reach; step.z() <= reach; ++step.z()) {
      for (step.y() = -reach; step.y() <= reach; ++step.y()) {
        for (step.x() = -reach; step.x() <= reach; ++step.x()) {
          for (const Surfel& surfel : of(cell + step)) {
            f(surfel, Eigen::Vector3f(step.cast<float>() + (surfel.offset - offset)));
          }
        }
      }
    }
  }

 private:
  std::span<const Surfel> of(const Eigen::Vector3i& cell) const;
  void find_normal(Surfel& surfel);

  std::vector<Surfel> surfels_;
  VoxelTable cells_{1.f};
  std::vector<std::size_t> first_;  // of each cell in surfels_
  std::size_t own_ = 0, lonely_ = 0;
};

/// Falls from 1 in the middle to 0, with its slope, at a radius.
inline float bump(float squared_distance, float radius) {
  const float rest = 1 - squared_distance / (radius * radius);
  return rest > 0 ? rest * rest : 0;
}

}  // namespace fovea
