#include "fovea/simulation/camera_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "fovea/core/angle.h"
#include "fovea/core/parallel.h"
#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/test_scenery.h"
#include "fovea/world/material.h"

namespace fovea::camera_model_test {

using Eigen::Vector3d;
using Eigen::Vector3f;

Camera test_camera() {
  Camera camera;
  camera.width = 63;
  camera.height = 25;
  camera.fx = camera.fy = 60;
  camera.cx = 30.7;
  camera.cy = 12.2;
  return camera;
}

/// A camera that looks along world x, then turned about its own axes.
RigidMotion looking_ahead(const Vector3d& at, double yaw = 0, double pitch = 0) {
  RigidMotion T = RigidMotion::Identity();
  T.translation() = at;
  T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  T.rotate(Eigen::AngleAxisd(yaw, Vector3d::UnitY()));
  T.rotate(Eigen::AngleAxisd(pitch, Vector3d::UnitX()));
  return T;
}

/// Light of the sky alone, or of the sun alone (then the sky is black).
LightOptions only_sky() {
  LightOptions options;
  options.sun = 0;
  options.sky = 0.5;
  return options;
}
LightOptions only_sun() {
  LightOptions options;
  options.sun = 1;
  options.sky = 0;
  options.sun_azimuth = 260 * kDegree;
  options.sun_elevation = 20 * kDegree;
  return options;
}

/// A scenery, ready to be looked at.
struct View {
  TestScenery scenery;
  std::unique_ptr<RayCaster> caster;
  std::unique_ptr<Shader> shader;
  std::unique_ptr<CameraModel> model;
  RayCaster::Moment still;

  std::uint16_t plain(const Vector3f& color) {
    Material m;
    m.color = color;
    return scenery.add(m);
  }
  void open(TriangleMesh mesh, const LightOptions& light, const Camera& camera = test_camera()) {
    scenery.add(Eigen::Vector2d(0, 0), std::move(mesh));
    caster = std::make_unique<RayCaster>(scenery);
    caster->move_to({0, 0}, 100);
    shader = std::make_unique<Shader>(*caster, light);
    model = std::make_unique<CameraModel>(*caster, *shader, camera);
  }
};

/// A wall at x = 10 that faces the camera at the origin; texture from its left lower corner.
TriangleMesh wall(std::uint16_t material, double left, double right, double low, double high) {
  MeshBuilder make;
  make.material = material;
  make.quad({10, left, low}, {10, right, low}, {10, right, high}, {10, left, high});
  return make.take();
}

std::size_t at(const Camera& camera, int u, int v) { return std::size_t(v * camera.width + u); }

// A camera that looks out of the side window, at an upright edge 10 m away.
TEST(CameraModel, ARollingShutterShearsUprightEdges) {
  View view;
  MeshBuilder make;
  make.material = view.plain(Vector3f::Ones());
  make.quad({10, 40, -30}, {10, 0, -30}, {10, 0, 30}, {10, 40, 30});
  make.material = view.plain(Vector3f::Zero());
  make.quad({10, 0, -30}, {10, -40, -30}, {10, -40, 30}, {10, 0, 30});
  view.open(make.take(), only_sky());
  const Camera camera = test_camera();
  constexpr double kSpeed = 25, kReadout = 0.04;  // m/s to the left, s
  const auto place = [&](double row) { return Vector3d(0, kSpeed * kReadout * (row - 0.5), 0); };
  const Rendering image = view.model->render_rows(
      [&](double row) { return CameraModel::View{looking_ahead(place(row)), view.still}; });
  const Rendering still = view.model->render(looking_ahead(place(0.5)), view.still);
  // The light left of the edge is as wide as the edge is far to the right.
  const auto edge_of = [&](const Rendering& rendering, int v) {
    double sum = 0;
    for (int u = 0; u < camera.width; ++u) sum += rendering.light[at(camera, u, v)].x();
    return sum / rendering.light[at(camera, 0, v)].x() - 0.5;
  };
  for (int v = 0; v < camera.height; ++v) {
    const double y = place(double(v) / (camera.height - 1)).y();
    EXPECT_NEAR(edge_of(image, v), camera.cx + camera.fx * y / 10, 0.13) << v;
    EXPECT_NEAR(edge_of(still, v), camera.cx, 0.13) << v;
  }
  EXPECT_NEAR(edge_of(image, camera.height - 1) - edge_of(image, 0), 6, 0.26);
}

TEST(CameraModel, DepthIsThatOfThePlaneAtEachPixelsCentre) {
  View view;
  view.open(wall(view.plain(Vector3f::Ones()), 40, -40, -30, 30), only_sky());
  const Camera camera = test_camera();
  for (const double yaw : {0.0, 0.5}) {
    const RigidMotion T = looking_ahead({1, 0.5, 0.2}, yaw, -0.1);
    const Rendering rendering = view.model->render(T, view.still);
    ASSERT_EQ(rendering.depth.size(), 63u * 25);
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const Vector3d ray =
            T.linear() * Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
        EXPECT_NEAR(rendering.depth[at(camera, u, v)], 9 / ray.x(), 2e-6 * 9 / ray.x());
      }
    }
  }
}

