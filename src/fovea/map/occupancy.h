// Which cells of a fine grid hold a point of the map: what keeps its density even.
#pragma once

#include <cstdint>
#include <map>
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

  /// Whether a point of any submap lies in the cell of `p_grid` there. Thread-safe.
  /// @param p_grid  m, in the frame of the last submap
  bool taken(const Eigen::Vector3d& p_grid) const;

 private:
  using Cell = Eigen::Array3i;
  struct Tile {
    std::size_t points = 0;           // of the tile, that are marked
    std::vector<std::int32_t> brick;  // by place in the tile; kNoBrick: empty
    std::vector<CellBrick> bricks;
  };
  /// The tiles of one submap in the box of tile numbers around them.
  struct Window {
    Eigen::Matrix3d R_submap_last;
    Eigen::Vector3d t_submap_last;
    Eigen::Array3i low, size;
    std::vector<const Tile*> tiles;
  };

  void take_in(const PointCloud& points, Tile& tile) const;
  void open_windows(const TileMap& map);
  bool is_marked(const Window& window, const Eigen::Vector3d& p_submap) const;
  std::size_t place_of(const Cell& brick) const;

  int edge_;  // cells of a tile
  double tile_size_, cell_;
  std::map<TileId, Tile> tiles_;
  std::vector<Window> windows_;  // the last submap's is the last
};

}  // namespace fovea
