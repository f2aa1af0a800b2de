// Scene town: streets on a grid, through which many drives follow their routes.
#pragma once

#include <memory>

#include "fovea/simulation/scenery.h"
#include "fovea/simulation/simulation_options.h"

namespace fovea {

/// Chunks of a street between two crossings. The houses of neighboring streets have room back to
/// back: they reach 18.7 m from a street's axis, and the axes are 42 m apart or more.
inline constexpr int kBlockChunksX = 2, kBlockChunksY = 1;

/// The town of the options with the path of its drive. ConfigError if an open route is too short
/// for the frames. The streets depend on the seed and the number of blocks alone, and their parked
/// cars on the pass, too.
std::unique_ptr<Scenery> make_town(const SimulationOptions& options);

}  // namespace fovea
