#include "fovea/simulation/scenery.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "fovea/simulation/models.h"
#include "fovea/simulation/ray_caster.h"
#include "fovea/simulation/street_builder.h"
#include "fovea/simulation/vehicle_motion.h"
#include "fovea/simulation/world_export.h"

namespace fovea::scenery_test {

using Eigen::Vector2d;
using Eigen::Vector3d;

SimulationOptions scene_named(const std::string& name, int seed = 1, int frames = 30) {
  SimulationOptions options = simulation_options(parse_scene(name), "none");
  options.seed = seed;
  options.frames = frames;
  return options;
}

bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.position == b.position && a.texture == b.texture && a.triangle == b.triangle &&
         a.material == b.material && a.surface == b.surface;
}

/// Nothing that would make a ray's answer meaningless.
void expect_sound(const TriangleMesh& mesh, std::size_t materials) {
  EXPECT_NO_THROW(mesh.check());
  EXPECT_FALSE(mesh.empty());
  bool finite = true;
  for (const Vector3d& p : mesh.position) finite = finite && p.allFinite();
  for (const Eigen::Vector3f& t : mesh.texture) finite = finite && t.allFinite();
  EXPECT_TRUE(finite);
  std::size_t flat = 0;
  for (std::size_t t = 0; t < mesh.size(); ++t) flat += mesh.normal(t).isZero();
  EXPECT_EQ(flat, 0u);
  for (const std::uint16_t material : mesh.material) ASSERT_LT(material, materials);
}

// ---- what stands about

TEST(Models, AreSoundAndFitIntoTheirBalls) {
  const Palette palette = make_palette();
  const ModelSet set = make_models(palette);
  for (const Model& model : set.models) {
    SCOPED_TRACE(model.kind);
    expect_sound(model.mesh, palette.materials.size());
    double farthest = 0, lowest = 1;
    for (const Vector3d& p : model.mesh.position) {
      farthest = std::max(farthest, p.norm());
      lowest = std::min(lowest, p.z());
    }
    EXPECT_LE(farthest, model.radius);
    EXPECT_GT(farthest, 0.4 * model.radius);
    EXPECT_NEAR(lowest, 0, 0.05);  // on the ground
  }
}

TEST(Models, PlacementsGiveSurfaceAndPaint) {
  const Palette palette = make_palette();
  const Model car = make_car(palette, 1, 2);
  Placement placement;
  placement.T_world_model.translation() = Vector3d(5, 6, 7);
  placement.paint = palette.car_paints[3];
  placement.surface = 99;
  const TriangleMesh mesh = placed_mesh(car, placement);
  ASSERT_EQ(mesh.size(), car.mesh.size());
  EXPECT_EQ(mesh.position[8], car.mesh.position[8] + Vector3d(5, 6, 7));
  int painted = 0;
  for (std::size_t t = 0; t < mesh.size(); ++t) {
    EXPECT_EQ(mesh.surface[t], 99u);
    const bool paint = car.mesh.material[t] == Palette::kPaint;
    EXPECT_EQ(mesh.material[t], paint ? palette.car_paints[3] : car.mesh.material[t]);
    painted += paint;
  }
  EXPECT_GT(painted, 20);
}

// ---- every scene

class EveryScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scenery, EveryScene, testing::ValuesIn(scene_names()),
                         [](const auto& test) { return test.param; });

TEST_P(EveryScene, ChunksAreSoundAndTheirSurfacesHaveNames) {
  const auto scenery = make_scenery(scene_named(GetParam()));
  std::set<std::uint32_t> known;
  const auto places = scenery->chunks_near({0, 0}, 60);
  EXPECT_GE(places.size(), 3u);
  for (const ChunkPlace& place : places) {
    const Chunk chunk = scenery->chunk(place.id);
    expect_sound(chunk.mesh_world, scenery->palette().materials.size());
    std::set<std::uint32_t> used(chunk.mesh_world.surface.begin(), chunk.mesh_world.surface.end());
    for (const std::uint32_t surface : used) {
      EXPECT_TRUE(chunk.surfaces.contains(surface)) << surface;
      EXPECT_EQ(surface & Scenery::kMoving, 0u);
      EXPECT_TRUE(known.insert(surface).second) << "in two chunks: " << surface;
    }
    // No vertex is so far from the chunk's center that a float would blur it.
    for (const Vector3d& p : chunk.mesh_world.position) {
      ASSERT_LT((p.head<2>() - place.center).norm(), 120);
    }
  }
}

