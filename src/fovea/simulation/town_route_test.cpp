#include "fovea/simulation/town_route.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fovea/errors.h"

namespace fovea::town_route_test {

using Eigen::Vector2d;
using Eigen::Vector2i;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TownOptions town_with(const std::string& route, int blocks_x = 4, int blocks_y = 4) {
  TownOptions town;
  town.blocks_x = blocks_x;
  town.blocks_y = blocks_y;
  town.route = route;
  return town;
}

std::string route_error(const std::string& route) {
  try {
    check(town_with(route));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no ConfigError";
}

TEST(TownRoute, ReadsCrossings) {
  EXPECT_THAT(parse_route(" 0,0 3,0\n3,2", town_with("")),
              ElementsAre(Vector2i(0, 0), Vector2i(3, 0), Vector2i(3, 2)));
}

TEST(TownRoute, GoesRoundTheMiddleByDefault) {
  EXPECT_THAT(
      parse_route("", town_with("", 4, 1)),
      ElementsAre(Vector2i(1, 0), Vector2i(3, 0), Vector2i(3, 1), Vector2i(1, 1), Vector2i(1, 0)));
  EXPECT_THAT(
      parse_route("", town_with("", 5, 2)),
      ElementsAre(Vector2i(2, 0), Vector2i(3, 0), Vector2i(3, 2), Vector2i(2, 2), Vector2i(2, 0)));
}

TEST(TownRoute, RejectsWhatNoVehicleDrives) {
  EXPECT_EQ(route_error("0,0 3,0 3,2 0,2 0,0"), "no ConfigError");
  EXPECT_THAT(route_error("0,0 5,0"), AllOf(HasSubstr("5,0"), HasSubstr("outside"),
                                            HasSubstr("town.route"), HasSubstr("4,4")));
  EXPECT_THAT(route_error("0,-1 0,2"), HasSubstr("outside"));
  EXPECT_THAT(route_error("0,0 1,1"), AllOf(HasSubstr("0,0 to 1,1"), HasSubstr("either x or y")));
  EXPECT_THAT(route_error("0,0 2,0 1,0"), AllOf(HasSubstr("U-turn"), HasSubstr("2,0")));
  EXPECT_THAT(route_error("1,0 2,0 2,1 0,1 0,0 2,0 1,0"), HasSubstr("U-turn"));
  // At the joint of the laps.
  EXPECT_THAT(route_error("0,0 2,0 2,1 1,1 1,0 0,0"), AllOf(HasSubstr("U-turn"), HasSubstr("0,0")));
  EXPECT_THAT(route_error("0,0"), HasSubstr("fewer than two"));
  EXPECT_THAT(route_error("  "), HasSubstr("fewer than two"));
  EXPECT_THAT(route_error("0,0 2,0 2,0"), AllOf(HasSubstr("twice"), HasSubstr("2,0")));
  for (const std::string word : {"2", "2,", "a,b", "2;0", "2,0,1", "2.5,0"}) {
    EXPECT_THAT(route_error("0,0 " + word),
                AllOf(HasSubstr("'" + word + "'"), HasSubstr("town.route"), HasSubstr("3,2")));
  }
}

TEST(TownRoute, RejectsOtherKeysByTheirNames) {
  const auto rejects = [](auto&& change, const char* key) {
    TownOptions town;
    change(town);
    try {
      check(town);
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.where(), key);
      return;
    }
    ADD_FAILURE() << key;
  };
  rejects([](TownOptions& town) { town.blocks_x = 21; }, "town.blocks_x");
  rejects([](TownOptions& town) { town.blocks_y = 0; }, "town.blocks_y");
  rejects([](TownOptions& town) { town.begin = -1; }, "town.begin");
  rejects([](TownOptions& town) { town.begin = NAN; }, "town.begin");
}

/// Heading, its derivative and position agree, without jumps.
void expect_smooth(const TownRoute& route, double end) {
  constexpr double kStep = 0.01;
  const double fastest = std::numbers::pi / turn_length() + 1e-9;  // 1/m, in the middle of a turn
  for (double way = -20; way < end; way += kStep) {
    const double change = route.heading(way + kStep) - route.heading(way);
    ASSERT_LE(std::abs(change), kStep * fastest) << way;
    const double mean = 0.5 * (route.curvature(way) + route.curvature(way + kStep));
    ASSERT_NEAR(change / kStep, mean, 2e-4) << way;
  }
}

Path path_of(const TownRoute& route, double end) {
  return Path([&](double s) { return route.heading(s); },
              [&](double s) { return route.curvature(s); }, -20, end, route.start());
}

TEST(TownRoute, TurnsLeftAndRightAndEndsAtItsLastCrossing) {
  const TownRoute route(town_with("1,0 2,0 2,1 4,1 4,0 3,0"));
  EXPECT_FALSE(route.is_closed());
  expect_smooth(route, route.length() + 20);
  const Path path = path_of(route, route.length() + 20);
  EXPECT_LT((path.at(kCorner).position - town_crossing({1, 0})).norm(), 1e-9);
  EXPECT_LT((path.at(route.length()).position - town_crossing({3, 0})).norm(), 1e-6);
  // Left, right, right and right.
  EXPECT_NEAR(route.heading(route.length()), -std::numbers::pi, 1e-12);
  EXPECT_NEAR(route.heading(-20), 0, 1e-12);
}

TEST(TownRoute, StreetsLeadToItAndOnFromIt) {
  const TownRoute route(town_with("3,1 1,1 1,3"));
  constexpr double kArm = 57;  // m, from the middle of the outermost crossing
  EXPECT_NEAR(route.street_before(),
              (town_crossing({4, 1}) - town_crossing({3, 1})).x() + kArm - kCorner, 1e-9);
  EXPECT_NEAR(route.street_after(), (town_crossing({1, 4}) - town_crossing({1, 3})).y() + kArm,
              1e-9);
}

TEST(TownRoute, AClosedRouteContinuesInLaps) {
  const struct {
    const char* crossings;
    double turned;  // quarters, of a lap
  } kRoutes[] = {{"0,0 3,0 3,2 0,2 0,0", 4},
                 {"0,0 0,2 3,2 3,0 0,0", -4},
                 {"1,0 3,0 3,2 0,2 0,0 1,0", 4},           // joint on a straight street
                 {"2,1 2,2 1,2 1,1 3,1 3,0 2,0 2,1", 0}};  // an eight
  for (const auto& [crossings, turned] : kRoutes) {
    SCOPED_TRACE(crossings);
    const TownRoute route(town_with(crossings));
    EXPECT_TRUE(route.is_closed());
    const double lap = route.length();
    expect_smooth(route, 2.5 * lap);
    const Path path = path_of(route, 3 * lap);
    for (double way = 2 * kCorner; way < lap; way += 3.1) {
      ASSERT_LT((path.at(way + 2 * lap).position - path.at(way).position).norm(), 1e-6) << way;
      ASSERT_NEAR(route.heading(way + lap) - route.heading(way), turned * std::numbers::pi / 2,
                  1e-9);
    }
  }
}

}  // namespace fovea::town_route_test
