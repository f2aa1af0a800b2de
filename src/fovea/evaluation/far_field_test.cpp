#include "fovea/evaluation/far_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/angle.h"
#include "fovea/rendering/wall_test_scene.h"

namespace fovea::far_field_test {

constexpr double kSensorHeight = 1.7;

/// A level road, and a wall across it at 30 m, 6 m high. x forward, z up, from the LiDAR.
PointCloud scan_of_road_and_wall() {
  PointCloud scan;
  for (double elevation = -12; elevation < 9; elevation += 0.4) {
    for (double azimuth = -20; azimuth < 20; azimuth += 0.2) {
      const double e = elevation * kDegree, a = azimuth * kDegree;
      const Eigen::Vector3d ray(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e));
      double range = 30 / ray.x();
      if (ray.z() < 0) range = std::min(range, -kSensorHeight / ray.z());
      scan.position.push_back((range * ray).cast<float>());
    }
  }
  return scan;
}

struct Map {
  std::vector<Eigen::Vector3f> position;
  /// Points every 5 cm on the road from 10 to 30 m.
  void add_road(float height) {
    for (float x = 10; x < 30; x += 0.05f) {
      for (float y = -12; y < 12; y += 0.05f) position.emplace_back(x, y, height);
    }
  }
  void add_wall(float x) {
    for (float y = -12; y < 12; y += 0.05f) {
      for (float z = -float(kSensorHeight); z < 6; z += 0.05f) position.emplace_back(x, y, z);
    }
  }
};

/// Against a photograph that is gray everywhere.
FarField compare(const Map& map, bool draws_map = true) {
  const Camera camera = forward_camera();
  const std::vector<LogColor> color(map.position.size(), to_rgb(Eigen::Vector3f(100, 100, 100)));
  const KdTree tree(map.position);
  Image photograph(camera.width, camera.height, 3);
  std::fill(photograph.data.begin(), photograph.data.end(), std::uint8_t{100});
  SplatView drawn{photograph, {}, std::vector<std::uint8_t>(photograph.data.size() / 3, 1)};
  if (!draws_map) {
    std::fill(drawn.image.data.begin(), drawn.image.data.end(), std::uint8_t{0});
    std::fill(drawn.covered.begin(), drawn.covered.end(), std::uint8_t{0});
  }
  const PointCloud scan = scan_of_road_and_wall();
  return compare_far_field({map.position, color, tree, Eigen::Vector3d::Zero()}, scan, scan,
                           PlacedFrame{}, camera, {photograph, drawn});
}

TEST(FarField, APerfectMapIsCoveredAndHasOneLayer) {
  Map map;
  map.add_road(-float(kSensorHeight));
  map.add_wall(30);
  const FarField field = compare(map);
  EXPECT_GT(field.bands[0].ground.points, 500u);
  EXPECT_EQ(field.bands[0].upright.points, 0u);
  EXPECT_GT(field.bands[1].upright.points, 500u);
  EXPECT_EQ(field.bands[2].ground.points + field.bands[2].upright.points, 0u);
  const FarSums all = field.all();
  EXPECT_EQ(all.covered_5cm, all.points);
  EXPECT_GT(all.flat, all.points / 2);
  EXPECT_EQ(all.double_layer, 0u);
  EXPECT_LT(all.color / double(all.points), 1);
  EXPECT_EQ(field.holes, 0u);
  EXPECT_GT(field.measured, 4000u);
}

TEST(FarField, ASecondLayerIsFound) {
  Map map;
  map.add_road(-float(kSensorHeight));
  map.add_road(-float(kSensorHeight) + 0.2f);
  map.add_wall(30);
  map.add_wall(30.25f);
  const FarField field = compare(map);
  const FarBand &near = field.bands[0], &far = field.bands[1];
  EXPECT_GT(near.ground.flat, 500u);
  EXPECT_EQ(near.ground.double_layer, near.ground.flat);
  EXPECT_GT(far.upright.flat, 500u);
  EXPECT_GT(double(far.upright.double_layer), 0.95 * double(far.upright.flat));
}

TEST(FarField, WhatIsMissingIsNotCoveredAndLeavesHoles) {
  Map map;
  map.add_wall(30.5f);
  const FarField field = compare(map, /*draws_map=*/false);
  EXPECT_EQ(field.all().covered_10cm, 0u);
  EXPECT_EQ(field.holes, field.measured);
  EXPECT_NEAR(field.psnr(), 10 * std::log10(255.0 * 255 / (100 * 100)), 1e-6);
  EXPECT_EQ(field.share_of_holes(), 1);
}

}  // namespace fovea::far_field_test
