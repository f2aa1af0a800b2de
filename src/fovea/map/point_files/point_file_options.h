// What can be asked of PLY and PCD files.
#pragma once

#include "fovea/map/point_files/point_stream.h"

namespace fovea {

struct PointFileOptions {
  PointChoice points = {};
  /// x y z as double: keeps 0.1 mm beyond 1 km from the origin. Coordinates that are not local are
  /// doubles in any case: a float is off by half a metre there.
  bool double_positions = false;
  bool force = false;  ///< replace an existing file

  bool doubles() const { return double_positions || points.crs != Crs::kLocal; }
};

}  // namespace fovea
