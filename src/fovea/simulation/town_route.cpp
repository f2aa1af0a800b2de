#include "fovea/simulation/town_route.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <sstream>
#include <string>

#include "fovea/simulation/grid_city.h"
#include "fovea/simulation/option_checks.h"
#include "fovea/simulation/street_builder.h"
#include "fovea/simulation/town.h"

namespace fovea {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2i;

constexpr std::string_view kRouteKey = "town.route";
constexpr std::string_view kExample = "name crossings as in \"0,0 3,0 3,2\"";

std::string text_of(const Vector2i& crossing) {
  return fmt::format("{},{}", crossing.x(), crossing.y());
}

Vector2i parse_crossing(const std::string& word) {
  std::istringstream stream(word);
  Vector2i crossing;
  char comma = 0, rest = 0;
  if (!(stream >> crossing.x() >> comma >> crossing.y()) || comma != ',' || stream >> rest) {
    reject(fmt::format("'{}' is not a crossing", word), kRouteKey, kExample);
  }
  return crossing;
}

/// Unit step from one crossing towards the other, which lies in the same street.
Vector2i direction(const Vector2i& from, const Vector2i& to) {
  return (to - from).cwiseMax(-1).cwiseMin(1);
}

/// Direction in quarters of a turn, counter-clockwise from x.
int quarter_of(const Vector2i& direction) {
  if (direction.y() == 0) return direction.x() > 0 ? 0 : 2;
  return direction.y() > 0 ? 1 : 3;
}

/// 1 for a turn to the left, -1 to the right, 0 straight ahead.
int turn_between(const Vector2i& before, const Vector2i& after) {
  return before.x() * after.y() - before.y() * after.x();
}

bool is_closed_route(const std::vector<Vector2i>& route) { return route.front() == route.back(); }

void check_leg(const Vector2i& from, const Vector2i& to) {
  if (from == to) {
    reject(fmt::format("the route names crossing {} twice in a row", text_of(to)), kRouteKey,
           "name it once");
  }
  if (from.x() != to.x() && from.y() != to.y()) {
    reject(fmt::format("no street leads from crossing {} to {}", text_of(from), text_of(to)),
           kRouteKey, "change either x or y from crossing to crossing");
  }
}

void check_turn(const Vector2i& before, const Vector2i& at, const Vector2i& after) {
  if (direction(before, at) != -direction(at, after)) return;
  reject(fmt::format("the route makes a U-turn at crossing {}", text_of(at)), kRouteKey,
         "turn left or right, or drive straight on");
}

std::vector<Vector2i> middle_route(const TownOptions& town) {
  const int left = (town.blocks_x - 1) / 2, right = town.blocks_x - left;
  const int low = (town.blocks_y - 1) / 2, high = town.blocks_y - low;
  return {{left, low}, {right, low}, {right, high}, {left, high}, {left, low}};
}

/// m of street from a crossing in a direction until it ends outside the town.
double street_beyond(const Vector2i& crossing, const Vector2i& direction, const TownOptions& town) {
  Vector2i last = crossing;
  if (direction.x() != 0) last.x() = direction.x() > 0 ? town.blocks_x : 0;
  if (direction.y() != 0) last.y() = direction.y() > 0 ? town.blocks_y : 0;
  return (town_crossing(last) - town_crossing(crossing)).norm() + kJunction +
         kArmChunks * kChunkLength;
}

}  // namespace

void check(const TownOptions& town) {
  check_range("town.blocks_x", town.blocks_x, 1, 20);
  check_range("town.blocks_y", town.blocks_y, 1, 20);
  check_range("town.begin", town.begin, 0, 1e5, "m");
  parse_route(town.route, town);
}

Vector2d town_crossing(const Vector2i& crossing) {
  return {crossing.x() * (kBlockChunksX * kChunkLength + 2 * kJunction),
          crossing.y() * (kBlockChunksY * kChunkLength + 2 * kJunction)};
}

std::vector<Vector2i> parse_route(std::string_view text, const TownOptions& town) {
  if (text.empty()) return middle_route(town);
  std::vector<Vector2i> route;
  std::istringstream words{std::string(text)};
  for (std::string word; words >> word;) {
    const Vector2i crossing = parse_crossing(word);
    if (crossing.x() < 0 || crossing.x() > town.blocks_x || crossing.y() < 0 ||
        crossing.y() > town.blocks_y) {
      reject(fmt::format("crossing {} is outside the town", word), kRouteKey,
             fmt::format("give 0,0 to {},{}", town.blocks_x, town.blocks_y));
    }
    route.push_back(crossing);
  }
  if (route.size() < 2) {
    reject("the route has fewer than two crossings", kRouteKey, kExample);
  }
  for (std::size_t k = 1; k < route.size(); ++k) check_leg(route[k - 1], route[k]);
  for (std::size_t k = 2; k < route.size(); ++k) check_turn(route[k - 2], route[k - 1], route[k]);
  if (is_closed_route(route)) check_turn(route[route.size() - 2], route.back(), route[1]);
  return route;
}

TownRoute::TownRoute(const TownOptions& town) {
  const std::vector<Vector2i> route = parse_route(town.route, town);
  closed_ = is_closed_route(route);
  const Vector2i first = direction(route[0], route[1]);
  first_quarter_ = quarter_of(first);
  start_ = town_crossing(route[0]) - kCorner * first.cast<double>();
  street_before_ = street_beyond(route[0], -first, town) - kCorner;
  for (std::size_t k = 1; k < route.size(); ++k) {
    const Vector2i here = direction(route[k - 1], route[k]);
    const double between = (town_crossing(route[k]) - town_crossing(route[k - 1])).norm();
    const bool ends = k + 1 == route.size();
    const Vector2i next = !ends ? direction(route[k], route[k + 1]) : closed_ ? first : here;
    const int quarters = turn_between(here, next);
    legs_.push_back({between - 2 * kCorner, quarters, quarters == 0 ? 2 * kCorner : turn_length_});
    lap_ += legs_.back().length();
    street_after_ = street_beyond(route[k], here, town);
  }
}

double TownRoute::length() const { return closed_ ? lap_ : kCorner + lap_; }

TownRoute::Place TownRoute::locate(double way) const {
  // The first lap begins beyond the first crossing, which the vehicle crosses straight before it.
  double left = way - 2 * kCorner;
  Place place{0, 0};
  if (left < 0) return place;
  if (closed_) {
    const double laps = std::floor(left / lap_);
    left -= laps * lap_;
    for (const Leg& leg : legs_) place.quarters += static_cast<int>(laps) * leg.quarters;
  }
  for (const Leg& leg : legs_) {
    if (left < leg.length()) {
      if (left > leg.straight && leg.quarters != 0) {
        place.turn = leg.quarters;
        place.into = left - leg.straight;
      }
      return place;
    }
    left -= leg.length();
    place.quarters += leg.quarters;
  }
  return place;  // beyond an open route, or by rounding at a lap's end
}

double TownRoute::heading(double way) const {
  const Place place = locate(way);
  const double before = 0.5 * std::numbers::pi * (first_quarter_ + place.quarters);
  return before + place.turn * turn_heading(place.into / turn_length_);
}

double TownRoute::curvature(double way) const {
  const Place place = locate(way);
  return place.turn == 0 ? 0 : place.turn * turn_curvature(place.into, turn_length_);
}

}  // namespace fovea
