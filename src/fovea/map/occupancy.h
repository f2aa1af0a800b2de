// Which cells of a fine grid hold a point of the map: what keeps its density even.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "fovea/geometry/cell_brick.h"
#include "fovea/map/tile_map.h"

namespace fovea {

/// Occupied cells of a map's tiles within reach. Each submap has a grid of its own, in its frame.
class Occupancy {
 public:
  /// @param spacing  edge of a cell, m; rounded so that a tile has a multiple of 8 cells an edge
  Occupancy(double tile_size, double spacing);

  /// Edge of a cell, m.
  double cell() const { return cell_; }

  /// Takes in the points within `radius` m that came since the last call, or went; forgets tiles
  /// beyond. To be called between two changes of the map: points that go while others come to the
  /// same tile would not be noticed.
  void follow(const TileMap& map, const Eigen::Vector3d& center_local, double radius);

  /// The cells of the last submap that hold one of its points, a brick by its number
  /// (CellBrick::number_of); nullptr where none does. Thread-safe, valid until the next follow().
  const CellBrick* brick(const Eigen::Array3i& number) const;

  /// Whether a point of any submap before it lies in the cell of `p_last` there. Thread-safe.
  /// @param p_last  m, in the frame of the last submap
  bool taken_before(const Eigen::Vector3d& p_last) const;

 private:
  using Cell = Eigen::Array3i;
  struct Tile {
    std::size_t points = 0;           // of the tile, that are marked
    std::vector<std::int32_t> brick;  // by place in the tile; kNoBrick: empty
    std::vector<CellBrick> bricks;
  };
  /// Where a brick's number along one axis leads: added up over the axes, to a place among a
  /// window's tiles and to one among a tile's bricks.
  struct Place {
    std::uint32_t tile = 0, brick = 0;
  };
  /// The tiles of one submap in the box of tile numbers around them.
  struct Window {
    /// From the frame of the last submap, m, to cells, counted from the box's lowest corner.
    Eigen::Matrix3d R_cells_last;
    Eigen::Vector3d t_cells_last;
    Eigen::Vector3d size;                      // cells
    Eigen::Array3i low, bricks;                // the box's lowest brick, and how many it has
    std::array<std::vector<Place>, 3> places;  // of each brick of the box, an axis
    std::vector<const Tile*> tiles;
  };

  void take_in(const TilePoints& points, Tile& tile) const;
  void open_windows(const TileMap& map);
  std::array<std::vector<Place>, 3> places_of(const Eigen::Array3i& tiles) const;
  static bool is_marked(const Window& window, const Eigen::Vector3d& p_last);
  /// @param place  of the brick among the window's
  static const CellBrick* brick_at(const Window& window, const Eigen::Array3i& place);
  std::size_t place_of(const Cell& brick) const;

  int edge_;  // cells of a tile
  double cell_;
  std::map<TileId, Tile> tiles_;
  std::vector<Window> windows_;  // of the submaps before the last
  std::optional<Window> own_;    // of the last
};

}  // namespace fovea
