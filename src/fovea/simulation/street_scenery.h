// What the scenes that consist of streets share.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fovea/core/random.h"
#include "fovea/simulation/models.h"
#include "fovea/simulation/scenery.h"
#include "fovea/simulation/street_style.h"

namespace fovea {

inline constexpr std::uint32_t kSurfacesPerChunk = 4096;

/// Palette, models and style of a scene, and its pieces of street. Nothing moves.
class StreetScenery : public Scenery {
 public:
  explicit StreetScenery(const SimulationOptions& options);

  double lane_offset() const override;
  std::vector<Placement> movers(double time, double way) const override;

 protected:
  /// The piece of a street that begins at `begin` (m). It depends on the seed and its id alone, and
  /// its cars on `parked_cars` where they have their own random numbers.
  Chunk street_chunk(const StreetAxis& axis, double begin, std::uint32_t id,
                     std::optional<Random> parked_cars = {}) const;

  SimulationOptions options_;
  StreetStyle style_;
  ModelSet set_;
};

/// The way that a path must reach beyond s = 0 for the frames of a drive (m).
double driven_way(const SimulationOptions& options);

}  // namespace fovea
