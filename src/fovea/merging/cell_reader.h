// Reads the points that maps have in one cell of a city's grid.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fovea/geometry/city_grid.h"
#include "fovea/map/map_store.h"
#include "fovea/merging/city_poses.h"

namespace fovea {

/// The points of a map's tile that lie in the cell, in the colors of the city.
struct CellPiece {
  TileId id;  ///< in the map
  TilePoints points;
};

/// A map, and how much it has in the cell.
struct CellSource {
  std::unique_ptr<MapReader> reader;
  MapContent content;
  const PlacedMap* placed = nullptr;
  std::string session;                     ///< recording day; empty if it is unknown
  std::vector<RigidMotion> T_cell_submap;  ///< east-north-up axes at the middle of the cell
  std::size_t points = 0;                  ///< in the cell
  std::size_t points_of_two_views = 0;     ///< of these, by two or more images
};

class CellReader {
 public:
  /// @param city  must outlive the reader and what it reads
  CellReader(const CityPoses& city, const CityTile& tile, double tile_size);

  /// Reads the map to count its points in the cell. InputError if the map is damaged or merged, or
  /// is not in the poses.
  CellSource open(const std::filesystem::path& path) const;
  /// Calls f for what the map has in the cell, in the order of its tiles.
  void for_each_piece(const CellSource& source, const std::function<void(CellPiece&)>& f) const;

  const GeodeticPoint& middle() const { return middle_; }
  const RigidMotion& T_ecef_cell() const { return T_ecef_cell_; }

 private:
  /// The points of a tile that lie in the cell; without points if none does.
  CellPiece piece_of(const TileId& id, const CellSource& source) const;
  /// The cell that a whole tile of a map lies in; nothing if it lies in several.
  std::optional<CityTile> tile_of_box(const RigidMotion& T_ecef_submap,
                                      const Eigen::Vector3d& middle, double size) const;
  void keep_inside(const RigidMotion& T_ecef_submap, TilePoints& points) const;

  const CityPoses& city_;
  CityTile tile_;
  CityGrid grid_;
  GeodeticPoint middle_;
  RigidMotion T_ecef_cell_;
};

}  // namespace fovea
