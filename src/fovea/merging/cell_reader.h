// Reads the points that maps have in one cell of a city's grid.
#pragma once

#include <filesystem>
#include <memory>
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

/// A map, and what it has in the cell.
struct CellSource {
  std::unique_ptr<MapReader> reader;
  MapContent content;
  const PlacedMap* placed = nullptr;
  std::string session;                     ///< recording day; empty if it is unknown
  std::vector<RigidMotion> T_cell_submap;  ///< east-north-up axes at the middle of the cell
  std::vector<CellPiece> pieces;
  std::size_t points = 0;     ///< in the cell
  std::size_t well_seen = 0;  ///< of these, by two or more images
};

class CellReader {
 public:
  /// @param city  must outlive the reader and what it reads
  CellReader(const CityPoses& city, const CityTile& tile, double tile_size);

  /// InputError if the map is damaged or merged, or is not in the poses.
  CellSource read(const std::filesystem::path& path) const;

  const GeodeticPoint& middle() const { return middle_; }
  const RigidMotion& T_ecef_cell() const { return T_ecef_cell_; }

 private:
  /// The points of a tile that lie in the cell.
  void take(const TileId& id, CellSource& source) const;

  const CityPoses& city_;
  CityTile tile_;
  CityGrid grid_;
  GeodeticPoint middle_;
  RigidMotion T_ecef_cell_;
};

}  // namespace fovea
