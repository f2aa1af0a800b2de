#include "fovea/simulation/ray_caster.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fovea/core/random.h"
#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/test_scenery.h"

namespace fovea::ray_caster_test {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Where a float could not tell 2 mm apart.
const Vector3d kFar(30'000, -21'000, 0);
constexpr std::uint32_t kGround = 1, kBox = 2, kBall = 3;
constexpr double kBallRadius = 1.5;
constexpr int kBallSides = 240;

Vector3d random_direction(Random& random) {
  return Vector3d(random.normal(), random.normal(), random.normal()).normalized();
}

/// Ground of 80 m, a box and a ball on it, in two chunks round kFar.
class Yard : public TestScenery {
 public:
  Yard() {
    MeshBuilder ground;
    ground.frame.translation() = kFar;
    ground.surface = kGround;
    ground.quad({-40, -40, 0}, {40, -40, 0}, {40, 40, 0}, {-40, 40, 0});
    add(Vector2d(kFar.head<2>() + Vector2d(2, 3)), ground.take());
    MeshBuilder things;
    things.frame.translation() = kFar;
    things.surface = kBox;
    things.box({5, -1, 0}, {7, 1, 3});
    things.surface = kBall;
    things.ball({-6, 2, 4}, Vector3d::Constant(kBallRadius), kBallSides);
    add(Vector2d(kFar.head<2>() + Vector2d(-7, 10)), things.take());
  }
};

/// A yard, ready for rays, in which nothing moves.
struct ReadyYard {
  Yard yard;
  RayCaster caster{yard};
  RayCaster::Moment still;

  ReadyYard() { caster.move_to(kFar.head<2>(), 100); }
  std::optional<RayHit> cast(const Vector3d& from, const Vector3d& along) const {
    return caster.cast(still, kFar + from, along, 0.01, 200);
  }
};

TEST(RayCaster, MeetsThePlaneExactly) {
  const ReadyYard scene;
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const Vector3d from(random.uniform(-3, 3), random.uniform(-30, -10), random.uniform(0.5, 9));
    const Vector3d to(random.uniform(-35, 35), random.uniform(-35, -5), 0);
    const Vector3d along = (to - from).normalized();
    const auto hit = scene.cast(from, along);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->surface, kGround);
    EXPECT_NEAR(hit->distance, (to - from).norm(), 1e-9 * (to - from).norm());
    EXPECT_LT((hit->position - kFar - to).norm(), 1e-8);
    EXPECT_LT((hit->normal - Vector3d::UnitZ()).norm(), 1e-12);
    // Texture: metres from the quad's first corner.
    EXPECT_LT((hit->texture - Vector3f(float(to.x() + 40), float(to.y() + 40), 0)).norm(), 2e-5);
    EXPECT_FALSE(hit->moving());
  }
}

TEST(RayCaster, MeetsEachFaceOfABoxFromBothSides) {
  const ReadyYard scene;
  const Vector3d middle(6, 0, 1.5), half(1, 1, 1.5);
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    // Slabs: where a ray from far away enters the box.
    const Vector3d aim =
        middle + half.cwiseProduct(Vector3d(random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9),
                                            random.uniform(-0.9, 0.9)));
    Vector3d from = aim + 4 * random_direction(random);
    from.z() = std::abs(from.z()) + 0.05;
    const Vector3d along = (aim - from).normalized();
    if (((from - middle).cwiseAbs() - half).maxCoeff() < 0.01) continue;  // begins inside
    double enters = -1, leaves = 1e9;
    for (int k = 0; k < 3; ++k) {
      const double a = (middle[k] - half[k] - from[k]) / along[k],
                   b = (middle[k] + half[k] - from[k]) / along[k];
      enters = std::max(enters, std::min(a, b));
      leaves = std::min(leaves, std::max(a, b));
    }
    const auto hit = scene.cast(from, along);
    ASSERT_TRUE(hit && hit->surface == kBox);
    EXPECT_NEAR(hit->distance, enters, 1e-8);
    EXPECT_LT(hit->normal.dot(along), 0);
    EXPECT_NEAR(hit->normal.cwiseAbs().maxCoeff(), 1, 1e-12);
    // From within, the far side; its normal looks back as well.
    const auto inside = scene.cast(aim, along);
    ASSERT_TRUE(inside);
    EXPECT_NEAR(inside->distance, leaves - (aim - from).norm(), 1e-8);
    EXPECT_LT(inside->normal.dot(along), 0);
  }
}

