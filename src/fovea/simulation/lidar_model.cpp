#include "fovea/simulation/lidar_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "fovea/core/parallel.h"
#include "fovea/core/random.h"
#include "fovea/world/material.h"

namespace fovea {
namespace {

using Eigen::Vector3d;

// Kinds of random numbers.
constexpr std::uint64_t kSweeps = 0x11da5, kFirings = 0xf19e;

struct Return {
  bool valid = false;
  std::array<float, 4> point{};
  TruthPoint truth;
};

/// Chance that a return is lost. A matte surface of a tenth reflectance, met squarely, is seen half
/// the time at `dark_range` (m); glass throws the light elsewhere.
double loss_chance(const Material& material, double facing, double range, double dark_range) {
  if (material.glass) return 0.85;
  const double signal =
      material.reflectance / 0.1 * std::sqrt(facing) * (dark_range * dark_range) / (range * range);
  return 1 / (1 + signal * signal);
}

class Sweep {
 public:
  Sweep(const RayCaster& caster, const VehicleMotion& motion, const RigidMotion& T_vehicle_lidar,
        const LidarOptions& options, int seed, int frame, double stamp)
      : caster_(caster),
        motion_(motion),
        T_vehicle_lidar_(T_vehicle_lidar),
        options_(options),
        sheet_(lidar_data_sheet(options.model)),
        columns_(sweep_columns(options)),
        seed_(Random::of_item(static_cast<std::uint64_t>(seed), kSweeps,
                              static_cast<std::uint64_t>(frame))
                  .next()),
        stamp_(stamp),
        T_stamp_world_((motion.T_world_vehicle(stamp) * T_vehicle_lidar).inverse()) {
    for (const double elevation : ring_elevations(options)) {
      rings_.emplace_back(std::cos(elevation), std::sin(elevation));
    }
  }

  std::size_t columns() const { return static_cast<std::size_t>(columns_); }
  std::size_t rings() const { return rings_.size(); }

  /// All beams of one firing.
  void fire(int column, std::span<Return> returns) const {
    const double turned = kTurn * (column + 0.5) / columns_;
    const double since = -(kTurn * options_.stamp_phase - turned) / kTurn * options_.period;
    const RigidMotion T_world_lidar = motion_.T_world_vehicle(stamp_ + since) * T_vehicle_lidar_;
    const RayCaster::Moment moment = caster_.moment(stamp_ + since, motion_.way(stamp_ + since));
    Random random = Random::of_item(seed_, kFirings, static_cast<std::uint64_t>(column));
    const auto fire_beam = [&](std::size_t ring, const Vector3d& beam) {
      Random own(random.next());  // whatever the other beams draw
      Return& r = returns[ring];
      r = measure(T_world_lidar, beam, moment, own);
      r.truth.time = static_cast<float>(since);
      r.truth.ring = static_cast<std::uint8_t>(ring);
    };
    if (sheet_.rosette) {
      const Eigen::Vector2d angles = rosette_angles(*sheet_.rosette, stamp_ + since);
      return fire_beam(0, direction(angles.x(), std::cos(angles.y()), std::sin(angles.y())));
    }
    const double azimuth = options_.direction == SweepDirection::kClockwise
                               ? options_.start_azimuth - turned
                               : options_.start_azimuth + turned;
    for (std::size_t ring = 0; ring < rings_.size(); ++ring) {
      fire_beam(ring, direction(azimuth, rings_[ring].first, rings_[ring].second));
    }
  }

 private:
  static Vector3d direction(double azimuth, double cos_elevation, double sin_elevation) {
    return {cos_elevation * std::cos(azimuth), cos_elevation * std::sin(azimuth), sin_elevation};
  }

  Return measure(const RigidMotion& T_world_lidar, const Vector3d& beam,
                 const RayCaster::Moment& moment, Random& random) const {
    const Vector3d along = T_world_lidar.linear() * beam;
    const auto hit = caster_.cast(moment, T_world_lidar.translation(), along, options_.min_range,
                                  options_.max_range);
    if (!hit) return {};
    const Material& material = caster_.scenery().palette().materials[hit->material];
    const double facing = std::clamp(-along.dot(hit->normal), 0.01, 1.0);
    const double lost =
        options_.dropouts * loss_chance(material, facing, hit->distance, sheet_.dark_range);
    const double range_error = options_.range_noise * random.normal();
    if (random.uniform() < lost) return {};
    double range = hit->distance + range_error;
    if (options_.range_resolution > 0) {
      range = options_.range_resolution * std::round(range / options_.range_resolution);
    }
    if (range < options_.min_range || range > options_.max_range) return {};
    Return r;
    r.valid = true;
    const Eigen::Vector3f p = (range * beam).cast<float>();
    const double reflected = material.reflectance * (0.35 + 0.65 * facing);
    r.point = {p.x(), p.y(), p.z(), static_cast<float>(std::round(100 * reflected) / 100)};
    r.truth.hit_lidar = (T_stamp_world_ * hit->position).cast<float>();
    r.truth.surface = hit->surface;
    r.truth.moving = hit->moving();
    r.truth.albedo = encode_srgb(albedo(material, hit->texture, kSpot));
    return r;
  }

  static constexpr double kTurn = 2 * std::numbers::pi;
  static constexpr float kSpot = 0.01f;  // m, over which the truth's albedo is averaged

  const RayCaster& caster_;
  const VehicleMotion& motion_;
  RigidMotion T_vehicle_lidar_;
  const LidarOptions& options_;
  const LidarDataSheet& sheet_;
  int columns_;
  std::vector<std::pair<double, double>> rings_;  // cosine and sine of the elevations
  std::uint64_t seed_;
  double stamp_;
  RigidMotion T_stamp_world_;
};

}  // namespace

SimulatedScan simulate_scan(const RayCaster& caster, const VehicleMotion& motion,
                            const RigidMotion& T_vehicle_lidar, const LidarOptions& options,
                            int seed, int frame, double stamp) {
  const Sweep sweep(caster, motion, T_vehicle_lidar, options, seed, frame, stamp);
  const std::size_t columns = sweep.columns(), rings = sweep.rings();
  std::vector<Return> returns(columns * rings);
  parallel_for(columns, 16, [&](std::size_t column) {
    sweep.fire(static_cast<int>(column), std::span(returns).subspan(column * rings, rings));
  });
  SimulatedScan scan;
  for (std::size_t ring = 0; ring < rings; ++ring) {
    for (std::size_t column = 0; column < columns; ++column) {
      const Return& r = returns[column * rings + ring];
      if (!r.valid) continue;
      scan.points.push_back(r.point);
      scan.truth.push_back(r.truth);
    }
  }
  return scan;
}

}  // namespace fovea