TEST(CameraModel, DepthIsWhatTheCentresRayMeetsAndNothingForSky) {
  View view;
  MeshBuilder make;
  make.material = view.plain(Vector3f::Ones());
  make.ball({8, 0, 0}, {1, 1.5, 1}, 40);
  make.box({12, -6, -3}, {13, 2, 1.4});
  view.open(make.take(), only_sky());
  const Camera camera = test_camera();
  const RigidMotion T = looking_ahead({0, 0, 0.1}, 0.05);
  const Rendering rendering = view.model->render(T, view.still);
  int sky = 0, met = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const double depth = rendering.depth[at(camera, u, v)];
      const auto hit = view.model->hit_at(u, v, T, view.still);
      (hit ? met : sky) += 1;
      const double expected = hit ? (T.inverse() * hit->position).z() : 0;
      EXPECT_NEAR(depth, expected, 1e-5) << u << ' ' << v;
      if (hit) {
        EXPECT_LT((*camera.project(T.inverse() * hit->position) - Eigen::Vector2d(u, v)).norm(),
                  1e-9);
      }
    }
  }
  EXPECT_GT(sky, 100);
  EXPECT_GT(met, 100);
}

/// Where light rises from dark to bright between pixels `first` and `last` of a row or column of
/// pixels: pixel k is the mean from k - 1/2 to k + 1/2.
template <class Light>
double edge_place(int first, int last, double bright, Light&& light) {
  double sum = 0;
  for (int k = first; k <= last; ++k) sum += light(k) / bright;
  return last + 0.5 - sum;
}

// The test that half a pixel's shift, a flipped axis or a lost principal point fails.
TEST(CameraModel, EdgesAppearWhereTheyProject) {
  View view;
  Material checker;
  checker.pattern = Pattern::kChecker;
  checker.color = Vector3f::Ones();
  checker.color_2 = Vector3f::Zero();
  checker.scale = 2;  // dark where y and z are between 0 and 2
  view.open(wall(view.scenery.add(checker), 20, -20, -20, 20), only_sky());
  const Camera camera = test_camera();
  for (const double y : {0.0, 0.13, 0.41, 0.78}) {
    for (const double z : {0.0, 0.21, -0.37}) {
      for (const double yaw : {0.0, 0.3}) {
        const RigidMotion T = looking_ahead({0, y, z}, yaw);
        const Rendering rendering = view.model->render(T, view.still);
        const auto pixel = [&](double world_y, double world_z) {
          return *camera.project(T.inverse() * Vector3d(10, world_y, world_z));
        };
        const auto light = [&](int u, int v) {
          return double(rendering.light[at(camera, u, v)].x());
        };
        // The upright edge at y = 0, between a dark square (left) and a bright one; half way up.
        const auto in_dark = pixel(1, 1), in_bright = pixel(-1, 1);
        const double bright =
            light(int(std::lround(in_bright.x())), int(std::lround(in_bright.y())));
        EXPECT_NEAR(light(int(std::lround(in_dark.x())), int(std::lround(in_dark.y()))), 0, 1e-6);
        const int row = int(std::lround(pixel(0, 1).y()));
        const double v_edge = row;  // the edge is a straight line, not upright when turned
        const auto top = pixel(0, 2), bottom = pixel(0, 0);
        const double u_edge =
            bottom.x() + (v_edge - bottom.y()) / (top.y() - bottom.y()) * (top.x() - bottom.x());
        const int middle = int(std::lround(u_edge));
        EXPECT_NEAR(
            edge_place(middle - 4, middle + 4, bright, [&](int u) { return light(u, row); }),
            u_edge, 0.02)
            << y << ' ' << z << ' ' << yaw;
        if (yaw != 0) continue;
        // The level edge at z = 0 in the middle of a column of squares: bright below, dark above.
        const int column = int(std::lround(pixel(1, 0).x()));
        const int level = int(std::lround(pixel(1, 0).y()));
        EXPECT_NEAR(
            edge_place(level - 4, level + 4, bright, [&](int v) { return light(column, v); }),
            pixel(1, 0).y(), 0.02);
      }
    }
  }
}

