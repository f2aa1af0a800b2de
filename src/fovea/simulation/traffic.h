// Cars, cyclists and pedestrians that move: where each is at any time.
#pragma once

#include <vector>

#include "fovea/simulation/models.h"
#include "fovea/simulation/simulation_options.h"

namespace fovea {

/// Without arguments: nothing moves. Nothing runs into the vehicle, which keeps to its lane.
class Traffic {
 public:
  Traffic() = default;
  /// @param room_in_turns  m by which cyclists keep further to the right in a tight turn, where the
  ///                       corners of the vehicle that overtakes them swing out
  Traffic(const ModelSet& models, const Palette& palette, const VehicleOptions& vehicle, int seed,
          double room_in_turns = 0);

  /// Everything that moves within kReach of the vehicle, along the path.
  std::vector<Placement> at(const Path& path, double time, double way) const;

  static constexpr double kReach = 140;  // m

 private:
  struct Mover {
    std::uint32_t model = 0;
    std::uint16_t paint = 0;
    double begin = 0;          ///< way at time 0 (m)
    double speed = 0;          ///< m/s along the path, negative against it
    double side = 0;           ///< m to the left of the path
    double spacing = 0;        ///< m after which the mover repeats: traffic without end
    double across = 0;         ///< m to the left whence it crosses the street as the vehicle comes
    double room_in_turns = 0;  ///< m that it moves to the right in a tight turn
  };
  void add_one(const Path& path, const Mover& mover, std::uint32_t number, double time, double way,
               std::vector<Placement>& movers) const;

  std::vector<Mover> movers_;
};

}  // namespace fovea
