// Builds pieces of a street: road, kerbs, pavements, houses, and what stands on them.
#pragma once

#include <optional>

#include "fovea/core/random.h"
#include "fovea/simulation/models.h"
#include "fovea/simulation/scenery.h"
#include "fovea/simulation/street_style.h"

namespace fovea {

inline constexpr double kChunkLength = 24;  ///< of a street (m)
inline constexpr double kPavement = 0.12;   ///< height above the road (m)
/// The ground of a chunk reaches so far into the next (m): no ray slips through the seam, whose two
/// sides are not the same floats.
inline constexpr double kOverlap = 0.001;

/// Builds the piece [begin, begin + kChunkLength) of a street.
/// @param first_surface  id of the piece's first thing; the others follow
/// @param parked_cars    random numbers of the parked cars alone: the cars can then differ while
///                       everything else in the piece stays the same, surface ids included; without
///                       them the cars use `random`
Chunk build_street(const StreetAxis& axis, double begin, const StreetStyle& style,
                   const Palette& palette, const ModelSet& models, Random random,
                   std::uint32_t first_surface, std::optional<Random> parked_cars = {});

}  // namespace fovea
