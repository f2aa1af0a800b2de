// The scenes: a street without end, and a block with streets round it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/scenery.h"
#include "fovea/simulation/street_builder.h"
#include "fovea/simulation/traffic.h"
#include "fovea/simulation/vehicle_motion.h"

namespace fovea {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kBehind = 170, kAhead = 300;  // m of street beyond what is driven
constexpr double kLane = -1.75;                // right-hand traffic
constexpr std::uint32_t kSurfacesPerChunk = 4096;

/// Random numbers of one chunk.
Random chunk_random(int seed, std::uint32_t id) {
  Random mix(static_cast<std::uint64_t>(seed) * 0x9e3779b97f4a7c15ull + id);
  return Random(mix.next());
}

class City : public Scenery {
 public:
  explicit City(const SimulationOptions& options)
      : options_(options), style_(style_of(options.scene)) {
    palette_ = make_palette();
    set_ = make_models(palette_);
    models_ = set_.models;
  }
  double lane_offset() const override { return kLane; }
  std::vector<Placement> movers(double /*time*/, double /*way*/) const override { return {}; }

 protected:
  Chunk street_chunk(const StreetAxis& axis, double begin, std::uint32_t id) const {
    return build_street(axis, begin, style_, palette_, set_, chunk_random(options_.seed, id),
                        id * kSurfacesPerChunk);
  }

  SimulationOptions options_;
  StreetStyle style_;
  ModelSet set_;
};

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

double driven_way(const SimulationOptions& options) {
  return longest_way(options.vehicle, options.lidar.period * (options.frames + 1));
}

class EndlessStreet : public City {
 public:
  explicit EndlessStreet(const SimulationOptions& options) : City(options) {
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

constexpr double kJunction = 9;    // half the side of a crossing's square
constexpr double kCorner = 11.5;   // m before the crossing's middle at which a turn begins
constexpr int kSides[2] = {2, 1};  // chunks of the block's long and short streets
constexpr int kArm = 2;            // chunks of every street that leads away

/// Heading along one turn to the left: its curvature is a raised cosine.
double turn_heading(double u) {
  return 0.5 * std::numbers::pi * (u - std::sin(2 * std::numbers::pi * u) / (2 * std::numbers::pi));
}

/// Length of a turn whose begin lies kCorner before the corner.
double turn_length() {
  double mean = 0;  // of the cosine of the heading: the share of a turn's length that leads ahead
  constexpr int kSteps = 20000;
  for (int k = 0; k < kSteps; ++k) mean += std::cos(turn_heading((k + 0.5) / kSteps)) / kSteps;
  return kCorner / mean;
}

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
    return 0.5 * std::numbers::pi / turn * (1 - std::cos(2 * std::numbers::pi * into / turn));
  }
};

class Block : public City {
 public:
  explicit Block(const SimulationOptions& options)
      : City(options), straight_([](double) { return 0.0; }, [](double) { return 0.0; }, -10, 500) {
    const Loop loop;
    path_ = std::make_unique<Path>([loop](double s) { return loop.heading(s); },
                                   [loop](double s) { return loop.curvature(s); }, -20,
                                   driven_way(options) + 20);
    lay_out();
  }

  std::vector<ChunkPlace> chunks_near(const Vector2d& place, double radius) const override {
    std::vector<ChunkPlace> chunks;
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      const Vector3d center = pieces_[k].axis.place(pieces_[k].begin + 0.5 * kChunkLength, 0, 0);
      if ((center.head<2>() - place).norm() < radius) {
        chunks.push_back({static_cast<std::uint32_t>(k), center.head<2>()});
      }
    }
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      if ((corners_[k] - place).norm() < radius) {
        chunks.push_back({static_cast<std::uint32_t>(pieces_.size() + k), corners_[k]});
      }
    }
    return chunks;
  }
  Chunk chunk(std::uint32_t id) const override {
    if (id < pieces_.size()) return street_chunk(pieces_[id].axis, pieces_[id].begin, id);
    return crossing(corners_.at(id - pieces_.size()), id * kSurfacesPerChunk);
  }

 private:
  struct Piece {
    StreetAxis axis;
    double begin;
  };

  /// A straight street of some chunks that leads from `from` in direction `quarter` (of a turn).
  void add_street(const Vector2d& from, int quarter, int chunks) {
    StreetAxis axis;
    axis.path = &straight_;
    axis.T_world_path.translation() = Vector3d(from.x(), from.y(), 0);
    const int c[] = {1, 0, -1, 0}, s[] = {0, 1, 0, -1};  // exact quarters
    const int q = ((quarter % 4) + 4) % 4;
    axis.T_world_path.linear() << c[q], -s[q], 0, s[q], c[q], 0, 0, 0, 1;
    for (int k = 0; k < chunks; ++k) pieces_.push_back({axis, k * kChunkLength});
  }

  void lay_out() {
    const double length[2] = {kSides[0] * kChunkLength + 2 * kJunction,
                              kSides[1] * kChunkLength + 2 * kJunction};
    // The drive begins where the first street's straight does, kCorner beyond the last corner.
    Vector2d corner(-kCorner, 0);
    for (int side = 0; side < 4; ++side) {
      const Vector2d directions[] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
      const Vector2d& ahead = directions[side];
      corners_.push_back(corner);
      add_street(corner + kJunction * ahead, side, kSides[side % 2]);
      // The two streets that lead away from the block at this corner.
      add_street(corner - kJunction * ahead, side + 2, kArm);
      const Vector2d& before = directions[(side + 3) % 4];
      add_street(corner + kJunction * before, side + 3, kArm);
      corner += length[side % 2] * ahead;
    }
  }

  /// The square of a crossing: asphalt, a raised corner of pavement at each of its corners.
  Chunk crossing(const Vector2d& center, std::uint32_t first_surface) const {
    Chunk chunk;
    MeshBuilder make;
    make.frame.translation() = Vector3d(center.x(), center.y(), 0);
    make.surface = first_surface;
    chunk.surfaces[first_surface] = "crossing";
    make.material = palette_.asphalt;
    const double j = kJunction + kOverlap, k = style_.kerb, h = 0.12;
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

  Path straight_;
  std::vector<Piece> pieces_;
  std::vector<Vector2d> corners_;
};

}  // namespace

std::unique_ptr<Scenery> make_scenery(const SimulationOptions& options) {
  if (options.scene == Scene::kCrossing) return std::make_unique<Block>(options);
  return std::make_unique<EndlessStreet>(options);
}

}  // namespace fovea
