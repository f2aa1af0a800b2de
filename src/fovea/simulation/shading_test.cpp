#include "fovea/simulation/shading.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/angle.h"
#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/test_scenery.h"

namespace fovea::shading_test {

using Eigen::Vector3d;
using Eigen::Vector3f;

const Vector3f kMatte(0.5f, 0.4f, 0.3f), kMirror(0.1f, 0.2f, 0.1f);
constexpr float kGloss = 0.3f;

/// Matte ground for x < 40 and a glossy one beyond; on each a wall along y, 2 m high.
class Wall : public TestScenery {
 public:
  Wall() {
    Material matte, mirror;
    matte.color = kMatte;
    mirror.color = kMirror;
    mirror.gloss = kGloss;
    MeshBuilder make;
    make.material = add(matte);
    make.quad({-40, -40, 0}, {40, -40, 0}, {40, 40, 0}, {-40, 40, 0});
    make.box({0, -30, 0}, {0.2, 30, 2});
    make.box({60, -30, 0}, {60.2, 30, 2});
    make.material = add(mirror);
    make.quad({40, -40, 0}, {90, -40, 0}, {90, 40, 0}, {40, 40, 0});
    TestScenery::add(Eigen::Vector2d(20, 0), make.take());
  }
};

LightOptions from_the_east(double sun, double sky) {
  LightOptions options;
  options.sun_azimuth = 90 * kDegree;
  options.sun_elevation = 45 * kDegree;
  options.sun = sun;
  options.sky = sky;
  return options;
}

struct Scene {
  Wall wall;
  RayCaster caster{wall};
  RayCaster::Moment still;

  Scene() { caster.move_to({0, 0}, 200); }

