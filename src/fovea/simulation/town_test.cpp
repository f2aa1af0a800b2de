#include "fovea/simulation/town.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "fovea/errors.h"
#include "fovea/simulation/ray_caster.h"
#include "fovea/simulation/street_scenery.h"
#include "fovea/simulation/town_route.h"
#include "fovea/simulation/vehicle_motion.h"

namespace fovea::town_test {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::AllOf;
using ::testing::HasSubstr;

SimulationOptions town_options(const std::string& route, int frames = 170) {
  SimulationOptions options = simulation_options(Scene::kTown, "none");
  options.town.route = route;
  options.frames = frames;
  return options;
}

TEST(Town, PlacesTheDriveInTheTown) {
  SimulationOptions options = town_options("0,0 3,0 3,2 0,2 0,0");
  EXPECT_LT((make_scenery(options)->path().at(0).position - Vector2d(-11.5, 0)).norm(), 1e-9);
  options.town.begin = 50;
  EXPECT_LT((make_scenery(options)->path().at(0).position - Vector2d(38.5, 0)).norm(), 1e-9);
  const auto scenery = make_scenery(options);
  options.town.begin = 250;  // in another street
  EXPECT_LT(
      (make_scenery(options)->path().at(0).position - scenery->path().at(200).position).norm(),
      1e-6);
  EXPECT_EQ(scenery->local_origin().value(), Vector3d::Zero());
}

TEST(Town, AnOpenRouteMustBeLongEnough) {
  SimulationOptions options = town_options("0,0 2,0", 100);  // 143.5 m
  EXPECT_NO_THROW(make_scenery(options));
  options.town.begin = 60;
  try {
    make_scenery(options);
    ADD_FAILURE();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("need 104 m"), HasSubstr("84 m are left"),
                                    HasSubstr("town.route"), HasSubstr("fewer frames")));
  }
}

/// Left and right turns, straight crossings, and the same street in both directions.
const char* const kWindingRoute = "1,1 2,1 2,2 1,2 1,0 3,0 3,1 0,1 0,2";

/// Height of the ground below a place, from above the vehicle.
double ground_below(const RayCaster& caster, const Vector2d& place) {
  const auto hit = caster.cast({}, Vector3d(place.x(), place.y(), 1), -Vector3d::UnitZ(), 0, 10);
  return hit ? 1 - hit->distance : -1;
}

TEST(Town, TheVehicleStaysOnTheRoad) {
  for (const std::string& route :
       {std::string(kWindingRoute), std::string("3,3 3,1 1,1 1,3 3,3")}) {
    SimulationOptions options = town_options(route, 500);
    options.town.begin = 7;
    const auto scenery = make_scenery(options);
    RayCaster caster(*scenery);
    const VehicleMotion motion(scenery->path(), scenery->lane_offset(), options.vehicle, 1);
    for (double time = 0; time < 500 * options.lidar.period; time += 0.1) {
      const RigidMotion T_world_vehicle = motion.T_world_vehicle(time);
      if (std::fmod(time, 2) < 0.1) caster.move_to(T_world_vehicle.translation().head<2>(), 60);
      for (const double forward : {-1.5, 0.0, 1.5}) {
        for (const double left : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
          const Vector3d place = T_world_vehicle * Vector3d(forward, left, 0);
          ASSERT_NEAR(ground_below(caster, place.head<2>()), 0, 1e-6)
              << route << ' ' << time << " s, at " << place.transpose();
        }
      }
    }
  }
}

TEST(Town, NothingStandsInTheLane) {
  const SimulationOptions options = town_options(kWindingRoute, 500);
  const auto scenery = make_scenery(options);
  RayCaster caster(*scenery);
  const double end = driven_way(options);
  const auto lane = [&](double s, double d, double z) {
    const Vector2d p = scenery->path().offset(s, scenery->lane_offset() + d);
    return Vector3d(p.x(), p.y(), z);
  };
  for (double s = 0; s + 2 < end; s += 2) {
    if (std::fmod(s, 20) == 0) caster.move_to(lane(s, 0, 0).head<2>(), 50);
    for (const double d : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
      for (const double z : {0.3, 0.8, 1.3, 1.8}) {
        const Vector3d from = lane(s, d, z), to = lane(s + 2, d, z);
        ASSERT_FALSE(caster.cast({}, from, (to - from).normalized(), 0, (to - from).norm()))
            << s << " m, " << d << " m aside, " << z << " m up";
      }
    }
  }
}

/// Positions of a chunk's vertices, of parked cars or of everything else.
std::vector<Vector3d> positions(const Chunk& chunk, bool of_cars) {
  std::vector<Vector3d> result;
  const TriangleMesh& mesh = chunk.mesh_world;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    if ((chunk.surfaces.at(mesh.surface[t]) == "parked car") != of_cars) continue;
    for (const std::uint32_t vertex : mesh.triangle[t]) result.push_back(mesh.position[vertex]);
  }
  return result;
}

std::map<std::uint32_t, std::string> without_cars(const Chunk& chunk) {
  auto surfaces = chunk.surfaces;
  std::erase_if(surfaces, [](const auto& entry) { return entry.second == "parked car"; });
  return surfaces;
}