TEST(CameraModel, EdgesOfThingsAreSmooth) {
  const Camera camera = test_camera();
  const RigidMotion T = looking_ahead(Vector3d::Zero());
  for (int step = 0; step <= 16; ++step) {
    // The wall's left edge projects to u = 25 + share, its lower one to v = 7 + share.
    const double share = step / 16.0 - 0.5;
    View view;
    const double y = -(25 + share - camera.cx) / camera.fx * 10,
                 z = -(7 + share - camera.cy) / camera.fy * 10;
    view.open(wall(view.plain(Vector3f::Ones()), y, -40, z, 40), only_sun());
    const Rendering rendering = view.model->render(T, view.still);
    const auto light = [&](int u, int v) { return double(rendering.light[at(camera, u, v)].x()); };
    const double bright = light(40, 3);
    ASSERT_GT(bright, 0.5);
    EXPECT_EQ(light(5, 20), 0);
    EXPECT_NEAR(light(25, 3) / bright, 0.5 - share, 0.126) << share;
    EXPECT_NEAR(light(40, 7) / bright, 0.5 + share, 0.126) << share;
    EXPECT_EQ(light(24, 3), 0);
    EXPECT_NEAR(light(26, 3), bright, 1e-6);
  }
}

TEST(CameraModel, SlantedEdgesAreSmoothInTheMean) {
  View view;
  MeshBuilder make;
  make.material = view.plain(Vector3f::Ones());
  // A triangle with known area in pixels.
  const Camera camera = test_camera();
  const auto place = [&](double u, double v) {
    return Vector3d(10, -(u - camera.cx) / camera.fx * 10, -(v - camera.cy) / camera.fy * 10);
  };
  make.triangle(place(10.3, 20.1), place(52.2, 15.7), place(20.8, 4.4));
  view.open(make.take(), only_sun());
  const Rendering rendering = view.model->render(looking_ahead(Vector3d::Zero()), view.still);
  double sum = 0;
  for (const Vector3f& light : rendering.light) {
    sum += light.x() / rendering.light[at(camera, 25, 14)].x();
  }
  const Eigen::Vector2d a(52.2 - 10.3, 15.7 - 20.1), b(20.8 - 10.3, 4.4 - 20.1);
  EXPECT_NEAR(sum, 0.5 * std::abs(a.x() * b.y() - a.y() * b.x()), 1.5);
}

TEST(CameraModel, LightAtPixelsIsTheImages) {
  View view;
  Material bricks;
  bricks.pattern = Pattern::kBricks;
  bricks.size = {0.24f, 0.075f};
  MeshBuilder make;
  make.material = view.scenery.add(bricks);
  make.box({9, -4, -3}, {12, 3, 1});
  make.material = view.plain({0.5f, 0.1f, 0.1f});
  make.ball({7, 1, 0.3}, {0.8, 0.8, 0.8}, 20);
  view.open(make.take(), LightOptions{});
  const Camera camera = test_camera();
  const RigidMotion T = looking_ahead({0, 0.1, 0.2}, 0.1, 0.03);
  const Rendering rendering = view.model->render(T, view.still);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Vector3f light = view.model->light_at(u, v, T, view.still);
      EXPECT_LT((light - rendering.light[at(camera, u, v)]).norm(), 1e-6f) << u << ' ' << v;
    }
  }
  // ... and does not depend on the number of threads.
  const ThreadLimit one(1);
  const Rendering again = view.model->render(T, view.still);
  EXPECT_EQ(again.light, rendering.light);
  EXPECT_EQ(again.depth, rendering.depth);
}

// ---- development

