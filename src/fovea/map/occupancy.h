// Which cells of a map hold a point: what keeps its density even.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "fovea/geometry/cell_brick.h"
#include "fovea/map/tile_map.h"

namespace fovea {

/// Cells of a map's tiles within reach. Each submap has a grid of its own, in its frame. At
/// sampling level n a cell has 2^n times the edge of the finest, and holds 2^n cells of those along
/// each axis.
class Occupancy {
 public:
  /// @param spacing  edge of a finest cell, m; rounded so that a tile has a multiple of 16 cells an
  ///                 edge, of two equally near ones the smaller
  Occupancy(double tile_size, double spacing);

  /// Edge of a finest cell, m.
  double cell() const { return cell_; }

  /// Takes in the points within `radius` m that came since the last call, or went; forgets tiles
  /// beyond. To be called between two changes of the map: points that go while others come to the
  /// same tile would not be noticed.
  void follow(const TileMap& map, const Eigen::Vector3d& center_local, double radius);

  /// Whether the cell around a place holds a point. Thread-safe, valid until the next follow().
  /// @param p_last  m, in the frame of the last submap
  /// @param level   of the cell
  /// @param most    highest sampling level of the points that count
  bool holds_point(const Eigen::Vector3d& p_last, int level, int most) const;

 private:
  /// The points of one sampling level in a tile.
  struct Level {
    std::vector<std::int32_t> brick;  // by place in the tile; kNoBrick: empty
    std::vector<CellBrick> bricks;
  };
  struct Tile {
    std::size_t points = 0;  // of the tile, that are marked
    std::array<Level, kSamplingLevels> levels;
  };
  /// The tiles of one submap in the box of tile numbers around them.
  struct Window {
    /// From the frame of the last submap, m, to cells, counted from the box's lowest corner.
    Eigen::Matrix3d R_cells_last;
    Eigen::Vector3d t_cells_last;
    Eigen::Array3i size;  // tiles
    std::vector<const Tile*> tiles;
    /// Around the tiles that have points up to each level, frame of the last submap.
    std::array<Eigen::AlignedBox3d, kSamplingLevels> box_last;
  };

  void take_in(const TilePoints& points, Tile& tile) const;
  void open_windows(const TileMap& map);
  void bound(const RigidMotion& T_last_submap, double tile_size, const TileKey& key,
             const Tile& tile, Window& window) const;
  /// Whether a cube of cells of level `n` holds a point of that level.
  /// @param low, edge  of the cube, in cells of the tile: in one brick
  bool is_marked(const Level& points, int n, const Eigen::Array3i& low, int edge) const;
  bool holds_point(const Tile& tile, const Eigen::Array3i& cell, int level, int most) const;
  /// Bricks along the edge of a tile.
  int bricks_at(int level) const;

  int edge_;  // finest cells of a tile
  double cell_, tiles_per_cell_;
  std::map<TileId, Tile> tiles_;
  std::vector<Window> windows_;
};

}  // namespace fovea
