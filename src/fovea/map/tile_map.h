// The map in memory: submaps with poses of their own, and in each of them tiles of points.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "fovea/base/point_cloud.h"
#include "fovea/geometry/rigid_motion.h"

namespace fovea {

/// Cube of edge tile_size: tile (x, y, z) spans [x, x + 1) * tile_size, ... in its submap's frame.
struct TileKey {
  std::int32_t x = 0, y = 0, z = 0;
  friend auto operator<=>(const TileKey&, const TileKey&) = default;
};

/// A tile of a map.
struct TileId {
  std::size_t submap = 0;
  TileKey key;
  friend auto operator<=>(const TileId&, const TileId&) = default;
};

/// Some seconds of drive. A closed loop moves a submap's pose and never rewrites its points.
struct Submap {
  RigidMotion T_local_submap = RigidMotion::Identity();
  /// Points of each tile, submap frame, relative to the cloud's `origin` = the tile's lowest
  /// corner. Columns range, incidence, color, frame, camera, interpolated, views, spread,
  /// weight and reason are always there; intensity in all tiles of a map or in none; normals are
  /// not kept.
  std::map<TileKey, PointCloud> tiles;
};

/// What tells of the points' colours in a tile, to be changed in place.
struct TileColors {
  std::span<Rgb> color;
  std::span<std::uint8_t> views, spread;
  std::span<std::uint16_t> weight;
};

/// Throws std::logic_error that names a column which a tile must have and `cloud` lacks, or a
/// column of a wrong length.
void check_tile_columns(const PointCloud& cloud);

class TileMap {
 public:
  /// @param tile_size  edge of a tile, m; std::invalid_argument unless positive and finite
  explicit TileMap(double tile_size = 4.0);

  double tile_size() const { return tile_size_; }
  const std::vector<Submap>& submaps() const { return submaps_; }
  std::size_t size() const { return size_; }

  /// Opens a new submap, which becomes the last.
  void add_submap(const RigidMotion& T_local_submap);

  /// Puts a submap elsewhere, with all its points; std::logic_error if it does not exist,
  /// std::invalid_argument if the pose is not finite.
  void move_submap(std::size_t submap, const RigidMotion& T_local_submap);

  /// Adds points to the last submap; std::logic_error without one, if a column of a tile is
  /// missing, if intensity is there in some calls only, or if a position is not finite.
  /// @param points_local  local frame, any origin
  /// @return the tiles of the last submap that grew, ascending: what a store must write again
  std::vector<TileKey> add(const PointCloud& points_local);

  /// Puts back a tile that a store has kept (resume); std::logic_error if the submap does not
  /// exist, the tile does already, or its columns or origin are not those of a tile with this key.
  void restore_tile(std::size_t submap, const TileKey& key, PointCloud tile);

  /// Keeps only the points at `indices` (ascending) of a tile, and drops a tile that gets empty;
  /// std::logic_error if the tile does not exist.
  void keep_points(const TileId& id, const std::vector<std::uint32_t>& indices);

  /// The colours of a tile; std::logic_error if it does not exist. For two tiles at a time from two
  /// threads.
  TileColors colors(const TileId& id);

  /// Calls f for every tile that a ball of `radius` m around `center_local` touches, in the order
  /// of submaps and keys.
  void for_each_tile_near(const Eigen::Vector3d& center_local, double radius,
                          const std::function<void(const TileId&, const PointCloud&)>& f) const;

 private:
  Eigen::Vector3d corner(const TileKey& key) const;
  PointCloud& existing_tile(const TileId& id);
  void require_same_columns(const PointCloud& cloud);

  double tile_size_;
  std::vector<Submap> submaps_;
  std::size_t size_ = 0;
  std::optional<bool> has_intensity_;  // known from the first points on
};

}  // namespace fovea