Rendering even(int width, int height, const Vector3f& light) {
  const auto n = std::size_t(width * height);
  return {width, height, std::vector<Vector3f>(n, light), std::vector<float>(n, 1)};
}

TEST(Develop, EncodesLightAsSrgb) {
  const Image image = develop(even(3, 2, {0.5f, 0, 4}), {});
  ASSERT_EQ(image.channels, 3);
  EXPECT_EQ(std::vector<int>(image.pixel(2, 1), image.pixel(2, 1) + 3),
            (std::vector<int>{188, 0, 255}));
}

TEST(Develop, ExposureMultipliesLight) {
  for (const float light : {0.01f, 0.1f, 0.3f, 0.6f}) {
    EXPECT_EQ(develop(even(4, 4, Vector3f::Constant(light)), {.exposure = 2}).data,
              develop(even(4, 4, Vector3f::Constant(2 * light)), {}).data);
  }
}

TEST(Develop, VignettingTakesItsShareInTheCornersAndNothingInTheMiddle) {
  const Vector3f light = Vector3f::Constant(0.5f);
  const Image image = develop(even(41, 21, light), {.vignetting = 0.4});
  const auto level = [](float share) { return encode_srgb(Vector3f::Constant(share)).r; };
  EXPECT_EQ(image.pixel(20, 10)[0], level(0.5f));
  for (const int x : {0, 40}) {
    for (const int y : {0, 20}) EXPECT_EQ(image.pixel(x, y)[0], level(0.5f * 0.6f));
  }
  for (int x = 20; x < 40; ++x) EXPECT_GE(image.pixel(x, 10)[0], image.pixel(x + 1, 10)[0]);
}

TEST(Develop, NoiseHasNoMeanAndTheStatedDeviationAtHalfLight) {
  constexpr int kSide = 150;
  constexpr double kNoise = 6, kN = kSide * kSide * 3;
  const Vector3f half = decode_srgb({128, 128, 128});
  const auto moments = [&](const Vector3f& light, std::uint64_t seed) {
    const Image image = develop(even(kSide, kSide, light), {.noise = kNoise, .seed = seed});
    double mean = 0, square = 0;
    for (const std::uint8_t value : image.data) mean += value / kN;
    for (const std::uint8_t value : image.data) square += (value - mean) * (value - mean) / kN;
    return std::pair(mean, std::sqrt(square));
  };
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto [mean, deviation] = moments(half, seed);
    EXPECT_NEAR(mean, 128, 5 * kNoise / std::sqrt(kN));
    // 128 is 127.5 and a little; rounding adds a twelfth.
    EXPECT_NEAR(deviation, std::sqrt(kNoise * kNoise * 1.0024 + 1 / 12.0),
                5 * kNoise / std::sqrt(2 * kN));
  }
  EXPECT_LT(moments(decode_srgb({40, 40, 40}), 1).second, 0.85 * kNoise);
  EXPECT_GT(moments(decode_srgb({210, 210, 210}), 1).second, 1.1 * kNoise);
}

TEST(Develop, NoiseBelongsToTheSeed) {
  const Rendering rendering = even(64, 48, Vector3f::Constant(0.2f));
  const Image image = develop(rendering, {.noise = 3, .seed = 5});
  EXPECT_EQ(develop(rendering, {.noise = 3, .seed = 5}).data, image.data);
  EXPECT_NE(develop(rendering, {.noise = 3, .seed = 6}).data, image.data);
  EXPECT_EQ(develop(rendering, {.seed = 6}).data, develop(rendering, {.seed = 5}).data);
  const ThreadLimit one(1);
  EXPECT_EQ(develop(rendering, {.noise = 3, .seed = 5}).data, image.data);
  // No two rows are alike.
  EXPECT_FALSE(std::equal(image.pixel(0, 0), image.pixel(0, 1), image.pixel(0, 1)));
}

TEST(Develop, GreyIsLuminance) {
  const auto grey = [](const Vector3f& light) {
    const Image image = develop(even(2, 2, light), {.grey = true});
    EXPECT_EQ(image.channels, 1);
    EXPECT_EQ(image.data.size(), 4u);
    return int(image.data[3]);
  };
  EXPECT_EQ(grey(Vector3f::Constant(0.3f)), encode_srgb(Vector3f::Constant(0.3f)).r);
  EXPECT_EQ(grey(Vector3f::Ones()), 255);
  EXPECT_EQ(grey({0, 0.5f, 0}), encode_srgb(Vector3f::Constant(0.587f * 0.5f)).r);
  EXPECT_GT(grey({0, 0.5f, 0}), grey({0.5f, 0, 0}));
  EXPECT_GT(grey({0.5f, 0, 0}), grey({0, 0, 0.5f}));
}

