#include "fovea/mapping/calibration/edge_profiles.h"

#include <gtest/gtest.h>

#include <cmath>

namespace fovea::edge_profiles_test {

Camera forward_camera() {
  Camera camera;
  camera.width = 400;
  camera.height = 300;
  camera.fx = camera.fy = 500;
  camera.cx = 200;
  camera.cy = 150;
  camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  camera.T_cam_lidar.translation() = Eigen::Vector3d(0.06, -0.08, -0.27);
  return camera;
}

Eigen::Vector3d at_pixel(const Camera& camera, double u, double v, double depth) {
  const Eigen::Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
  return camera.T_cam_lidar.inverse() * (depth * ray);
}

/// Edges of an object that ends along u = end + slope * (v - 150), each between beams `gap` apart.
LidarEdges upright_edges(const Camera& camera, double end, double gap, double slope) {
  LidarEdges edges;
  for (int v = 120; v <= 180; v += 4) {
    const double u = end + slope * (v - 150);
    edges.inside.position.push_back(at_pixel(camera, u - gap / 2, v, 10).cast<float>());
    edges.outside.position.push_back(at_pixel(camera, u + gap / 2, v, 10).cast<float>());
    edges.between_rings.push_back(0);
  }
  return edges;
}

/// Dark left of the line u = end + slope * (v - 150), bright right of it, and blurred by a pixel.
Image half_bright(double end, double slope) {
  Image image(400, 300, 3);
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const double past = std::clamp(u - end - slope * (v - 150) + 0.5, 0.0, 1.0);
      for (int c = 0; c < 3; ++c) image.pixel(u, v)[c] = std::uint8_t(40 + 160 * past);
    }
  }
  return image;
}

double center_of(const EdgeProfile& profile) {
  double sum = 0, moment = 0;
  for (int k = 0; k < EdgeProfile::kSize; ++k) {
    sum += profile.strength[std::size_t(k)];
    moment += double(profile.strength[std::size_t(k)]) * (k - EdgeProfile::kReach);
  }
  return moment / sum;
}

TEST(EdgeProfiles, ShowHowFarOffTheImagesEdgeLies) {
  const Camera camera = forward_camera();
  for (const double slope : {0.0, 0.5}) {
    const auto profiles = edge_profiles(upright_edges(camera, 180, 3, slope),
                                        half_bright(185.5, slope), {.camera = camera, .frame = 7});
    ASSERT_EQ(profiles.size(), 16u);
    const double facing =
        1 / std::hypot(1, slope);  // of the line's normal and the direction outwards
    for (const EdgeProfile& profile : profiles) {
      EXPECT_EQ(profile.frame, 7);
      EXPECT_NEAR(center_of(profile), 5.5 * facing, 0.15);
      EXPECT_NEAR(profile.half_gap, 1.5 * facing, 0.01);
    }
  }
}

// Along a line that crosses each ring once, neighbors are as far apart as the rings.
TEST(EdgeProfiles, RingsMayBeSparse) {
  const Camera camera = forward_camera();
  LidarEdges edges;
  constexpr double kSpacing = 0.04;  // rad: 20 pixels, and 14 pixels reach of dense rings
  for (int ring = -3; ring <= 3; ++ring) {
    const double v = 150 + ring * kSpacing * camera.fy;
    edges.inside.position.push_back(at_pixel(camera, 179, v, 10).cast<float>());
    edges.outside.position.push_back(at_pixel(camera, 181, v, 10).cast<float>());
    edges.between_rings.push_back(0);
  }
  EXPECT_TRUE(edge_profiles(edges, half_bright(185.5, 0), {.camera = camera}).empty());
  edges.ring_spacing = kSpacing;
  const auto profiles = edge_profiles(edges, half_bright(185.5, 0), {.camera = camera});
  ASSERT_EQ(profiles.size(), 5u);  // those with a ring above and one below
  for (const EdgeProfile& profile : profiles) EXPECT_NEAR(center_of(profile), 5.5, 0.15);
}

