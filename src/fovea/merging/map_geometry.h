// What of a map tells where it lies: its measured points, thinned, a place at a time.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fovea/base/scratch_file.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// Lies in a scratch file, so that memory does not grow with the map.
class MapGeometry {
 public:
  /// Edge of the voxels, m, of which one point is left.
  static constexpr float kVoxel = 0.25f;

  /// InputError if the map is damaged.
  explicit MapGeometry(const MapReader& map);

  const std::vector<RigidMotion>& T_local_submap() const { return T_local_submap_; }

  /// The points in a ball, thinned once more, seen from its middle.
  /// @param center_local  m, in the map's local frame
  /// @param submap        only those of this one
  /// @return in the axes of local, relative to the centre
  std::vector<Eigen::Vector3f> points_near(const Eigen::Vector3d& center_local, double radius,
                                           std::optional<std::size_t> submap = {}) const;

 private:
  struct Tile {
    ScratchFile::Place points;  // submap frame, relative to the tile's origin
    Eigen::Vector3d origin;
  };

  double tile_reach_ = 0;  // m: a tile's points lie at most this far from its origin
  std::vector<RigidMotion> T_local_submap_;
  std::vector<std::vector<Tile>> tiles_;  // of each submap
  ScratchFile file_;
};

}  // namespace fovea