TEST(Exposure, IsSmoothAndDiffersALittleBetweenCameras) {
  CameraOptions options;
  options.exposure = 1.5;
  options.exposure_variation = 0.4;
  double lowest = 9, highest = 0;
  for (double t = -1; t < 60; t += 0.02) {
    const double exposure = exposure_at(options, 2, t, 7);
    lowest = std::min(lowest, exposure);
    highest = std::max(highest, exposure);
    // The steepest a sum of these two waves can be: 1.6 a second.
    EXPECT_LT(std::abs(std::log(exposure_at(options, 2, t + 0.001, 7) / exposure)),
              0.0016 * options.exposure_variation);
    const double ratio = exposure_at(options, 3, t, 7) / exposure;
    EXPECT_NEAR(ratio, exposure_at(options, 3, 0, 7) / exposure_at(options, 2, 0, 7), 1e-12);
    EXPECT_NEAR(ratio, 1, 0.07);
    EXPECT_NE(ratio, 1);
  }
  EXPECT_LE(highest, 1.5 * std::exp(0.4 * 1.08));
  EXPECT_GE(lowest, 1.5 * std::exp(-0.4 * 1.08));
  EXPECT_GT(highest / lowest, std::exp(0.5));
  EXPECT_NE(exposure_at(options, 2, 1, 7), exposure_at(options, 2, 1, 8));
}

TEST(Exposure, IsConstantWhereItsVariationIsOff) {
  CameraOptions options;
  options.exposure = 1.5;
  options.exposure_variation = 0;
  for (double t = 0; t < 20; t += 0.7) EXPECT_EQ(exposure_at(options, int(t) % 4, t, 3), 1.5);
}

TEST(Exposure, OfTheLastCameraIsTheRatioTimesThatOfTheFirst) {
  CameraOptions options;
  options.exposure_variation = 0;
  options.exposure_ratio = 4;
  options.cameras = {kitti_camera(2), kitti_camera(3), kitti_camera(0)};
  EXPECT_DOUBLE_EQ(exposure_at(options, 2, 1, 7), 1);
  EXPECT_DOUBLE_EQ(exposure_at(options, 3, 1, 7), 2);
  EXPECT_DOUBLE_EQ(exposure_at(options, 0, 1, 7), 4);
}

TEST(WhiteBalance, ChangesInSteps) {
  CameraOptions options;
  EXPECT_EQ(white_balance_at(options, 2, 1, 7), Vector3f::Ones());
  options.white_balance_step = 0.1;
  double squares = 0;
  for (int step = 0; step < 200; ++step) {
    const Vector3f gains = white_balance_at(options, 2, 4.0 * step, 7);
    EXPECT_EQ(gains, white_balance_at(options, 2, 4.0 * step + 3.99, 7));
    EXPECT_EQ(gains.y(), 1);
    squares += std::pow(std::log(gains.x()), 2) + std::pow(std::log(gains.z()), 2);
  }
  EXPECT_NEAR(std::sqrt(squares / 400), 0.1, 0.01);
}

TEST(Develop, TakesTheWhiteBalanceAndTheCenterOfTheVignetting) {
  const auto developed = [](const Development& development) {
    return develop(even(5, 5, Vector3f::Constant(0.2f)), development);
  };
  const Image tinted = developed({.white_balance = {2, 1, 0.5f}});
  EXPECT_EQ(tinted.pixel(2, 2)[1], developed({}).pixel(2, 2)[1]);
  EXPECT_EQ(tinted.pixel(2, 2)[0], developed({.exposure = 2}).pixel(2, 2)[0]);
  const Image dark = developed({.vignetting = 0.5, .center = {0, 0}});
  EXPECT_EQ(dark.pixel(0, 0)[1], developed({}).pixel(0, 0)[1]);
  EXPECT_EQ(dark.pixel(4, 4)[1], developed({.exposure = 0.5}).pixel(4, 4)[1]);
}

}  // namespace fovea::camera_model_test
