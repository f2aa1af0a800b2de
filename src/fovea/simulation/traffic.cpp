#include "fovea/simulation/traffic.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fovea/core/random.h"
#include "fovea/simulation/vehicle_motion.h"

namespace fovea {

using Eigen::Vector3d;

namespace {

/// Who crosses the street begins and is done when the vehicle is so far away (m).
constexpr double kCrossesFrom = 80, kCrossesTo = 8;

/// Share of the room in turns that a mover needs at a place of this curvature (1/m).
double turn_share(double curvature) {
  constexpr double kTight = 0.04;
  return std::min(1.0, std::abs(curvature) / kTight);
}

/// How much farther than at its mean speed the vehicle can get (m).
double lead(const VehicleOptions& vehicle) {
  constexpr double kLong = 1000;  // s
  return longest_way(vehicle, kLong) - vehicle.speed * kLong;
}

}  // namespace

Traffic::Traffic(const ModelSet& models, const Palette& palette, const VehicleOptions& vehicle,
                 int seed, double room_in_turns) {
  Random random(static_cast<std::uint64_t>(seed) * 7919 + 3);
  const auto pick = [&](const auto& choices) { return choices[random.below(choices.size())]; };
  // A car ahead, at the vehicle's own mean speed; cars that come the other way.
  movers_.push_back(
      {pick(models.cars), pick(palette.car_paints), 9.5 + lead(vehicle), vehicle.speed, -1.75});
  for (int k = 0; k < 7; ++k) {
    movers_.push_back({pick(models.cars), pick(palette.car_paints), 26.0 * k + random.uniform(0, 9),
                       -9.5, 1.75, 182});
  }
  for (int k = 0; k < 3; ++k) {
    movers_.push_back({pick(models.cyclists), pick(palette.clothes),
                       21.0 + 70 * k + random.uniform(0, 30), random.uniform(4.2, 5.2), -3.32, 210,
                       0, room_in_turns});
  }
  for (int k = 0; k < 24; ++k) {
    const bool left = random.uniform() < 0.5;
    const double speed = random.uniform(1.0, 1.6);
    const double pace = random.uniform() < 0.5 ? speed : -speed;
    const double lane = random.uniform(6.6, 8.0);
    movers_.push_back({models.pedestrians.back(), pick(palette.clothes),
                       9.0 * k + random.uniform(0, 9), pace, left ? lane : -lane, 216});
  }
  for (int k = 0; k < 2; ++k) {  // people who cross the street
    movers_.push_back({models.pedestrians.back(), pick(palette.clothes),
                       31.0 + 77 * k + random.uniform(-8, 8), 0, 0, 154, k == 0 ? 7.2 : -7.2});
  }
}

void Traffic::add_one(const Path& path, const Mover& mover, std::uint32_t number, double time,
                      double way, std::vector<Placement>& movers) const {
  double s = mover.begin + mover.speed * time;
  if (mover.spacing > 0) s += mover.spacing * std::round((way - s) / mover.spacing);
  if (std::abs(s - way) > kReach || s < path.begin() + 5 || s > path.end() - 5) return;
  const double crossed =
      std::clamp((kCrossesFrom - (s - way)) / (kCrossesFrom - kCrossesTo), 0.0, 1.0);
  const Path::Point point = path.at(s);
  const double d = mover.side + mover.across * (1 - 2 * crossed) -
                   mover.room_in_turns * turn_share(point.curvature);
  double heading = point.heading;
  if (mover.speed < 0) heading += std::numbers::pi;
  if (mover.across != 0) heading -= std::copysign(0.5 * std::numbers::pi, mover.across);
  Placement placement;
  placement.model = mover.model;
  placement.paint = mover.paint;
  placement.surface = Scenery::kMoving | number;
  const Eigen::Vector2d p = path.offset(s, d);
  const double ground = std::abs(d) > 5.7 ? 0.12 : 0.0;  // the pavement's height
  placement.T_world_model.translation() = Vector3d(p.x(), p.y(), ground);
  placement.T_world_model.linear() = Eigen::AngleAxisd(heading, Vector3d::UnitZ()).matrix();
  movers.push_back(placement);
}

std::vector<Placement> Traffic::at(const Path& path, double time, double way) const {
  std::vector<Placement> movers;
  for (std::size_t k = 0; k < movers_.size(); ++k) {
    add_one(path, movers_[k], static_cast<std::uint32_t>(k), time, way, movers);
  }
  return movers;
}

}  // namespace fovea
