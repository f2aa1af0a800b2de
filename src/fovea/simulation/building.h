// Houses: walls with windows set back, doors, shops, balconies, roofs.
#pragma once

#include "fovea/core/random.h"
#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/palette.h"

namespace fovea {

struct BuildingPlan {
  double width = 10, depth = 9;
  int floors = 3;
  bool shop = false;   ///< shop windows and a sign at street level
  bool gable = false;  ///< a tiled roof instead of a flat one
  bool balconies = false;
};

/// Adds a house. Builder's frame: x along the front from 0 to width, y outward (the street), z up;
/// the front stands at y = 0.
void add_building(MeshBuilder& make, const Palette& palette, const BuildingPlan& plan,
                  Random& random);

}  // namespace fovea
