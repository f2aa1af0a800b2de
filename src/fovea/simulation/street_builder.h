// Builds pieces of a street: road, kerbs, pavements, houses, and what stands on them.
#pragma once

#include "fovea/core/random.h"
#include "fovea/simulation/models.h"
#include "fovea/simulation/scenery.h"
#include "fovea/simulation/street_style.h"

namespace fovea {

inline constexpr double kChunkLength = 24;  ///< of a street (m)
/// The ground of a chunk reaches so far into the next (m): no ray slips through the seam, whose two
/// sides are not the same floats.
inline constexpr double kOverlap = 0.001;

/// Builds the piece [begin, begin + kChunkLength) of a street.
/// @param first_surface  id of the piece's first thing; the others follow
Chunk build_street(const StreetAxis& axis, double begin, const StreetStyle& style,
                   const Palette& palette, const ModelSet& models, Random random,
                   std::uint32_t first_surface);

}  // namespace fovea