TEST(RayCaster, MeetsABallWithinItsFacets) {
  const ReadyYard scene;
  const Vector3d center(-6, 2, 4);
  // A facet's middle lies this far below the ball.
  const double sagitta = kBallRadius * (1 - std::pow(std::cos(std::numbers::pi / kBallSides), 2));
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Vector3d along = random_direction(random);
    const Vector3d from = center - 3 * along;
    if (from.z() < 0.1) continue;
    const auto hit = scene.cast(from, along);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->surface, kBall);
    EXPECT_GE(hit->distance, 3 - kBallRadius - 1e-9);
    EXPECT_LE(hit->distance, 3 - kBallRadius + sagitta + 1e-9);
    EXPECT_LT((hit->normal + along).norm(), 0.03);
  }
}

TEST(RayCaster, KeepsToItsRange) {
  const ReadyYard scene;
  const Vector3d from = kFar + Vector3d(0, -20, 2), down = -Vector3d::UnitZ();
  const auto& still = scene.still;
  EXPECT_TRUE(scene.caster.cast(still, from, down, 0, 2.001));
  EXPECT_FALSE(scene.caster.cast(still, from, down, 0, 1.999));
  EXPECT_FALSE(scene.caster.cast(still, from, down, 2.001, 100));
  EXPECT_FALSE(scene.caster.cast(still, from, -down, 0, 100));
}

TEST(RayCaster, NoRaySlipsBetweenNeighbours) {
  const ReadyYard scene;
  for (int i = 0; i < 400; ++i) {  // along the diagonal of the ground's quad
    const Vector3d to(-39 + 0.07 * i, -39 + 0.07 * i, 0);
    EXPECT_TRUE(scene.cast(to + Vector3d(1.3, 0.4, 20), Vector3d(-1.3, -0.4, -20).normalized()));
  }
}

TEST(RayCaster, PacketsAreSingleRays) {
  ReadyYard scene;
  Random random(4);
  int met = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d from = kFar + Vector3d(0.2 * random.normal(), random.normal(), 2);
    RayCaster::Packet<Vector3d> along;
    for (Vector3d& a : along) a = random_direction(random);
    const auto hits = scene.caster.cast(scene.still, from, along, 0.01, 100);
    for (std::size_t k = 0; k < along.size(); ++k) {
      const auto single = scene.caster.cast(scene.still, from, along[k], 0.01, 100);
      ASSERT_EQ(bool(single), bool(hits[k]));
      if (!single) continue;
      ++met;
      EXPECT_NEAR(hits[k]->distance, single->distance, 1e-9);
      EXPECT_EQ(hits[k]->surface, single->surface);
      EXPECT_LT((hits[k]->texture - single->texture).norm(), 1e-5);
    }
  }
  EXPECT_GT(met, 700);
}

TEST(RayCaster, BlockedIsWhereSomethingStandsBetween) {
  const ReadyYard scene;
  Random random(5);
  int blocked = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3d along = random_direction(random);
    RayCaster::Packet<Vector3d> from;
    RayCaster::Packet<bool> wanted{};
    for (std::size_t k = 0; k < from.size(); ++k) {
      from[k] = kFar + Vector3d(random.uniform(-9, 9), random.uniform(-3, 3), 1.5);
      wanted[k] = random.uniform() < 0.7;
    }
    const auto answer = scene.caster.blocked(scene.still, from, wanted, along, 0.01, 30);
    for (std::size_t k = 0; k < from.size(); ++k) {
      const bool meets = scene.caster.cast(scene.still, from[k], along, 0.01, 30).has_value();
      EXPECT_EQ(answer[k], wanted[k] && meets);
      blocked += answer[k];
    }
  }
  EXPECT_GT(blocked, 100);
}

// ---- things that move

constexpr std::uint16_t kRed = 1;

/// A yard in which a box of 2 x 1 x 1 m drives along x at 3 m/s, turning; its path crosses y = -15.
class LivelyYard : public Yard {
 public:
  LivelyYard() {
    add(Material{});  // kRed
    MeshBuilder make;
    make.material = Palette::kPaint;
    make.box({-1, -0.5, 0}, {1, 0.5, 1});
    make.material = 0;
    add(Model{"crate", make.take(), 1.5, {}});
    moving = [](double time, double /*way*/) {
      Placement crate;
      crate.T_world_model.translation() = kFar + Vector3d(3 * time, -15, 0.5);
      crate.T_world_model.linear() = Eigen::AngleAxisd(0.1 * time, Vector3d::UnitZ()).matrix();
      crate.paint = kRed;
      crate.surface = Scenery::kMoving | 5;
      return std::vector<Placement>{crate};
    };
  }
};

