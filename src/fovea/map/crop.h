// A part of a map as a map of its own.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/map/map_store.h"

namespace fovea {

/// What to keep, in the local frame, m.
class CropRegion {
 public:
  /// "x0,y0,z0,x1,y1,z1": a box from one corner to the other, borders included. ConfigError if it
  /// cannot be read, or has no volume.
  static CropRegion box(std::string_view text);
  /// "x,y x,y x,y ...": the inside of a polygon seen from above, at any height; where it crosses
  /// itself what an odd number of its turns enclose. ConfigError if it cannot be read or has fewer
  /// than three corners.
  static CropRegion polygon(std::string_view text);

  bool contains(const Eigen::Vector3d& p_local) const;
  /// As it was given: "box ..." or "polygon ..."
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  Eigen::Vector3d low_, high_;            // of a box, or around the polygon
  std::vector<Eigen::Vector2d> polygon_;  // empty: a box
};

struct CropFigures {
  std::size_t points = 0, left_out = 0;
};

/// Writes the points of a map that lie in a region, with all frames and submaps, and commits. The
/// new map's `crop` in meta says what was kept. Memory: one tile. Errors as of reader and writer.
CropFigures crop_map(const MapReader& map, const CropRegion& region, MapWriter& output);

}  // namespace fovea
