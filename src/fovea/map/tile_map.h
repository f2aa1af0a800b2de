// The map in memory: submaps with poses of their own, and in each of them tiles of points.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "fovea/map/tile_points.h"
#include "fovea/point_cloud.h"
#include "fovea/rigid_motion.h"

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

/// A tile in memory. A snapshot of its points never changes: the first change after take_changes()
/// copies the points.
class Tile {
 public:
  /// A new tile.
  Tile() : points(std::make_shared<TilePoints>()), has_changed_(true) {}
  /// A tile that was read from the map's file.
  explicit Tile(TilePoints stored) : points(std::make_shared<TilePoints>(std::move(stored))) {}
  Tile(const Tile& other)
      : points(std::make_shared<TilePoints>(*other.points)), has_changed_(other.has_changed_) {}
  Tile(Tile&&) = default;
  Tile& operator=(const Tile&) = delete;

  /// To keep them for longer than until the next edit(), take a snapshot.
  std::shared_ptr<const TilePoints> points;

  bool has_changed() const { return has_changed_; }
  /// The points, to be changed. Earlier references to them are invalid.
  TilePoints& edit();
  /// Shares the points as they are. has_changed() is false until the next edit().
  std::shared_ptr<const TilePoints> take_snapshot() {
    has_changed_ = false;
    return points;
  }

 private:
  bool has_changed_ = false;  // since take_snapshot(): no snapshot shares the points
};

/// Some seconds of drive. A closed loop changes a submap's pose and gain, never its points.
struct Submap {
  RigidMotion T_local_submap = RigidMotion::Identity();
  /// From the colors of its points to the exposure of the map, base-2 logarithms.
  LogGain log2_gain = LogGain::Zero();
  std::map<TileKey, Tile> tiles;
  /// Tiles that a store keeps while they are out of reach, and how many points each has.
  std::map<TileKey, std::size_t> stored;
  /// The box of tiles around all of them.
  TileKey low, high;
};

/// Tiles that have changed since the last take_changes().
struct TileChanges {
  struct Changed {
    TileId id;
    std::shared_ptr<const TilePoints> points;
  };
  std::vector<Changed> changed;
  std::vector<TileId> removed;
};

/// Points are added to the last submap. A store may take tiles that are far away, and return them
/// when they are near. All methods that read or change points use only the tiles in memory.
class TileMap {
 public:
  /// @param tile_size  edge of a tile, m; std::invalid_argument unless positive and at most 65.5
  explicit TileMap(double tile_size = 4.0);

  double tile_size() const { return tile_size_; }
  const std::vector<Submap>& submaps() const { return submaps_; }
  /// Points of all tiles, and of those in memory.
  std::size_t size() const { return size_; }
  std::size_t size_in_memory() const { return size_in_memory_; }

  /// Opens a new submap, which becomes the last.
  void add_submap(const RigidMotion& T_local_submap);

  /// Puts a submap elsewhere, with all its points; std::logic_error if it does not exist,
  /// std::invalid_argument if the pose is not finite.
  void move_submap(std::size_t submap, const RigidMotion& T_local_submap);

  /// Moves submaps to these poses (T_local_submap), and opens those that do not exist yet.
  void place_submaps(const std::vector<RigidMotion>& poses);
  /// Sets the gains of the first submaps.
  void set_gains(const std::vector<LogGain>& log2_gains);

  /// Adds points to the last submap; std::logic_error without one, if a column of a tile is
  /// missing, if intensity is there in some calls only, if a position is not finite or if a tile
  /// that they belong to is stored.
  /// @param points_local  local frame, any origin
  void add(const PointCloud& points_local);

  /// Keeps only the points at `indices` (ascending) of a tile, and drops a tile that gets empty;
  /// std::logic_error if the tile is not in memory.
  void keep_points(const TileId& id, const std::vector<std::uint32_t>& indices);

  /// The colours of a tile, to be changed in place; std::logic_error if it is not in memory. For
  /// two tiles at a time from two threads.
  std::span<FusedColor> colors(const TileId& id);
  /// Says which camera gave some points of a tile their first colour; std::logic_error if the tile
  /// is not in memory.
  /// @param indices  of the points, ascending
  void put_camera(const TileId& id, std::span<const std::uint32_t> indices, std::int8_t camera);

  /// Calls f for every tile in memory that a ball of `radius` m around `center_local` touches, in
  /// the order of submaps and keys.
  void for_each_tile_near(const Eigen::Vector3d& center_local, double radius,
                          const std::function<void(const TileId&, const TilePoints&)>& f) const;

  /// Snapshots of the tiles that changed since the last call.
  TileChanges take_changes();
  /// Drops from memory the unchanged tiles that a ball does not touch, but none of the last submap:
  /// the store has them.
  void drop_beyond(const Eigen::Vector3d& center_local, double radius);
  /// The stored tiles that a ball touches, and those of the last submap, which points are added to
  /// wherever they are; in the order of submaps and keys.
  std::vector<TileId> stored_near(const Eigen::Vector3d& center_local, double radius) const;
  /// Tells of a tile of an earlier run that a store has; std::logic_error if the submap does not
  /// exist or the tile does already.
  void declare_stored(const TileId& id, std::size_t points);
  /// Puts a stored tile back into memory; std::logic_error if it is not stored, or its number of
  /// points, columns or origin are not those of the tile.
  void restore(const TileId& id, TilePoints tile);

 private:
  Eigen::Vector3d corner(const TileKey& key) const;
  Tile& existing_tile(const TileId& id);
  void require_same_columns(bool has_intensity);
  /// Calls f(id, value) for what a map by keys of each submap has within a ball.
  template <class Tiles, class F>
  void for_each_near(Tiles Submap::* tiles, const Eigen::Vector3d& center_local, double radius,
                     F&& f) const;

  double tile_size_;
  std::vector<Submap> submaps_;
  std::vector<TileId> removed_;
  std::size_t size_ = 0, size_in_memory_ = 0;
  std::optional<bool> has_intensity_;  // known from the first points on
};

}  // namespace fovea