TEST(EdgeProfiles, KnowHowTheyMoveWithTheCalibration) {
  Camera camera = forward_camera();
  camera.image_delay = 0.01;
  const Twist velocity = (Twist() << 0.02, -0.05, 0.3, 9, 0.2, -0.1).finished();
  const double end = 300;
  const auto place = [&](const Camera& c, const Eigen::Vector3d& p) {
    return c.project(c.at_image(SweepMotion{velocity}).T_cam_lidar * p).value();
  };
  const LidarEdges edges = upright_edges(camera.at_image(SweepMotion{velocity}), end, 3, 0.05);
  const auto profiles =
      edge_profiles(edges, half_bright(end, 0.05), {.camera = camera, .velocity = velocity});
  ASSERT_EQ(profiles.size(), edges.size());
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    const Eigen::Vector3d p =
        0.5 * (edges.inside.position[i] + edges.outside.position[i]).cast<double>();
    for (int k = 0; k < kCalibrationSize; ++k) {
      constexpr double kSmall = 1e-5;
      const CalibrationVector step = kSmall * CalibrationVector::Unit(k);
      // The correction is in the camera's axes, at any pose of the vehicle.
      const Camera moved = corrected(camera, correction_of(step.cwiseQuotient(calibration_unit())));
      const Eigen::Vector2d expected = (place(moved, p) - place(camera, p)) / kSmall;
      const Eigen::Vector2d found = profiles[i].J.col(k).cast<double>();
      EXPECT_LT((found - expected).norm(), 0.01 * (expected.norm() + 1)) << k;
    }
    // Outwards is to the right.
    EXPECT_NEAR(profiles[i].J_along[0], profiles[i].J(0, 0), 0.05 * std::abs(profiles[i].J(1, 0)));
    EXPECT_EQ(profiles[i].J_along[kShiftAlongRing], 1);
    EXPECT_EQ(profiles[i].J_along[kShiftBetweenRings], 0);
  }
}

TEST(EdgeProfiles, OnlyWhereNeighborsFormALine) {
  const Camera camera = forward_camera();
  const Image image = half_bright(185, 0);
  LidarEdges lone;
  lone.inside.position = {at_pixel(camera, 180, 150, 10).cast<float>()};
  lone.outside.position = {at_pixel(camera, 183, 150, 10).cast<float>()};
  lone.between_rings = {0};
  EXPECT_TRUE(edge_profiles(lone, image, {.camera = camera}).empty());
  EXPECT_TRUE(edge_profiles({}, image, {.camera = camera}).empty());
  // Too near to the border for a profile.
  EXPECT_TRUE(edge_profiles(upright_edges(camera, 20, 3, 0), image, {.camera = camera}).empty());
}

TEST(EdgeProfiles, AStandingVehicleShowsNoDelay) {
  const Camera camera = forward_camera();
  const auto profiles =
      edge_profiles(upright_edges(camera, 180, 3, 0), half_bright(180, 0), {.camera = camera});
  ASSERT_FALSE(profiles.empty());
  for (const EdgeProfile& profile : profiles) {
    EXPECT_EQ(profile.J.col(kCamDelay).norm(), 0);
    EXPECT_EQ(profile.J_along[kCamDelay], 0);
  }
}

// The same edges, seen a meter later, are of the same objects.
TEST(EdgeProfiles, KnowTheirPlace) {
  const Camera camera = forward_camera();
  EdgeView here{.camera = camera}, there{.camera = camera};
  here.T_local_lidar.translation() = Eigen::Vector3d(100.5, -7, 3);
  there.T_local_lidar.translation() = Eigen::Vector3d(101.5, -7, 3);
  LidarEdges edges = upright_edges(camera, 180, 3, 0);
  const Image image = half_bright(180, 0);
  const auto first = edge_profiles(edges, image, here);
  for (auto* cloud : {&edges.inside, &edges.outside}) {
    for (Eigen::Vector3f& p : cloud->position) p.x() -= 1;
  }
  const auto second = edge_profiles(edges, image, there);
  ASSERT_EQ(first.size(), second.size());
  ASSERT_FALSE(first.empty());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].place, second[i].place);
  // 10 m ahead of the camera, which is 0.27 m in front of the LiDAR.
  EXPECT_EQ(first.front().place[0], 55);
}

}  // namespace fovea::edge_profiles_test
