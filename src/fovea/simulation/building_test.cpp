#include "fovea/simulation/building.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "fovea/simulation/ray_caster.h"
#include "fovea/simulation/test_scenery.h"

namespace fovea::building_test {

using Eigen::Vector3d;

/// Height of the front, below the roof.
double front_height(const BuildingPlan& plan) { return 3.6 + 3.1 * (plan.floors - 1) + 0.4; }

BuildingPlan random_plan(Random& random) {
  BuildingPlan plan;
  plan.width = random.uniform(8, 16);
  plan.depth = random.uniform(8, 10);
  plan.floors = 1 + int(random.below(5));
  plan.shop = random.uniform() < 0.5;
  plan.gable = random.uniform() < 0.5;
  plan.balconies = random.uniform() < 0.5;
  return plan;
}

TEST(Building, HasAFrontWithoutHoles) {
  const Palette palette = make_palette();
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    Random random(seed);
    const BuildingPlan plan = random_plan(random);
    MeshBuilder make;
    add_building(make, palette, plan, random);
    const TriangleMesh mesh = make.take();
    EXPECT_NO_THROW(mesh.check());
    for (const Vector3d& p : mesh.position) {
      // Nothing reaches into the street, the neighbours (but for a roof's edge) or the ground.
      ASSERT_LT(p.y(), 1.2);
      ASSERT_GT(p.y(), -plan.depth - 0.5);
      ASSERT_GT(p.x(), -0.25);
      ASSERT_LT(p.x(), plan.width + 0.25);
      ASSERT_GT(p.z(), -1e-9);
    }
    TestScenery scenery;
    scenery.add(Eigen::Vector2d(0, 0), mesh);
    RayCaster caster(scenery);
    caster.move_to({0, 0}, 10);
    int set_back = 0, count = 0;
    for (double x = 0.011; x < plan.width; x += 0.083) {
      for (double z = 0.013; z < front_height(plan); z += 0.079) {
        const Vector3d along = Vector3d(0.01, -1, 0.02).normalized();
        const auto hit = caster.cast({}, Vector3d(x, 0, z) - 20 * along, along, 0, 40);
        ASSERT_TRUE(hit) << seed << ": " << x << ' ' << z;
        ASSERT_GT(hit->position.y(), -0.17) << seed << ": " << x << ' ' << z;
        ++count;
        set_back += hit->position.y() < -0.1;
      }
    }
    EXPECT_GT(set_back, 0.04 * count);  // windows and doors
    EXPECT_LT(set_back, 0.6 * count);
  }
}

TEST(Building, IsClosedFromAboveAndBehind) {
  const Palette palette = make_palette();
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    const BuildingPlan plan = random_plan(random);
    MeshBuilder make;
    add_building(make, palette, plan, random);
    TestScenery scenery;
    scenery.add(Eigen::Vector2d(0, 0), make.take());
    RayCaster caster(scenery);
    caster.move_to({0, 0}, 10);
    for (double a = 0.05; a < 1; a += 0.043) {
      for (double b = 0.05; b < 1; b += 0.043) {
        const Vector3d roof(a * plan.width, -b * plan.depth, 60);
        const auto above = caster.cast({}, roof, -Vector3d::UnitZ(), 0, 60);
        ASSERT_TRUE(above);
        EXPECT_GT(above->position.z(), front_height(plan) - 0.1);
        const double z = b * (front_height(plan) - 0.5);
        EXPECT_TRUE(caster.cast({}, {a * plan.width, -30, z}, Vector3d::UnitY(), 0, 22));
        EXPECT_TRUE(caster.cast({}, {-20, -a * plan.depth, z}, Vector3d::UnitX(), 0, 20.1));
        EXPECT_TRUE(caster.cast({}, {40, -a * plan.depth, z}, -Vector3d::UnitX(), 0, 40.1));
      }
    }
  }
}

TEST(Building, TakesWhatItsPlanSays) {
  const Palette palette = make_palette();
  const auto triangles = [&](const BuildingPlan& plan, std::uint64_t seed = 5) {
    Random random(seed);
    MeshBuilder make;
    add_building(make, palette, plan, random);
    return make.take();
  };
  const auto has = [](const TriangleMesh& mesh, const std::vector<std::uint16_t>& materials) {
    for (const std::uint16_t m : mesh.material) {
      if (std::find(materials.begin(), materials.end(), m) != materials.end()) return true;
    }
    return false;
  };
  BuildingPlan plan;
  EXPECT_FALSE(has(triangles(plan), palette.shop_signs));
  EXPECT_FALSE(has(triangles(plan), {palette.roof_tiles, palette.dark_metal}));
  EXPECT_TRUE(has(triangles(plan), palette.walls));
  EXPECT_TRUE(has(triangles(plan), palette.doors));
  EXPECT_TRUE(has(triangles(plan), {palette.glass}));
  plan.shop = plan.gable = plan.balconies = true;
  EXPECT_TRUE(has(triangles(plan), palette.shop_signs));
  EXPECT_TRUE(has(triangles(plan), {palette.roof_tiles}));
  EXPECT_TRUE(has(triangles(plan), {palette.dark_metal}));
  EXPECT_EQ(triangles(plan).position, triangles(plan).position);
  EXPECT_NE(triangles(plan).position, triangles(plan, 6).position);
}

}  // namespace fovea::building_test
