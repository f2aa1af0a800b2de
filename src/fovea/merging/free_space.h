// Space around a tile of a city that a drive saw as free.
#pragma once

#include <vector>

#include "fovea/map/tile_points.h"
#include "fovea/mapping/range_image.h"
#include "fovea/merging/map_content.h"

namespace fovea {

/// By the range images of a map. Space is free if three or more of them saw through it, and far
/// more than saw a surface there.
class FreeSpace {
 public:
  /// Reads the range images from where the tile is in reach.
  /// @param T_cell_submap  of the map's submaps
  /// @param size           of the tile around the origin of `cell`, m
  FreeSpace(const MapReader& map, const MapContent& content,
            const std::vector<RigidMotion>& T_cell_submap, double size);

  /// Whether no range image is in reach.
  bool empty() const { return views_.empty(); }
  /// Which points lie in free space.
  std::vector<bool> contains(const TilePoints& points, const RigidMotion& T_cell_submap) const;

 private:
  struct View {
    RangeImage image;
    RigidMotion T_sensor_cell;
  };
  std::vector<View> views_;
};

}  // namespace fovea
