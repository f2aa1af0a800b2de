#include "fovea/simulation/town.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fovea/errors.h"
#include "fovea/simulation/grid_city.h"
#include "fovea/simulation/street_builder.h"
#include "fovea/simulation/street_turn.h"
#include "fovea/simulation/town_route.h"
#include "fovea/simulation/traffic.h"

namespace fovea {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A route that returns to a crossing has a loop of 203 m or more. The traffic reaches less far
// along the route, so that no mover of another passage meets the vehicle at the crossing.
constexpr double kBeyond = Traffic::kReach + 10;  // m of path behind and ahead of what is driven

constexpr double kRoomInTurns = 0.4;  // m that cyclists keep to the right of their lane

/// The part of a route that the drive and its traffic need. s = 0 is where the drive begins.
std::unique_ptr<Path> path_of(const SimulationOptions& options) {
  const TownRoute route(options.town);
  const double begin = options.town.begin, driven = driven_way(options);
  const double before = std::min(begin + route.street_before(), kBeyond);
  double after = driven + kBeyond;
  if (!route.is_closed()) {
    const double left = route.length() - begin;
    if (left < driven) {
      throw ConfigError(fmt::format("{} frames need {:.0f} m of route, and {:.0f} m are left from "
                                    "the begin of the drive",
                                    options.frames, driven, std::max(0.0, left)),
                        "town.route", "give a longer or closed route, or fewer frames");
    }
    after = std::min(after, left + route.street_after());
  }
  const auto path_from = [&](double way, double first, double last, const Vector2d& start) {
    return std::make_unique<Path>([route, way](double s) { return route.heading(way + s); },
                                  [route, way](double s) { return route.curvature(way + s); },
                                  first, last, start);
  };
  const auto to_begin = path_from(0, 0, begin + 1, route.start());
  return path_from(begin, -before, after, to_begin->at(begin).position);
}

class Town : public GridCity {
 public:
  explicit Town(const SimulationOptions& options) : GridCity(options) {
    lay_out();
    path_ = path_of(options);
    if (options.town.traffic) {
      traffic_ = Traffic(set_, palette_, options.vehicle, options.pass_seed(), kRoomInTurns);
    }
  }

  std::optional<Vector3d> local_origin() const override { return Vector3d::Zero(); }

  std::vector<Placement> movers(double time, double way) const override {
    std::vector<Placement> movers = traffic_.at(*path_, time, way);
    // Traffic derives the ground from the distance to the path, which is wrong at a crossing.
    for (Placement& mover : movers) {
      Eigen::Ref<Vector3d> place = mover.T_world_model.matrix().block<3, 1>(0, 3);
      place.z() = is_road(place.head<2>()) ? 0 : kPavement;
    }
    return movers;
  }

 private:
  void lay_out() {
    const TownOptions& town = options_.town;
    for (int y = 0; y <= town.blocks_y; ++y) {
      for (int x = 0; x <= town.blocks_x; ++x) {
        const Vector2d center = town_crossing({x, y});
        add_crossing(center);
        const auto add = [&](int quarter, const Vector2d& ahead, int chunks) {
          add_street(center + kJunction * ahead, quarter, chunks);
        };
        add(0, {1, 0}, x < town.blocks_x ? kBlockChunksX : kArmChunks);
        add(1, {0, 1}, y < town.blocks_y ? kBlockChunksY : kArmChunks);
        if (x == 0) add(2, {-1, 0}, kArmChunks);
        if (y == 0) add(3, {0, -1}, kArmChunks);
      }
    }
  }

  /// Whether a place lies between the kerbs of a street.
  bool is_road(const Vector2d& place) const {
    const Vector2d spacing = town_crossing({1, 1});
    const auto aside = [&](int axis, int blocks) {
      const double line = std::clamp(std::round(place[axis] / spacing[axis]), 0.0, double(blocks));
      return std::abs(place[axis] - line * spacing[axis]);
    };
    return std::min(aside(0, options_.town.blocks_x), aside(1, options_.town.blocks_y)) <
           style_.kerb;
  }

  std::optional<Random> parked_cars(std::uint32_t id) const override {
    constexpr std::uint64_t kKind = 0x7061726b6564;
    Random day = Random::of_item(static_cast<std::uint64_t>(options_.seed), kKind,
                                 static_cast<std::uint64_t>(options_.pass));
    return Random::of_item(day.next(), kKind, id);
  }

  Traffic traffic_;
};

}  // namespace

std::unique_ptr<Scenery> make_town(const SimulationOptions& options) {
  return std::make_unique<Town>(options);
}

}  // namespace fovea
