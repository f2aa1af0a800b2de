#include "fovea/mapping/calibration/lidar_edges.h"

#include <gtest/gtest.h>

#include <cmath>

#include "fovea/core/angle.h"

namespace fovea::lidar_edges_test {

constexpr double kStep = 0.17 * kDegree, kRing = 0.4 * kDegree;

Camera forward_camera() {
  Camera camera;
  camera.width = 600;
  camera.height = 300;
  camera.fx = camera.fy = 400;
  camera.cx = 300;
  camera.cy = 150;
  camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return camera;
}

/// A board 10 m ahead, from azimuth -4 to +6 and elevation -5 to +3 degrees, in front of a wall at
/// 30 m. Ring after ring, each clockwise.
PointCloud board_before_a_wall() {
  PointCloud scan;
  for (int ring = 0; ring < 40; ++ring) {
    const double elevation = (7.9 * kDegree) - ring * kRing;
    for (int k = 0; k < 200; ++k) {
      const double azimuth = 17 * kDegree - k * kStep;
      const bool board = azimuth > -4 * kDegree && azimuth < 6 * kDegree &&
                         elevation > -5 * kDegree && elevation < 3 * kDegree;
      const Eigen::Vector3d beam(std::cos(azimuth), std::sin(azimuth), std::tan(elevation));
      scan.position.push_back(((board ? 10 : 30) / beam.x() * beam).cast<float>());
    }
  }
  return scan;
}

TEST(LidarEdges, LieOnEitherSideOfAnObjectsEnd) {
  const LidarEdges edges = find_lidar_edges(board_before_a_wall(), forward_camera(), 40);
  ASSERT_EQ(edges.outside.size(), edges.size());
  ASSERT_EQ(edges.between_rings.size(), edges.size());
  int left = 0, right = 0, top = 0, bottom = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Eigen::Vector3f in = edges.inside.position[i], out = edges.outside.position[i];
    EXPECT_NEAR(in.norm(), out.norm(), 1e-4);
    EXPECT_NEAR(in.x(), 10, 1e-3);
    const auto azimuth = [](const Eigen::Vector3f& p) {
      return std::atan2(p.y(), p.x()) / kDegree;
    };
    // The elevation in the scene.
    const auto elevation = [](const Eigen::Vector3f& p) {
      return std::atan(p.z() / p.head<2>().norm()) / kDegree;
    };
    if (edges.between_rings[i] == 0) {
      const double side = azimuth(in) > 1 ? 6 : -4;
      EXPECT_LT((azimuth(in) - side) * (azimuth(out) - side), 0);
      EXPECT_NEAR(azimuth(in), azimuth(out), 0.18);
      (side > 0 ? left : right) += 1;
    } else {
      const double side = elevation(in) > -1 ? 3 : -5;
      EXPECT_LT((elevation(in) - side) * (elevation(out) - side), 0);
      (side > 0 ? top : bottom) += 1;
    }
  }
  EXPECT_EQ(left, 20);  // rings that hit the board
  EXPECT_EQ(right, 20);
  EXPECT_GT(top, 40);  // columns of 0.2 degrees
  EXPECT_NEAR(top, bottom, 3);
}

TEST(LidarEdges, KeepTheTimesOfTheirBeams) {
  PointCloud scan = board_before_a_wall();
  EXPECT_TRUE(find_lidar_edges(scan, forward_camera(), 40).inside.time.empty());
  // The azimuth identifies the beam.
  for (const Eigen::Vector3f& p : scan.position) scan.time.push_back(std::atan2(p.y(), p.x()));
  const LidarEdges edges = find_lidar_edges(scan, forward_camera(), 40);
  ASSERT_GT(edges.size(), 0u);
  for (const PointCloud* beams : {&edges.inside, &edges.outside}) {
    ASSERT_EQ(beams->time.size(), edges.size());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const Eigen::Vector3f& p = beams->position[i];
      EXPECT_NEAR(beams->time[i], std::atan2(p.y(), p.x()), 1e-5);
    }
  }
}

TEST(LidarEdges, NoneBeyondTheReachOrBehindTheCamera) {
  PointCloud scan = board_before_a_wall();
  EXPECT_EQ(find_lidar_edges(scan, forward_camera(), 9).size(), 0u);
  for (Eigen::Vector3f& p : scan.position) p.x() = -p.x();
  EXPECT_EQ(find_lidar_edges(scan, forward_camera(), 40).size(), 0u);
  EXPECT_EQ(find_lidar_edges({}, forward_camera(), 40).size(), 0u);
}

// The ground of a scan jumps from ring to ring by more than half a meter from 13 m on.
TEST(LidarEdges, TheGroundHasNone) {
  PointCloud scan;
  for (int ring = 0; ring < 64; ++ring) {
    const double elevation = (-1.5 - ring / 3.0) * kDegree;
    for (int k = 0; k < 100; ++k) {
      const double azimuth = 8 * kDegree - k * kStep, range = -1.73 / std::tan(elevation);
      scan.position.emplace_back(range * std::cos(azimuth), range * std::sin(azimuth), -1.73);
    }
  }
  EXPECT_EQ(find_lidar_edges(scan, forward_camera(), 40).size(), 0u);
}

// The same for sparse rings, and for a sensor near the ground.
TEST(LidarEdges, TheGroundOfSparseRingsHasNone) {
  for (const double height : {0.4, 1.73}) {
    for (const double spacing : {0.5, 0.7}) {
      PointCloud scan;
      for (double elevation = -0.8; elevation > -20; elevation -= spacing) {
        for (int k = 0; k < 100; ++k) {
          const double azimuth = 8 * kDegree - k * kStep,
                       range = -height / std::tan(elevation * kDegree);
          scan.position.emplace_back(range * std::cos(azimuth), range * std::sin(azimuth), -height);
        }
      }
      const LidarEdges edges = find_lidar_edges(scan, forward_camera(), 40);
      EXPECT_EQ(edges.size(), 0u) << height << ", " << spacing;
      EXPECT_NEAR(edges.ring_spacing, spacing * kDegree, 0.05 * spacing * kDegree);
    }
  }
}

}  // namespace fovea::lidar_edges_test