  /// Light of what a ray from `from` to `to` meets; all of a packet's rays are alike.
  SeenLight light(const LightOptions& options, const Vector3d& from, const Vector3d& to) const {
    const Shader shader(caster, options);
    Shader::Packet<Vector3d> along;
    along.fill((to - from).normalized());
    Shader::Packet<double> footprint;
    footprint.fill(0.01);
    const auto hits = caster.cast(still, from, along, 0.01, 100);
    return shader.light(still, hits, along, footprint)[3];
  }
};

TEST(Shader, ShadowTakesTheSunsPartAndNoMore) {
  const Scene scene;
  const auto ground = [&](double x, double sun, double sky) {
    return scene.light(from_the_east(sun, sky), {x, 0.4, 5}, {x, 0.4, 0});
  };
  // The wall's shadow reaches from x = -2 to 0.
  for (const double x : {-1.995, -1.0, -0.005}) {
    EXPECT_FALSE(ground(x, 1, 0.5).sunlit) << x;
    EXPECT_EQ(ground(x, 1, 0.5).color, ground(x, 0, 0.5).color) << x;
    EXPECT_EQ(ground(x, 1, 0).color, Vector3f::Zero()) << x;
  }
  for (const double x : {-2.005, -10.0, 3.0}) {
    EXPECT_TRUE(ground(x, 1, 0.5).sunlit) << x;
    const Vector3f sun = ground(x, 1, 0).color;
    EXPECT_LT((ground(x, 1, 0.5).color - ground(-1, 1, 0.5).color - sun).norm(), 1e-6f) << x;
    EXPECT_LT((ground(x, 2, 0).color - 2 * sun).norm(), 1e-6f);
    // A white sun: albedo times the cosine of its distance from the zenith, a little yellow.
    EXPECT_NEAR(sun.x(), kMatte.x() * std::sqrt(0.5), 1e-6);
    EXPECT_GT(sun.x() / kMatte.x(), sun.z() / kMatte.z());
  }
  EXPECT_LT((ground(-1, 1, 1).color - 2 * ground(-1, 1, 0.5).color).norm(), 1e-6f);
}

TEST(Shader, FacesTurnedAwayAreInTheShade) {
  const Scene scene;
  const LightOptions options = from_the_east(1, 0);
  EXPECT_EQ(scene.light(options, {-5, 1, 1}, {0, 1, 1}).color, Vector3f::Zero());
  const SeenLight east = scene.light(options, {5, 1, 1}, {0, 1, 1});
  EXPECT_TRUE(east.sunlit);
  EXPECT_NEAR(east.color.x(), kMatte.x() * std::sqrt(0.5), 1e-6);
}

TEST(Shader, SunStandsWhereItsAnglesSay) {
  const Scene scene;
  LightOptions options = from_the_east(1, 0.4);
  for (const double azimuth : {0.0, 90.0, 200.0}) {
    options.sun_azimuth = azimuth * kDegree;  // from north over east
    options.sun_elevation = 30 * kDegree;
    const Vector3d to_sun(std::cos(30 * kDegree) * std::sin(azimuth * kDegree),
                          std::cos(30 * kDegree) * std::cos(azimuth * kDegree), 0.5);
    const Shader shader(scene.caster, options);
    EXPECT_GT(shader.sky(to_sun).minCoeff(), 20);
    EXPECT_LT(shader.sky(Vector3d(-to_sun.x(), -to_sun.y(), 0.5)).maxCoeff(), 2);
  }
}

TEST(Shader, SkyIsSeenWhereNothingIs) {
  const Scene scene;
  const LightOptions options = from_the_east(1, 0.4);
  const Vector3d up(0, 0, 1);
  const SeenLight light = scene.light(options, {5, 5, 5}, {5, 5, 9});
  EXPECT_EQ(light.color, Shader(scene.caster, options).sky(up));
  EXPECT_FALSE(light.sunlit);
  EXPECT_GT(light.color.z(), light.color.x());  // blue
  const Shader night(scene.caster, from_the_east(1, 0));
  EXPECT_EQ(night.sky(up), Vector3f::Zero());
  EXPECT_EQ(night.sky(-up), Vector3f::Zero());  // the far ground, beyond all that is built
}

TEST(Shader, MatteLooksTheSameFromEverywhere) {
  const Scene scene;
  const LightOptions options = from_the_east(1, 0.4);
  const SeenLight above = scene.light(options, {-9, 3, 7}, {-9, 3, 0});
  for (const Vector3d& from : {Vector3d(-12, 3, 0.3), Vector3d(-9, -8, 2), Vector3d(-3, 3, 7)}) {
    EXPECT_LT((scene.light(options, from, {-9, 3, 0}).color - above.color).norm(), 1e-6f);
  }
}

TEST(Shader, GlossMirrorsByFresnelsLaw) {
  const Scene scene;
  const LightOptions options = from_the_east(1, 0.4);
  LightOptions without = options;
  without.reflections = false;
  const Shader shader(scene.caster, options);
  const Vector3d to(80, 3, 0);
  const Vector3f matte = scene.light(without, {80, 3, 5}, to).color;
  for (const Vector3d& from : {Vector3d(80, 3, 5), Vector3d(80, -10, 2), Vector3d(84, 9, 0.5)}) {
    const Vector3d along = (to - from).normalized();
    const Vector3d mirrored(along.x(), along.y(), -along.z());
    const auto share = float(kGloss + (1 - kGloss) * std::pow(1 + along.z(), 5));
    const Vector3f expected = (1 - share) * matte + share * shader.sky(mirrored);
    EXPECT_LT((scene.light(options, from, to).color - expected).norm(), 1e-5f);
    EXPECT_EQ(scene.light(without, from, to).color, matte);
  }
}

TEST(Shader, MirrorShowsWhatStandsThere) {
  const Scene scene;
  const LightOptions options = from_the_east(1, 0.4);
  // Seen from the east the ground before the wall mirrors the wall's lit face at 1 m.
  const Vector3d from(64.2, 0, 1), to(62.2, 0, 0);
  const Vector3f face = scene.light(options, {66, 0, 1}, {60.2, 0, 1}).color;
  LightOptions without = options;
  without.reflections = false;
  const Vector3f matte = scene.light(without, from, to).color;
  const auto share = float(kGloss + (1 - kGloss) * std::pow(1 - 1 / std::sqrt(5.0), 5));
  EXPECT_LT((scene.light(options, from, to).color - (1 - share) * matte - share * face).norm(),
            1e-5f);
}

}  // namespace fovea::shading_test
