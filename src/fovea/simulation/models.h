// Models of things that stand about a city.
#pragma once

#include <vector>

#include "fovea/simulation/scenery.h"

namespace fovea {

/// Places of kinds of models in a list, each a few of a kind.
struct ModelSet {
  std::vector<Model> models;
  std::vector<std::uint32_t> cars, trees, bushes, pedestrians, cyclists;
  std::uint32_t lamp = 0, bin = 0, bollard = 0, bench = 0, hydrant = 0, table = 0, planter = 0;
  std::vector<std::uint32_t> signs;
  std::uint32_t fence = 0;  ///< 2 m of railing along x, thin bars
  std::uint32_t fountain = 0;
};

ModelSet make_models(const Palette& palette);

Model make_car(const Palette& palette, int body,
               int plate);  ///< body 0: saloon, 1: hatchback, 2: van
Model make_tree(const Palette& palette, int variant);
Model make_bush(const Palette& palette, int variant);
Model make_pedestrian(const Palette& palette, int variant);
Model make_cyclist(const Palette& palette, int variant);

}  // namespace fovea