TEST(RayCaster, MeetsMoversWhereTheyAreAtThatMoment) {
  const LivelyYard yard;
  RayCaster caster(yard);
  caster.move_to(kFar.head<2>(), 100);
  for (const double time : {0.0, 1.0, 2.5, -4.0}) {
    const RayCaster::Moment moment = caster.moment(time, 0);
    const double angle = 0.1 * time;
    const Vector3d middle = kFar + Vector3d(3 * time, -15, 1);
    // Onto the flank, squarely, from 6 m.
    const Vector3d along(-std::sin(angle), std::cos(angle), 0);
    const auto hit = caster.cast(moment, middle - 6 * along, along, 0.01, 100);
    ASSERT_TRUE(hit);
    EXPECT_TRUE(hit->moving());
    EXPECT_EQ(hit->surface, Scenery::kMoving | 5);
    EXPECT_EQ(hit->material, kRed);
    EXPECT_NEAR(hit->distance, 5.5, 1e-9);
    EXPECT_LT((hit->normal + along).norm(), 1e-12);
    // A second later it is elsewhere; behind it is nothing but the box or the sky.
    const auto later =
        caster.cast(caster.moment(time + 1, 0), middle - 6 * along, along, 0.01, 100);
    EXPECT_TRUE(!later || !later->moving());
    // In a packet, too.
    RayCaster::Packet<Vector3d> same;
    same.fill(along);
    const auto packet = caster.cast(moment, middle - 6 * along, same, 0.01, 100);
    EXPECT_EQ(packet[3]->distance, hit->distance);
    // What stands nearer hides it.
    const auto down = caster.cast(moment, middle + Vector3d(0, 0, 4), -Vector3d::UnitZ(), 0.01, 50);
    EXPECT_NEAR(down->distance, 3.5, 1e-9);
    const auto up = caster.cast(moment, middle - Vector3d(0, 0, 1.5), Vector3d::UnitZ(), 0.01, 50);
    EXPECT_EQ(up->surface, kGround);
    // It throws a shadow, as far as it reaches.
    RayCaster::Packet<Vector3d> from;
    RayCaster::Packet<bool> wanted{};
    from.fill(middle - 6 * along);
    wanted[1] = true;
    EXPECT_TRUE(caster.blocked(moment, from, wanted, along, 0.01, 100)[1]);
    EXPECT_FALSE(caster.blocked(moment, from, wanted, along, 0.01, 100)[2]);
    EXPECT_FALSE(caster.blocked(moment, from, wanted, along, 0.01, 5.4)[1]);
  }
}

// ---- chunks

TEST(RayCaster, ChunksThatComeBackAreTheSame) {
  const Yard yard;
  RayCaster caster(yard);
  const RayCaster::Moment still;
  Random random(6);
  std::vector<std::pair<Vector3d, Vector3d>> rays;
  for (int i = 0; i < 300; ++i) {
    rays.emplace_back(kFar + Vector3d(random.normal(), random.normal(), 2),
                      random_direction(random));
  }
  const auto cast_all = [&] {
    std::vector<std::optional<RayHit>> hits;
    for (const auto& [from, along] : rays)
      hits.push_back(caster.cast(still, from, along, 0.01, 99));
    return hits;
  };
  caster.move_to(kFar.head<2>(), 100);
  EXPECT_EQ(yard.built, 2);
  const auto before = cast_all();
  caster.move_to(kFar.head<2>() + Vector2d(1, 1), 100);
  EXPECT_EQ(yard.built, 2);  // what is there already is kept
  caster.move_to(kFar.head<2>() + Vector2d(500, 0), 100);
  for (const auto& hit : cast_all()) EXPECT_FALSE(hit);
  caster.move_to(kFar.head<2>() + Vector2d(-10, 4), 5.0);  // none
  caster.move_to(kFar.head<2>() + Vector2d(-10, 7), 6.0);  // the things, not the ground
  EXPECT_EQ(yard.built, 3);
  caster.move_to(kFar.head<2>() + Vector2d(-12, 7), 100);
  EXPECT_EQ(yard.built, 4);
  const auto after = cast_all();
  int met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    ASSERT_EQ(bool(before[i]), bool(after[i]));
    if (!before[i]) continue;
    ++met;
    EXPECT_EQ(before[i]->surface, after[i]->surface);
    // Another float says which of two facets of the ball a ray meets at their edge.
    EXPECT_NEAR(before[i]->distance, after[i]->distance, 1e-6);
  }
  EXPECT_GT(met, 140);
}

}  // namespace fovea::ray_caster_test