TEST(Town, OnlyTheParkedCarsDifferFromDayToDay) {
  SimulationOptions options = town_options("", 20);
  const auto first = make_scenery(options);
  options.pass = 3;
  options.town.route = "0,2 4,2";
  options.town.traffic = true;
  const auto second = make_scenery(options);
  int cars_differ = 0;
  const auto places = first->chunks_near(town_crossing({1, 1}), 60);
  EXPECT_GT(places.size(), 10u);
  for (const ChunkPlace& place : places) {
    const Chunk a = first->chunk(place.id), b = second->chunk(place.id);
    EXPECT_EQ(positions(a, false), positions(b, false));
    EXPECT_EQ(without_cars(a), without_cars(b));
    cars_differ += positions(a, true) != positions(b, true);
  }
  EXPECT_GT(cars_differ, 7);
}

TEST(Town, HasTheCrossingsAndStreetsOfItsGrid) {
  SimulationOptions options = town_options("0,0 2,0 2,1 0,1 0,0", 20);
  options.town.blocks_x = 2;
  options.town.blocks_y = 1;
  const auto scenery = make_scenery(options);
  std::size_t crossings = 0;
  const auto places = scenery->chunks_near({0, 0}, 1000);
  for (const ChunkPlace& place : places) {
    const auto surfaces = scenery->chunk(place.id).surfaces;
    crossings += surfaces.begin()->second == "crossing";
  }
  EXPECT_EQ(crossings, 6u);
  // Four streets of two chunks along x, three of one along y, and ten arms of two chunks.
  EXPECT_EQ(places.size(), crossings + 8 + 3 + 20);
}

// ---- traffic

/// Half the length and width of a model.
Vector2d half_size(const Model& model) {
  Vector2d half = Vector2d::Zero();
  for (const Vector3d& p : model.mesh.position) half = half.cwiseMax(p.head<2>().cwiseAbs());
  return half;
}

/// Whether two rectangles have no place in common.
/// @param T  from the second one's frame to that of the first; both stand upright
bool are_apart(const Vector2d& half_1, const Vector2d& half_2, const RigidMotion& T) {
  const Eigen::Matrix2d R = T.linear().topLeftCorner<2, 2>();
  const Vector2d between = T.translation().head<2>();
  const Vector2d free_1 = between.cwiseAbs() - half_1 - R.cwiseAbs() * half_2,
                 free_2 = (R.transpose() * between).cwiseAbs() - half_2 -
                          R.transpose().cwiseAbs() * half_1;
  return free_1.maxCoeff() > 0 || free_2.maxCoeff() > 0;
}

void expect_free_way(const SimulationOptions& options) {
  const auto scenery = make_scenery(options);
  const VehicleMotion motion(scenery->path(), scenery->lane_offset(), options.vehicle,
                             options.pass_seed());
  const Vector2d vehicle(2.3, 1.0);
  std::vector<Vector2d> sizes;
  for (const Model& model : scenery->models()) sizes.push_back(half_size(model));
  std::size_t seen = 0;
  for (double time = 0; time < options.frames * options.lidar.period; time += 0.05) {
    const RigidMotion T_vehicle_world = motion.T_world_vehicle(time).inverse();
    for (const Placement& mover : scenery->movers(time, motion.way(time))) {
      ++seen;
      const RigidMotion T = T_vehicle_world * mover.T_world_model;
      ASSERT_TRUE(are_apart(vehicle, sizes[mover.model], T))
          << time << " s: " << scenery->models()[mover.model].kind << " at "
          << T.translation().transpose();
    }
  }
  EXPECT_GT(seen, 10'000u);
}

TEST(TownTraffic, NothingRunsIntoTheVehicle) {
  for (const std::string& route : {std::string(kWindingRoute), std::string("1,1 2,1 2,2 1,2 1,1"),
                                   std::string("1,1 1,2 2,2 2,1 1,1")}) {
    for (int pass = 1; pass <= 8; ++pass) {
      SCOPED_TRACE(route + ", pass " + std::to_string(pass));
      SimulationOptions options = town_options(route, 500);
      options.pass = pass;
      options.town.traffic = true;
      expect_free_way(options);
    }
  }
}

TEST(TownTraffic, MoversAreOnTheGround) {
  SimulationOptions options = town_options("1,1 1,2 2,2 2,1 1,1", 200);
  options.town.traffic = true;
  const auto scenery = make_scenery(options);
  RayCaster caster(*scenery);
  caster.move_to(town_crossing({1, 1}), 150);
  int checked = 0;
  for (double time = 0; time < 20; time += 0.5) {
    for (const Placement& mover : scenery->movers(time, 9 * time)) {
      const Vector3d place = mover.T_world_model.translation();
      if ((place.head<2>() - town_crossing({1, 1})).norm() > 15) continue;
      const double ground = ground_below(caster, place.head<2>());
      if (ground > 0.13) continue;  // on top of a thing that stands on the pavement
      ++checked;
      EXPECT_NEAR(place.z(), ground, 0.001) << place.transpose();
    }
  }
  EXPECT_GT(checked, 50);
}

}  // namespace fovea::town_test
