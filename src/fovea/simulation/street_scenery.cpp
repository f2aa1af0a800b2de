// The scenes: a street without end, and a block with streets round it.
#include "fovea/simulation/street_scenery.h"

#include <cmath>
#include <numbers>

#include "fovea/simulation/grid_city.h"
#include "fovea/simulation/scenery.h"
#include "fovea/simulation/street_builder.h"
#include "fovea/simulation/street_turn.h"
#include "fovea/simulation/town.h"
#include "fovea/simulation/traffic.h"
#include "fovea/simulation/vehicle_motion.h"

namespace fovea {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kBehind = 170, kAhead = 300;  // m of street beyond what is driven
constexpr double kLane = -1.75;                // right-hand traffic

/// Random numbers of one chunk.
Random chunk_random(int seed, std::uint32_t id) {
  Random mix(static_cast<std::uint64_t>(seed) * 0x9e3779b97f4a7c15ull + id);
  return Random(mix.next());
}

/// Heading of an endless street: two slow bends and a constant curvature.
struct Bends {
  double amplitude, curvature, phase_1, phase_2;
  static constexpr double kLong = 2 * std::numbers::pi / 310, kShort = 2 * std::numbers::pi / 170;

  double heading(double s) const {
    return curvature * s + amplitude * (0.6 * (std::sin(kLong * s + phase_1) - std::sin(phase_1)) +
                                        0.4 * (std::sin(kShort * s + phase_2) - std::sin(phase_2)));
  }
  double slope(double s) const {
    return curvature + amplitude * (0.6 * kLong * std::cos(kLong * s + phase_1) +
                                    0.4 * kShort * std::cos(kShort * s + phase_2));
  }
};

class EndlessStreet : public StreetScenery {
 public:
  explicit EndlessStreet(const SimulationOptions& options) : StreetScenery(options) {
    Random random(static_cast<std::uint64_t>(options.seed) + 5);
    const Bends bends{options.bends, options.curvature, random.uniform(0, 6), random.uniform(0, 6)};
    path_ = std::make_unique<Path>([bends](double s) { return bends.heading(s); },
                                   [bends](double s) { return bends.slope(s); }, -kBehind,
                                   driven_way(options) + kAhead);
    axis_.path = path_.get();
    first_ = static_cast<int>(std::ceil(path_->begin() / kChunkLength));
    last_ = static_cast<int>(std::floor(path_->end() / kChunkLength)) - 1;
    if (options.scene == Scene::kTraffic) {
      traffic_ = Traffic(set_, palette_, options.vehicle, options.pass_seed());
    }
  }

  std::vector<ChunkPlace> chunks_near(const Vector2d& place, double radius) const override {
    std::vector<ChunkPlace> chunks;
    for (int k = first_; k <= last_; ++k) {
      const Vector2d center = path_->at((k + 0.5) * kChunkLength).position;
      if ((center - place).norm() < radius) chunks.push_back({id_of(k), center});
    }
    return chunks;
  }
  Chunk chunk(std::uint32_t id) const override {
    Chunk chunk = street_chunk(axis_, (static_cast<int>(id) - kZero) * kChunkLength, id);
    if (options_.scene == Scene::kPlaza && id % 3 == 0) add_fountain(chunk, id);
    return chunk;
  }
  std::vector<Placement> movers(double time, double way) const override {
    return traffic_.at(*path_, time, way);
  }

 private:
  static constexpr int kZero = 1 << 15;  // id of the chunk that begins at s = 0
  static std::uint32_t id_of(int k) { return static_cast<std::uint32_t>(k + kZero); }

  void add_fountain(Chunk& chunk, std::uint32_t id) const {
    const std::uint32_t surface = (id + 1) * kSurfacesPerChunk - 1;
    const double s = (static_cast<int>(id) - kZero + 0.5) * kChunkLength;
    const Placement fountain{set_.fountain, axis_.frame(s, 12, 0), Palette::kPaint, surface};
    chunk.mesh_world.append(placed_mesh(models_[set_.fountain], fountain),
                            Eigen::Affine3d::Identity());
    chunk.surfaces[surface] = "fountain";
  }