TEST_P(EveryScene, ChunksDependOnTheSeedAlone) {
  const auto scenery = make_scenery(scene_named(GetParam()));
  const auto longer = make_scenery(scene_named(GetParam(), 1, 500));
  const auto other = make_scenery(scene_named(GetParam(), 2));
  bool differs = false;
  const auto places = scenery->chunks_near({0, 0}, 30);
  ASSERT_FALSE(places.empty());
  for (const ChunkPlace& place : places) {
    const Chunk chunk = scenery->chunk(place.id);
    EXPECT_TRUE(same(scenery->chunk(place.id).mesh_world, chunk.mesh_world));
    EXPECT_EQ(scenery->chunk(place.id).surfaces, chunk.surfaces);
    EXPECT_TRUE(same(longer->chunk(place.id).mesh_world, chunk.mesh_world));
    differs = differs || !same(other->chunk(place.id).mesh_world, chunk.mesh_world);
  }
  EXPECT_TRUE(differs);
}

// Arguments are evaluated in an order that a compiler may choose: what is drawn for them must not
// be.
TEST(Scenery, IsTheSameByEveryCompiler) {
  const auto scenery = make_scenery(scene_named("stress"));
  Vector3d position = Vector3d::Zero(), texture = Vector3d::Zero();
  double vertices = 0;
  for (const ChunkPlace& place : scenery->chunks_near({0, 0}, 60)) {
    const TriangleMesh mesh = scenery->chunk(place.id).mesh_world;
    for (const Vector3d& p : mesh.position) position += p;
    for (const Eigen::Vector3f& t : mesh.texture) texture += t.cast<double>();
    vertices += double(mesh.position.size());
  }
  EXPECT_EQ(vertices, 820188);
  EXPECT_LT((position / vertices - Vector3d(3.244734, -1.763934, 1.881701)).norm(), 1e-5);
  EXPECT_LT((texture / vertices - Vector3d(0.333868, 0.157078, 214.226852)).norm(), 1e-5);

  double way = 0;
  for (const Placement& mover : make_scenery(scene_named("traffic"))->movers(3, 20)) {
    way += mover.T_world_model.translation().sum();
  }
  EXPECT_NEAR(way, 1010.018392, 1e-5);
}

TEST_P(EveryScene, ThereIsGroundBelowTheVehicleAndNothingInItsLane) {
  for (const int seed : {1, 2}) {
    const SimulationOptions options = scene_named(GetParam(), seed, 140);
    const auto scenery = make_scenery(options);
    RayCaster caster(*scenery);
    const RayCaster::Moment still;
    const auto lane = [&](double s, double d, double z) {
      const Vector2d p = scenery->path().offset(s, scenery->lane_offset() + d);
      return Vector3d(p.x(), p.y(), z);
    };
    for (double s = 0; s < 100; s += 2) {
      if (std::fmod(s, 20) == 0) caster.move_to(lane(s, 0, 0).head<2>(), 50);
      // A cage of rays along the lane: no thing of 30 cm fits between.
      for (const double d : {-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0}) {
        for (const double z : {0.3, 0.6, 0.9, 1.2, 1.5, 1.8, 2.0}) {
          const Vector3d from = lane(s, d, z), to = lane(s + 2, d, z);
          const auto hit =
              caster.cast(still, from, (to - from).normalized(), 0, (to - from).norm());
          ASSERT_FALSE(hit) << "seed " << seed << ", " << s << " m, " << d << " m aside, " << z
                            << " m up: " << scenery->palette().materials[hit->material].name;
        }
      }
      // Where one chunk ends and the next begins, too.
      for (double d = -1.2; d <= 1.2; d += 0.05) {
        const auto ground = caster.cast(still, lane(s, d, 1), -Vector3d::UnitZ(), 0, 10);
        ASSERT_TRUE(ground) << "seed " << seed << ", " << s << " m, " << d << " m aside";
        ASSERT_NEAR(ground->distance, 1, 1e-6);
      }
    }
  }
}

