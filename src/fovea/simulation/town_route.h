// The grid of streets of a town, and the route of a drive along them.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "fovea/simulation/simulation_options.h"
#include "fovea/simulation/street_turn.h"

namespace fovea {

/// ConfigError that names the key of scene town.
void check(const TownOptions& town);

/// Middle of crossing x,y of a town in the world (m). Crossing 0,0 is the world's origin.
Eigen::Vector2d town_crossing(const Eigen::Vector2i& crossing);

/// Crossings of a text "x,y x,y ..." that a vehicle can drive through in turn. ConfigError for
/// another form, a crossing outside the grid, a diagonal, a U-turn, the same crossing twice in a
/// row or fewer than two.
/// @param text  empty: counter-clockwise round the block in the middle, or round the two or four
///              that share it
std::vector<Eigen::Vector2i> parse_route(std::string_view text, const TownOptions& town);

/// The path of a route: straight streets and turns at crossings. Way 0 is kCorner before the middle
/// of the first crossing. A closed route continues as laps without end. Straight streets lead to
/// way 0, and on from the last crossing of an open route.
class TownRoute {
 public:
  /// ConfigError as from parse_route().
  explicit TownRoute(const TownOptions& town);

  Eigen::Vector2d start() const { return start_; }  ///< position at way 0 (world, m)
  double heading(double way) const;                 ///< rad, counter-clockwise from world x
  double curvature(double way) const;               ///< 1/m
  bool is_closed() const { return closed_; }
  /// m from way 0 to the middle of the last crossing; of a closed route: of a lap, from that
  /// crossing to itself.
  double length() const;
  double street_before() const { return street_before_; }  ///< m of street that lead to way 0
  double street_after() const { return street_after_; }  ///< m of street beyond an open route's end

 private:
  /// A straight street and the turn (or the way straight across the crossing) at its end.
  struct Leg {
    double straight;  ///< m
    int quarters;     ///< of the turn: 1 to the left, 0 straight across, -1 to the right
    double crossing;  ///< m, of the way through the crossing
    double length() const { return straight + crossing; }
  };
  /// Where a way lies.
  struct Place {
    int quarters;     ///< of all turns before it
    int turn;         ///< quarters of the turn that it is in; 0: it is in none
    double into = 0;  ///< m, of that turn
  };
  Place locate(double way) const;

  double turn_length_ = turn_length();
  Eigen::Vector2d start_;
  bool closed_;
  double street_before_, street_after_;
  int first_quarter_;  ///< direction of the first leg
  std::vector<Leg> legs_;
  double lap_ = 0;  ///< m, of all legs
};

}  // namespace fovea
