// The surfaces that a tile of a city has so far, for points of further drives.
#pragma once

#include <array>
#include <map>
#include <vector>

#include "fovea/map/tile_points.h"
#include "fovea/rigid_motion.h"

namespace fovea {

/// Keeps positions alone: memory grows with the surfaces, not with the drives that show them.
class KnownSurfaces {
 public:
  /// @param spacing  of the maps' points, m
  explicit KnownSurfaces(double spacing) : spacing_(float(spacing)) {}

  /// Which points show a surface of an earlier drive.
  std::vector<bool> find(const TilePoints& points, const RigidMotion& T_cell_submap) const;
  /// Adds points of the present drive.
  void add(const TilePoints& points, const RigidMotion& T_cell_submap);
  /// What was added is known from now on.
  void end_drive();

 private:
  /// Points in a cube.
  struct Block {
    std::vector<Eigen::Vector3f> position_cell;
    std::vector<bool> has_color;
  };
  using Blocks = std::map<std::array<int, 3>, Block>;

  /// The known points in a box.
  Block within(const Eigen::Array3f& low, const Eigen::Array3f& high) const;

  float spacing_;
  Blocks known_, added_;
};

}  // namespace fovea