TEST_P(EveryScene, PathIsLongEnoughForTheDrive) {
  for (const int frames : {1, 100, 3000}) {
    const SimulationOptions options = scene_named(GetParam(), 3, frames);
    const auto scenery = make_scenery(options);
    const double end = longest_way(options.vehicle, options.lidar.period * (frames + 1));
    EXPECT_GE(scenery->path().end(), end);
    EXPECT_LE(scenery->path().begin(), -2);
    if (options.scene != Scene::kTown) {  // there the route has its own begin
      EXPECT_NEAR(scenery->path().at(0).position.norm(), 0, 1e-9);
    }
    // What the vehicle sees at its last place is there.
    const Vector2d last = scenery->path().at(end).position;
    double nearest = 1e9;
    for (const ChunkPlace& place : scenery->chunks_near(last, 100)) {
      nearest = std::min(nearest, (place.center - last).norm());
    }
    EXPECT_LT(nearest, 25);
  }
}

TEST_P(EveryScene, ExportIsTheChunksInTheLocalFrame) {
  const auto scenery = make_scenery(scene_named(GetParam()));
  const auto places = scenery->chunks_near({0, 0}, 30);
  std::set<std::uint32_t> ids;
  std::size_t triangles = 0, surfaces = 0;
  for (const ChunkPlace& place : places) {
    ids.insert(place.id);
    triangles += scenery->chunk(place.id).mesh_world.size();
    surfaces += scenery->chunk(place.id).surfaces.size();
  }
  RigidMotion T_local_world = RigidMotion::Identity();
  T_local_world.translation() = Vector3d(1, 2, -1.7);
  const World world = export_world(*scenery, ids, T_local_world);
  EXPECT_NO_THROW(world.mesh_local.check());
  EXPECT_EQ(world.mesh_local.size(), triangles);
  EXPECT_EQ(world.surfaces.size(), surfaces);
  EXPECT_EQ(world.materials.size(), scenery->palette().materials.size());
  const Chunk first = scenery->chunk(*ids.begin());
  EXPECT_EQ(world.mesh_local.position[5], first.mesh_world.position[5] + Vector3d(1, 2, -1.7));
}

// ---- round the block

TEST(Crossing, PathClosesAfterALapAndPassesAllCorners) {
  const SimulationOptions options = scene_named("crossing", 1, 900);
  const auto scenery = make_scenery(options);
  const Path& path = scenery->path();
  // Just beyond the fourth turn the way is straight along x again: what is left is the lap.
  double s = 0;
  while (path.at(s).heading < 2 * std::numbers::pi - 1e-12) s += 0.25;
  s += 1;
  const double lap = s - path.at(s).position.x();
  EXPECT_GT(lap, 150);
  ASSERT_LT(2 * lap, path.end());
  for (double at = 0; at < lap; at += 1.7) {
    EXPECT_LT((path.at(at + lap).position - path.at(at).position).norm(), 1e-6);
    EXPECT_NEAR(path.at(at + lap).heading - path.at(at).heading, 2 * std::numbers::pi, 1e-9);
  }
  std::vector<Vector2d> corners;
  for (const ChunkPlace& place : scenery->chunks_near({0, 0}, 500)) {
    for (const auto& [surface, kind] : scenery->chunk(place.id).surfaces) {
      if (kind == "crossing") corners.push_back(place.center);
    }
  }
  ASSERT_EQ(corners.size(), 4u);
  // All turns are alike: where one corner lies off its turn, something is out of place.
  std::vector<double> nearest(4, 1e9);
  for (double at = 0; at < lap; at += 0.05) {
    for (std::size_t k = 0; k < 4; ++k) {
      nearest[k] = std::min(nearest[k], (path.at(at).position - corners[k]).norm());
    }
  }
  for (const double distance : nearest) {
    EXPECT_LT(distance, 5);
    EXPECT_NEAR(distance, nearest[0], 0.002);
  }
}

