// What of a map tells where it lies: its measured points, thinned, a place at a time.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "fovea/core/scratch_file.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// A tile is read when a place near it is asked for, and then lies thinned in a scratch file:
/// neither memory nor the time to begin grows with the map.
class MapSurfaces {
 public:
  /// Edge of the voxels, m, of which one point is left.
  static constexpr float kVoxel = 0.25f;

  /// Looks up what tiles there are. InputError if the map is damaged.
  /// @param map  must outlive this
  explicit MapSurfaces(const MapReader& map);

  const std::vector<RigidMotion>& T_local_submap() const { return T_local_submap_; }

  /// The points in a ball, thinned once more, seen from its middle. InputError if a tile is
  /// damaged.
  /// @param center_local  m, in the map's local frame
  /// @param submap        only those of this one
  /// @return in the axes of local, relative to the centre
  std::vector<Eigen::Vector3f> points_near(const Eigen::Vector3d& center_local, double radius,
                                           std::optional<std::size_t> submap = {});

 private:
  struct Tile {
    TileKey key;
    std::optional<ScratchFile::Place> points;  // submap frame, relative to the origin; once read
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  };
  void read(std::size_t submap, Tile& tile);

  const MapReader& map_;
  double tile_size_;  // m
  std::vector<RigidMotion> T_local_submap_;
  std::vector<std::vector<Tile>> tiles_;  // of each submap
  ScratchFile file_;
};

}  // namespace fovea
