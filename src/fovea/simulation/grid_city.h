// Straight streets that meet at right angles in square crossings.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fovea/simulation/street_scenery.h"

namespace fovea {

inline constexpr int kArmChunks = 2;  ///< chunks of a street that leads out of the scene

/// A scene of such streets; the subclass lays them out and gives the path. Ids of chunks: pieces of
/// street in the order in which they were added, then the crossings.
class GridCity : public StreetScenery {
 public:
  explicit GridCity(const SimulationOptions& options);

  std::vector<ChunkPlace> chunks_near(const Eigen::Vector2d& place, double radius) const override;
  Chunk chunk(std::uint32_t id) const override;

 protected:
  /// A straight street of some chunks that leads from `from` in direction `quarter` (of a turn,
  /// counter-clockwise from world x).
  void add_street(const Eigen::Vector2d& from, int quarter, int chunks);
  void add_crossing(const Eigen::Vector2d& center) { crossings_.push_back(center); }
  /// Random numbers of the parked cars of a chunk; none: they use those of the chunk.
  virtual std::optional<Random> parked_cars(std::uint32_t id) const;

 private:
  struct StreetPiece {
    StreetAxis axis;
    double begin;
    Eigen::Vector2d center;
  };
  Chunk crossing(const Eigen::Vector2d& center, std::uint32_t first_surface) const;

  Path straight_;
  std::vector<StreetPiece> pieces_;
  std::vector<Eigen::Vector2d> crossings_;
};

}  // namespace fovea
