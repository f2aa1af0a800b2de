// A box in front of a wall, seen by a LiDAR and by a camera next to it: the visible points are
// known exactly.
#include "fovea/mapping/scan_projection.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace fovea::scan_projection_test {

constexpr double kWall = 12, kBox = 6, kHalf = 0.8;  // m: x of wall and box front, half its size
constexpr double kGround = -1.7;

/// End of a ray from `start` (LiDAR frame): on the thin box (a board), the ground, or the wall.
Eigen::Vector3d trace(const Eigen::Vector3d& start, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d on_box = start + (kBox - start.x()) / ray.x() * ray;
  if (std::abs(on_box.y()) < kHalf && std::abs(on_box.z()) < kHalf) return on_box;
  const Eigen::Vector3d on_wall = start + (kWall - start.x()) / ray.x() * ray;
  if (on_wall.z() >= kGround) return on_wall;
  return start + (kGround - start.z()) / ray.z() * ray;
}

/// 64 rings 0.4 degrees apart, columns 0.17 degrees.
PointCloud scan() {
  PointCloud scan;
  const double degree = std::numbers::pi / 180;
  for (int ring = 0; ring < 64; ++ring) {
    for (double azimuth = -40; azimuth <= 40; azimuth += 0.17) {
      const double elevation = (2 - 0.4 * ring) * degree;
      const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth * degree),
                                std::cos(elevation) * std::sin(azimuth * degree),
                                std::sin(elevation));
      scan.position.push_back(trace(Eigen::Vector3d::Zero(), ray).cast<float>());
    }
  }
  return scan;
}

/// Has KITTI's size and focal length, at `center` (LiDAR frame), along x.
Camera camera_at(const Eigen::Vector3d& center) {
  Camera camera{2, 1242, 375, 721, 721, 609, 172, RigidMotion::Identity()};
  Eigen::Matrix3d R;
  R << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  camera.T_cam_lidar.linear() = R;
  camera.T_cam_lidar.translation() = -R * center;
  return camera;
}

struct Counts {
  int hidden = 0, seen = 0, found = 0, wrong = 0;  // wrong: visible, but classified as hidden
};

Counts judge(const Eigen::Vector3d& center) {
  const PointCloud points = scan();
  const Camera camera = camera_at(center);
  const ScanProjection projection(points, camera);
  Counts counts;
  for (const Eigen::Vector3f& p : points.position) {
    const Eigen::Vector3d p_lidar = p.cast<double>(), p_cam = camera.T_cam_lidar * p_lidar;
    const auto pixel = camera.project(p_cam);
    if (!pixel || !camera.in_view(*pixel)) continue;
    const bool truly = (trace(center, p_lidar - center) - p_lidar).norm() > 0.5;
    const bool said = projection.hidden(*pixel, p_cam.norm());
    (truly ? counts.hidden : counts.seen) += 1;
    if (said) (truly ? counts.found : counts.wrong) += 1;
  }
  return counts;
}

TEST(ScanProjection, FindsThePointsHiddenFromASideCamera) {
  const Counts counts = judge({0.3, 0.4, -0.1});
  EXPECT_GT(counts.hidden, 200);
  EXPECT_GT(counts.found, 0.93 * counts.hidden);
  EXPECT_LT(counts.wrong, 0.01 * counts.seen);  // the rim of the box, a quarter of a degree wide
}

TEST(ScanProjection, ACameraAtTheLidarSeesAllPoints) {
  const Counts counts = judge(Eigen::Vector3d::Zero());
  EXPECT_EQ(counts.hidden, 0);
  EXPECT_LT(counts.wrong, 0.01 * counts.seen);
}

