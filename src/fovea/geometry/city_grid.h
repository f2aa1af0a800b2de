// The tiles of a city: cells of a grid on the ground.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "fovea/geometry/geodesy.h"

namespace fovea {

/// Cell (x, y) spans [x, x + 1) * size to the east and [y, y + 1) * size to the north, at any
/// height.
struct CityTile {
  std::int32_t x = 0, y = 0;
  friend auto operator<=>(const CityTile&, const CityTile&) = default;

  /// "X,Y". Empty if the text is something else.
  static std::optional<CityTile> parse(std::string_view text);
  std::string text() const;
};

/// The grid lies in a transverse Mercator projection whose central meridian is that of the origin:
/// there are no zones. Each point is in one cell, also 100 km away, where cells are 0.012 % smaller
/// on the ground than stated.
class CityGrid {
 public:
  /// @param origin  its latitude and longitude are the corner of cell (0, 0)
  /// @param size    of the cells, m
  CityGrid(const GeodeticPoint& origin, double size);

  double size() const { return size_; }
  /// m east and north of the origin, in the projection.
  Eigen::Vector2d projected(const Eigen::Vector3d& p_ecef) const;
  CityTile tile_at(const Eigen::Vector3d& p_ecef) const;
  /// The middle of a cell at the height of the origin.
  GeodeticPoint middle(const CityTile& tile) const;

 private:
  GeodeticPoint origin_;
  double size_;
  double origin_north_ = 0;  // of the origin, m from the equator
};

}  // namespace fovea