// ---- what moves

double half_length(const Model& model, int axis) {
  double half = 0;
  for (const Vector3d& p : model.mesh.position) half = std::max(half, std::abs(p[axis]));
  return half;
}

TEST(Traffic, OnlyTheTrafficSceneMoves) {
  for (const std::string& name : scene_names()) {
    const auto scenery = make_scenery(scene_named(name));
    EXPECT_EQ(scenery->movers(1, 9).empty(), name != "traffic") << name;
  }
}

TEST(Traffic, MoversGoWithoutJumpsNearTheVehicle) {
  constexpr double kStep = 0.01;
  for (const int seed : {1, 2, 3}) {
    const SimulationOptions options = scene_named("traffic", seed, 110);
    const auto scenery = make_scenery(options);
    const VehicleMotion motion(scenery->path(), scenery->lane_offset(), options.vehicle, seed);
    std::map<std::uint32_t, RigidMotion> before;
    int seen = 0, fast = 0;
    for (double t = 0; t < 10; t += kStep) {
      std::map<std::uint32_t, RigidMotion> now;
      const Vector2d vehicle = motion.T_world_vehicle(t).translation().head<2>();
      for (const Placement& mover : scenery->movers(t, motion.way(t))) {
        EXPECT_NE(mover.surface & Scenery::kMoving, 0u);
        EXPECT_LT(mover.model, scenery->models().size());
        EXPECT_LT(mover.paint, scenery->palette().materials.size());
        EXPECT_TRUE(now.emplace(mover.surface, mover.T_world_model).second);
        const Vector3d at = mover.T_world_model.translation();
        const auto was = before.find(mover.surface);
        if ((at.head<2>() - vehicle).norm() > 60) continue;
        if (t == 0) continue;
        ++seen;
        ASSERT_NE(was, before.end()) << "appears at " << t << " s";
        const Vector3d moved = at - was->second.translation();
        ASSERT_LT(moved.head<2>().norm(), 15 * kStep) << t;
        ASSERT_LE(std::abs(moved.z()), 0.121);  // up and down a kerb
        fast += moved.norm() > 3 * kStep;
      }
      before = std::move(now);
    }
    EXPECT_GT(seen, 5000);
    EXPECT_GT(fast, 1000);
  }
}

TEST(Traffic, NothingRunsIntoTheVehicle) {
  for (int seed = 1; seed <= 12; ++seed) {
    SimulationOptions options = scene_named("traffic", seed, 900);
    if (seed > 10) options.vehicle.speed = 18;
    const auto scenery = make_scenery(options);
    const VehicleMotion motion(scenery->path(), scenery->lane_offset(), options.vehicle, seed);
    std::vector<Eigen::Vector2d> halves;
    for (const Model& model : scenery->models()) {
      halves.emplace_back(half_length(model, 0), half_length(model, 1));
    }
    for (double t = 0; t < 90; t += 0.05) {
      const RigidMotion T_vehicle_world = motion.T_world_vehicle(t).inverse();
      for (const Placement& mover : scenery->movers(t, motion.way(t))) {
        const RigidMotion T = T_vehicle_world * mover.T_world_model;
        const Eigen::Vector2d& half = halves[mover.model];
        // Extents along the vehicle's axes; turned things take up more.
        const double c = std::abs(T.linear()(0, 0)), s = std::abs(T.linear()(1, 0));
        const bool beside = std::abs(T.translation().y()) > 1.0 + c * half.y() + s * half.x();
        const bool away = std::abs(T.translation().x()) > 2.3 + c * half.x() + s * half.y();
        ASSERT_TRUE(beside || away)
            << "seed " << seed << ", " << t << " s: " << scenery->models()[mover.model].kind
            << " at " << T.translation().transpose();
      }
    }
  }
}

}  // namespace fovea::scenery_test
