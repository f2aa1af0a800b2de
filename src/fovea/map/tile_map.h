// The map in memory: submaps with poses of their own, and in each of them tiles of points.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/rigid_motion.h"

namespace fovea {

/// Cube of edge tile_size: tile (x, y, z) spans [x, x + 1) * tile_size, ... in its submap's frame.
struct TileKey {
  std::int32_t x = 0, y = 0, z = 0;
  friend auto operator<=>(const TileKey&, const TileKey&) = default;
};

/// About ten seconds of drive. A closed loop moves a submap's pose and never rewrites its points.
struct Submap {
  RigidMotion T_local_submap = RigidMotion::Identity();
  /// Points of each tile, submap frame, relative to the cloud's `origin` = the tile's lowest corner.
  /// Columns range, incidence, color, frame, camera, interpolated are always there.
  std::map<TileKey, PointCloud> tiles;
};

class TileMap {
 public:
  explicit TileMap(double tile_size = 4.0);

  double tile_size() const { return tile_size_; }
  const std::vector<Submap>& submaps() const { return submaps_; }
  std::size_t size() const { return size_; }

  /// Opens a new submap, which becomes the last.
  void add_submap(const RigidMotion& T_local_submap);

  /// Adds points to the last submap; std::logic_error without one or if a column of a tile is missing.
  /// @param points_local  local frame, any origin
  void add(const PointCloud& points_local);

  /// Puts back a tile that a store has kept (resume).
  void restore_tile(std::size_t submap, const TileKey& key, PointCloud tile);

  /// Calls f(T_local_submap, tile) for every tile that a ball of `radius` m around `center_local`
  /// touches, in the order of submaps and keys.
  void for_each_tile_near(
      const Eigen::Vector3d& center_local, double radius,
      const std::function<void(const RigidMotion&, const PointCloud&)>& f) const;

 private:
  double tile_size_;
  std::vector<Submap> submaps_;
  std::size_t size_ = 0;
};

}  // namespace fovea