TEST(ScanProjection, TheGroundHidesNothingAndHasNoEdge) {
  PointCloud ground;
  for (int ring = 0; ring < 64; ++ring) {
    const double elevation = (-5 - 0.3 * ring) * std::numbers::pi / 180;
    for (double y = -6; y <= 6; y += 0.03) {
      ground.position.emplace_back(float(kGround / std::tan(elevation)), float(y), float(kGround));
    }
  }
  const Camera camera = camera_at({0.27, 0.06, -0.08});
  const ScanProjection projection(ground, camera);
  for (const Eigen::Vector3f& p : ground.position) {
    if (p.norm() > 15) continue;
    const Eigen::Vector3d p_cam = camera.T_cam_lidar * p.cast<double>();
    const auto pixel = camera.project(p_cam);
    ASSERT_TRUE(pixel);
    EXPECT_FALSE(projection.hidden(*pixel, p_cam.norm())) << p.transpose();
    EXPECT_FALSE(projection.near_edge(*pixel, p_cam.norm())) << p.transpose();
  }
}

TEST(ScanProjection, TheGroundOfTwoLidarsHidesNothing) {
  PointCloud ground;
  for (int ring = 0; ring < 120; ++ring) {  // every other one of the second LiDAR
    const double elevation = (-2 - 0.15 * ring) * std::numbers::pi / 180;
    for (double y = -6; y <= 6; y += 0.05) {
      ground.position.emplace_back(float(kGround / std::tan(elevation)), float(y), float(kGround));
      ground.sensor.push_back(std::uint16_t(ring % 2));
    }
  }
  const Camera camera = camera_at({0.27, 0.06, -0.08});
  const ScanProjection projection(ground, camera);
  int hidden = 0, seen = 0;
  for (std::size_t i = 0; i < ground.size(); ++i) {
    const Eigen::Vector3d p_cam = camera.T_cam_lidar * ground.position[i].cast<double>();
    const auto pixel = camera.project(p_cam);
    if (!pixel || !camera.in_view(*pixel)) continue;
    (projection.hidden(*pixel, p_cam.norm(), ground.sensor[i]) ? hidden : seen) += 1;
  }
  EXPECT_EQ(hidden, 0);
  EXPECT_GT(seen, 1000);
}

TEST(ScanProjection, ABoardThatOneLidarMeasuresHidesThePointsOfAnother) {
  PointCloud points;
  for (double y = -kHalf; y <= kHalf; y += 0.05) {
    for (double z = -kHalf; z <= kHalf; z += 0.05) {
      points.position.emplace_back(float(kBox), float(y), float(z));
      points.sensor.push_back(0);
    }
  }
  const Camera camera = camera_at(Eigen::Vector3d::Zero());
  const ScanProjection projection(points, camera);
  const auto hidden = [&](const Eigen::Vector3d& p_lidar) {
    const Eigen::Vector3d p_cam = camera.T_cam_lidar * p_lidar;
    return projection.hidden(*camera.project(p_cam), p_cam.norm(), /*sensor=*/1);
  };
  EXPECT_TRUE(hidden({kWall, 0.3, -0.5}));
  EXPECT_FALSE(hidden({kWall, 2 * kHalf + 0.2, 0}));
}

TEST(ScanProjection, BothSidesOfAStepAreEdges) {
  PointCloud step;
  for (int i = -50; i <= 50; ++i)
    step.position.emplace_back(i < 0 ? 8.0f : 10.0f, 0.02f * float(i), 0);
  const Camera camera = camera_at(Eigen::Vector3d::Zero());
  const ScanProjection projection(step, camera);
  const auto edge = [&](int i) {
    const Eigen::Vector3d p_cam = camera.T_cam_lidar * step.position[i + 50].cast<double>();
    return projection.near_edge(*camera.project(p_cam), p_cam.norm());
  };
  EXPECT_TRUE(edge(-1));
  EXPECT_TRUE(edge(0));
  EXPECT_TRUE(edge(2));  // 2.9 and 1.4 pixels from the nearest on the other side
  EXPECT_FALSE(edge(-6));
  EXPECT_FALSE(edge(8));
}

}  // namespace fovea::scan_projection_test
