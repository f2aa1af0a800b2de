// The part of a map that is seen from a place.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <vector>

#include "fovea/image.h"
#include "fovea/map/map_store.h"

namespace fovea {

/// A map's points as small discs of its surface. Columns have an entry a point.
struct MapSurfels {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< local frame, m
  std::vector<Eigen::Vector3f> position;             ///< axes of local, relative to the origin
  std::vector<Eigen::Vector3f> normal;  ///< unit, either way round; zero where the points say none
  std::vector<float> spacing;           ///< m, between neighbouring points
  std::vector<float> intensity;         ///< 0-1; luminance where the map has no reflectance
  std::vector<LogColor> color;
  std::vector<std::uint8_t> colored;  ///< 1 where a camera has seen it

  std::size_t size() const { return position.size(); }
  void append(const MapSurfels& other);
};

/// Reads tiles as places come near them and forgets them as they go: memory does not grow with the
/// map.
class MapWindow {
 public:
  /// @param map    must outlive this
  /// @param reach  m, how far is seen
  MapWindow(const MapReader& map, double reach);

  /// All of the map within reach, and a little beyond. Valid until the next call; the same object
  /// while nothing has changed. InputError if a tile is damaged.
  const MapSurfels& around(const Eigen::Vector3d& place_local);
  /// Counts how often what around() gives has changed.
  int version() const { return version_; }

 private:
  MapSurfels read(const TileId& id) const;

  const MapReader& map_;
  double reach_, tile_size_;
  std::vector<RigidMotion> T_local_submap_;
  std::vector<std::pair<TileId, Eigen::Vector3d>> tiles_;  // with their middles in local
  std::map<TileId, MapSurfels> near_;
  MapSurfels all_;
  int version_ = 0;
};

}  // namespace fovea
