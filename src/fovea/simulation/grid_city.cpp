#include "fovea/simulation/grid_city.h"

#include <algorithm>

#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/street_builder.h"
#include "fovea/simulation/street_turn.h"

namespace fovea {

using Eigen::Vector2d;
using Eigen::Vector3d;

GridCity::GridCity(const SimulationOptions& options)
    : StreetScenery(options),
      straight_([](double) { return 0.0; }, [](double) { return 0.0; }, -10, 500) {}

std::vector<ChunkPlace> GridCity::chunks_near(const Vector2d& place, double radius) const {
  std::vector<ChunkPlace> chunks;
  std::uint32_t id = 0;
  const auto add_if_near = [&](const Vector2d& center) {
    if ((center - place).norm() < radius) chunks.push_back({id, center});
    ++id;
  };
  for (const StreetPiece& piece : pieces_) add_if_near(piece.center);
  for (const Vector2d& center : crossings_) add_if_near(center);
  return chunks;
}

Chunk GridCity::chunk(std::uint32_t id) const {
  if (id >= pieces_.size())
    return crossing(crossings_.at(id - pieces_.size()), id * kSurfacesPerChunk);
  return street_chunk(pieces_[id].axis, pieces_[id].begin, id, parked_cars(id));
}

void GridCity::add_street(const Vector2d& from, int quarter, int chunks) {
  StreetAxis axis;
  axis.path = &straight_;
  axis.T_world_path.translation() = Vector3d(from.x(), from.y(), 0);
  const int c[] = {1, 0, -1, 0}, s[] = {0, 1, 0, -1};  // exact quarters
  const int q = ((quarter % 4) + 4) % 4;
  axis.T_world_path.linear() << c[q], -s[q], 0, s[q], c[q], 0, 0, 0, 1;
  for (int k = 0; k < chunks; ++k) {
    const double begin = k * kChunkLength;
    pieces_.push_back({axis, begin, axis.place(begin + 0.5 * kChunkLength, 0, 0).head<2>()});
  }
}

std::optional<Random> GridCity::parked_cars(std::uint32_t /*id*/) const { return std::nullopt; }

/// The square of a crossing: asphalt, a raised corner of pavement at each of its corners.
Chunk GridCity::crossing(const Vector2d& center, std::uint32_t first_surface) const {
  Chunk chunk;
  MeshBuilder make;
  make.frame.translation() = Vector3d(center.x(), center.y(), 0);
  make.surface = first_surface;
  chunk.surfaces[first_surface] = "crossing";
  make.material = palette_.asphalt;
  const double j = kJunction + kOverlap, k = style_.kerb, h = kPavement;
  make.quad({-j, -j, 0}, {j, -j, 0}, {j, j, 0}, {-j, j, 0});
  const std::uint32_t pavement = first_surface + 1;
  chunk.surfaces[pavement] = "pavement";
  make.surface = pavement;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      make.material = palette_.pavement;
      const Vector3d low(std::min(x * k, x * j), std::min(y * k, y * j), 0),
          high(std::max(x * k, x * j), std::max(y * k, y * j), h);
      make.box(low, high);
    }
  }
  chunk.mesh_world = make.take();
  return chunk;
}

}  // namespace fovea