  StreetAxis axis_;
  Traffic traffic_;
  int first_ = 0, last_ = 0;
};

// ---- round a block

constexpr int kSides[2] = {2, 1};  // chunks of the block's long and short streets

/// Heading along the way round the block, from the begin of the first straight.
struct Loop {
  double turn = turn_length();
  double straight[2];

  Loop() {
    for (int k = 0; k < 2; ++k) {
      straight[k] = kSides[k] * kChunkLength + 2 * kJunction - 2 * kCorner;
    }
  }
  double lap() const { return 2 * (straight[0] + straight[1]) + 4 * turn; }

  /// Which side s lies on, and how far into its turn (negative: still straight).
  std::pair<int, double> locate(double s) const {
    double left = s - lap() * std::floor(s / lap());
    for (int side = 0;; side = (side + 1) % 4) {
      const double length = straight[side % 2] + turn;
      if (left < length) return {side, left - straight[side % 2]};
      left -= length;
    }
  }
  double heading(double s) const {
    const auto [side, into] = locate(s);
    const double whole = 2 * std::numbers::pi * std::floor(s / lap());
    return whole + 0.5 * std::numbers::pi * side + (into > 0 ? turn_heading(into / turn) : 0.0);
  }
  double curvature(double s) const {
    const double into = locate(s).second;
    if (into <= 0) return 0;
    return turn_curvature(into, turn);
  }
};

class Block : public GridCity {
 public:
  explicit Block(const SimulationOptions& options) : GridCity(options) {
    const Loop loop;
    path_ = std::make_unique<Path>([loop](double s) { return loop.heading(s); },
                                   [loop](double s) { return loop.curvature(s); }, -20,
                                   driven_way(options) + 20);
    lay_out();
  }

 private:
  void lay_out() {
    const double length[2] = {kSides[0] * kChunkLength + 2 * kJunction,
                              kSides[1] * kChunkLength + 2 * kJunction};
    // The drive begins where the first street's straight does, kCorner beyond the last corner.
    Vector2d corner(-kCorner, 0);
    for (int side = 0; side < 4; ++side) {
      const Vector2d directions[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
      const Vector2d& ahead = directions[side];
      add_crossing(corner);
      add_street(corner + kJunction * ahead, side, kSides[side % 2]);
      // The two streets that lead away from the block at this corner.
      add_street(corner - kJunction * ahead, side + 2, kArmChunks);
      const Vector2d& before = directions[(side + 3) % 4];
      add_street(corner + kJunction * before, side + 3, kArmChunks);
      corner += length[side % 2] * ahead;
    }
  }
};

}  // namespace

StreetScenery::StreetScenery(const SimulationOptions& options)
    : options_(options), style_(style_of(options.scene)) {
  palette_ = make_palette();
  set_ = make_models(palette_);
  models_ = set_.models;
}

double StreetScenery::lane_offset() const { return kLane; }

std::vector<Placement> StreetScenery::movers(double /*time*/, double /*way*/) const { return {}; }

Chunk StreetScenery::street_chunk(const StreetAxis& axis, double begin, std::uint32_t id,
                                  std::optional<Random> parked_cars) const {
  return build_street(axis, begin, style_, palette_, set_, chunk_random(options_.seed, id),
                      id * kSurfacesPerChunk, parked_cars);
}

double driven_way(const SimulationOptions& options) {
  return longest_way(options.vehicle, options.lidar.period * (options.frames + 1));
}

std::unique_ptr<Scenery> make_scenery(const SimulationOptions& options) {
  if (options.scene == Scene::kCrossing) return std::make_unique<Block>(options);
  if (options.scene == Scene::kTown) return make_town(options);
  return std::make_unique<EndlessStreet>(options);
}

}  // namespace fovea
