// A city: a folder with one map for each tile, and the manifest that lists them (docs/city.md).
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "fovea/geometry/city_grid.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// A tile with points.
struct CityTileFile {
  CityTile tile;
  std::filesystem::path map;  ///< its map file; local frame: east-north-up at the tile's middle
  std::size_t points = 0;
  int revision = 0;  ///< of the city, when the tile last changed
};

struct CityDrive {
  std::string name;
  std::filesystem::path path;
  std::size_t frames = 0;
  double length = 0;                        ///< m
  std::vector<std::filesystem::path> maps;  ///< of its segments, in order
};

/// The frame `local` of a city is east-north-up at the origin of its grid.
struct City {
  std::filesystem::path folder;
  int revision = 0;
  GeodeticPoint origin;  ///< of the grid
  double tile_size = 0;  ///< m
  std::string session;   ///< whose colors count first (TileFusionJob::session)
  std::filesystem::path poses;
  std::vector<CityDrive> drives;    ///< by name
  std::vector<CityTileFile> tiles;  ///< by x, then y

  std::size_t points() const;
  /// From the first to the last column and row of tiles, m.
  std::array<double, 2> extent() const;
  /// T_local_tile of a tile's map.
  RigidMotion T_local_tile(const CityTile& tile) const;
  /// Numbers of the tiles of which some part lies within `radius` (m) of a place, at any height.
  std::vector<std::size_t> tiles_near(const Eigen::Vector3d& center_local, double radius) const;
  /// Of all places of a path.
  std::vector<std::size_t> tiles_near(std::span<const Eigen::Vector3d> path_local,
                                      double radius) const;
};

/// The file with a coarse picture of a tile, next to its map: MAP.overview.glb. It may be missing.
std::filesystem::path overview_of_tile(const std::filesystem::path& map);

/// Hash of the places of all tiles and of the digests of their maps: 32 hexadecimal digits. Names
/// of files and the revision do not count. InputError if a map is damaged.
std::string city_digest(const City& city);

/// Whether a path is a folder, or a manifest of a city: no map is a folder.
bool is_city(const std::filesystem::path& path);

/// Reads the manifest: city.json of a folder, or an older manifest that `path` names. InputError if
/// it is damaged, is of another version, or if a tile's file is missing.
City open_city(const std::filesystem::path& path);

}  // namespace fovea
