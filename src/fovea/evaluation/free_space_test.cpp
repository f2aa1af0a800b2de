#include "fovea/evaluation/free_space.h"

#include <gtest/gtest.h>

#include "fovea/evaluation/test_scene.h"

namespace fovea::free_space_test {

constexpr double kDegree = std::numbers::pi / 180;

Eigen::Vector3f from_polar(double azimuth, double elevation, double range) {
  return Eigen::Vector3d(range * std::cos(elevation) * std::cos(azimuth),
                         range * std::cos(elevation) * std::sin(azimuth),
                         range * std::sin(elevation))
      .cast<float>();
}

ColoredPoints map_of(const std::vector<Eigen::Vector3f>& points,
                     const Eigen::Vector3d& origin = Eigen::Vector3d::Zero()) {
  ColoredPoints map;
  map.origin = origin;
  map.position = points;
  map.color.resize(points.size());
  map.runs = make_runs(points, 4);
  return map;
}

FreeSpaceTest::Result test_points(const std::vector<Eigen::Vector3f>& points,
                                  const std::vector<Eigen::Vector3f>& returns,
                                  const Camera& camera = forward_camera()) {
  const ColoredPoints map = map_of(points);
  FreeSpaceTest test(map);
  PointCloud scan;
  scan.position = returns;
  test.add_scan(scan, RigidMotion::Identity(), {camera});
  return test.result();
}

/// Wall at x = 10.
std::vector<Eigen::Vector3f> wall() {
  std::vector<Eigen::Vector3f> returns = WallScene::scan(RigidMotion::Identity(), 1).position;
  for (Eigen::Vector3f& p : returns) p *= 10 / p.x();
  return returns;
}

TEST(FreeSpace, APoint30CentimetresBeforeAWallViolatesOneAt10DoesNot) {
  const FreeSpaceTest::Result before = test_points({{9.7f, 0, 0}}, wall());
  EXPECT_EQ(before.tested, 1u);
  EXPECT_EQ(before.violating, 1u);
  const FreeSpaceTest::Result near = test_points({{9.9f, 0, 0}}, wall());
  EXPECT_EQ(near.tested, 1u);
  EXPECT_EQ(near.violating, 0u);
}

TEST(FreeSpace, PointsOnAndBehindTheWallDoNotViolate) {
  const FreeSpaceTest::Result result = test_points({{10, 1, 0}, {10.1f, 0, 0}, {13, 0, 1}}, wall());
  EXPECT_EQ(result.tested, 3u);
  EXPECT_EQ(result.violating, 0u);
  EXPECT_EQ(result.share(), 0);
}

TEST(FreeSpace, APointAtAnEdgeWhereSomeReturnIsNearerDoesNotViolate) {
  std::vector<Eigen::Vector3f> returns = wall();
  returns.push_back(from_polar(0.35 * kDegree, 0, 5));  // a post's edge
  EXPECT_EQ(test_points({from_polar(0, 0, 5.1)}, returns).violating, 0u);
  EXPECT_EQ(test_points({from_polar(-0.1 * kDegree, 0, 5.1)}, returns).violating, 1u);
}

TEST(FreeSpace, PointsWithoutAReturnNearTheirRayAreNotTested) {
  const std::vector<Eigen::Vector3f> returns = {from_polar(0, 0, 10)};
  EXPECT_EQ(test_points({from_polar(0.41 * kDegree, 0, 8)}, returns).tested, 0u);
  EXPECT_EQ(test_points({from_polar(0, 0.41 * kDegree, 8)}, returns).tested, 0u);
  EXPECT_EQ(test_points({from_polar(0.39 * kDegree, 0, 8)}, returns).violating, 1u);
  EXPECT_TRUE(std::isnan(test_points({from_polar(0.1, 0, 8)}, returns).share()));
}

TEST(FreeSpace, OnlyReturnsAboveAndBelowEncloseAViolation) {
  const auto enclosed = [](const std::vector<Eigen::Vector3f>& returns) {
    const FreeSpaceTest::Result result = test_points({from_polar(0, 0, 8)}, returns);
    EXPECT_EQ(result.violating, 1u);
    return result.enclosed;
  };
  const Eigen::Vector3f above = from_polar(0, 0.3 * kDegree, 10);
  EXPECT_EQ(enclosed({above, from_polar(0, -0.6 * kDegree, 10)}), 1u);
  EXPECT_EQ(enclosed({above}), 0u);
  EXPECT_EQ(enclosed({above, from_polar(0, -0.8 * kDegree, 10)}), 0u);
  EXPECT_EQ(enclosed({above, from_polar(0, -0.6 * kDegree, 8)}), 0u);  // what it is part of
}

TEST(FreeSpace, GroundBetweenTwoRingsIsNotEnclosed) {
  // Rings 0.65 degrees apart, as where an HDL-64E's two blocks of lasers meet.
  constexpr double kHeight = 1.73;  // m
  const auto on_ground = [&](double azimuth, double below) {
    return from_polar(azimuth, -below, kHeight / std::sin(below));
  };
  std::vector<Eigen::Vector3f> returns, ground;
  for (int i = -40; i <= 40; ++i) {
    const double azimuth = 0.17 * i * kDegree;
    for (const double below : {7.65, 8.3}) returns.push_back(on_ground(azimuth, below * kDegree));
    ground.push_back(on_ground(azimuth / 2, 7.88 * kDegree));
  }
  const FreeSpaceTest::Result result = test_points(ground, returns);
  EXPECT_EQ(result.tested, ground.size());
  EXPECT_GT(result.share(), 0.9);
  EXPECT_EQ(result.enclosed_share(), 0);
}

TEST(FreeSpace, BeamsWithoutReturnSayNothing) {
  EXPECT_EQ(test_points({{8, 0, 0}}, {{0, 0, 0}}).tested, 0u);
}

TEST(FreeSpace, OnlyPointsInRangeAndInViewAreTested) {
  const std::vector<Eigen::Vector3f> returns = {{20, 0, 0}, {-20, 0, 0}};
  const FreeSpaceTest::Result result =
      test_points({{2.9f, 0, 0}, {3.1f, 0, 0}, {14.9f, 0, 0}, {15.1f, 0, 0}, {-8, 0, 0}}, returns);
  EXPECT_EQ(result.tested, 2u);
  EXPECT_EQ(result.violating, 2u);
}

TEST(FreeSpace, AViolationThatALaterScanEnclosesIsEnclosed) {
  const ColoredPoints map = map_of({{8, 0, 0}});
  FreeSpaceTest test(map);
  PointCloud above, around;
  above.position = {from_polar(0, 0.2 * kDegree, 20)};
  around.position = {from_polar(0, 0.2 * kDegree, 20), from_polar(0, -0.2 * kDegree, 20)};
  for (const auto& [scan, enclosed] : {std::pair(&above, 0u), std::pair(&around, 1u)}) {
    test.add_scan(*scan, RigidMotion::Identity(), {forward_camera()});
    EXPECT_EQ(test.result().violating, 1u);
    EXPECT_EQ(test.result().enclosed, enclosed);
  }
}

TEST(FreeSpace, AViolationInAnyScanCountsOnce) {
  const ColoredPoints map = map_of({{-92, 0, 0}, {-92, 0.5f, 0}}, {100, 0, 0});
  FreeSpaceTest test(map);
  PointCloud blocked, open;
  blocked.position = {{8, 0, 0}, {8, 0.5f, 0}};
  open.position = {{20, 0, 0}};
  for (const PointCloud* scan : {&blocked, &open, &blocked, &open}) {
    test.add_scan(*scan, RigidMotion::Identity(), {forward_camera()});
  }
  EXPECT_EQ(test.result().tested, 2u);
  EXPECT_EQ(test.result().violating, 1u);
  EXPECT_DOUBLE_EQ(test.result().share(), 0.5);
}

TEST(FreeSpace, AgreesWithTheDefinitionInEveryDirection) {
  // Cameras that look up, back (where azimuth wraps) and down; checked against all pairs.
  const std::vector<Eigen::AngleAxisd> turns = {{0.0, Eigen::Vector3d::UnitX()},
                                                {std::numbers::pi, Eigen::Vector3d::UnitZ()},
                                                {-std::numbers::pi / 2, Eigen::Vector3d::UnitY()},
                                                {std::numbers::pi / 2, Eigen::Vector3d::UnitY()}};
  Random random(3);
  for (const Eigen::AngleAxisd& turn : turns) {
    const Eigen::Matrix3d R = turn.toRotationMatrix();
    Camera camera = forward_camera();
    camera.T_cam_lidar = camera.T_cam_lidar * RigidMotion(R.transpose());
    const auto random_point = [&](double near, double far) {
      const Eigen::Vector3f p = from_polar(random.uniform(-0.25, 0.25), random.uniform(-0.2, 0.2),
                                           random.uniform(near, far));
      return Eigen::Vector3f(R.cast<float>() * p);
    };
    std::vector<Eigen::Vector3f> points, returns;
    for (int i = 0; i < 1500; ++i) points.push_back(random_point(3.5, 14));
    for (int i = 0; i < 3000; ++i) returns.push_back(random_point(3, 30));
    std::size_t tested = 0, violating = 0, enclosed = 0;
    for (const Eigen::Vector3f& p : points) {
      bool seen = false, in_front_of_all = true, in_front_of_wide = true;
      bool above = false, below = false;
      for (const Eigen::Vector3f& q : returns) {
        const double angle = std::atan2(p.cast<double>().cross(q.cast<double>()).norm(),
                                        p.cast<double>().dot(q.cast<double>()));
        const bool in_front = q.norm() > p.norm() + 0.2f;
        if (angle > 0.7 * kDegree) continue;
        in_front_of_wide &= in_front;
        (q.z() / q.norm() > p.z() / p.norm() ? above : below) = true;
        if (angle > 0.4 * kDegree) continue;
        seen = true;
        in_front_of_all &= in_front;
      }
      tested += seen;
      violating += seen && in_front_of_all;
      enclosed += seen && in_front_of_wide && above && below;
    }
    const FreeSpaceTest::Result result = test_points(points, returns, camera);
    EXPECT_GT(tested, 500u);
    EXPECT_EQ(result.tested, tested);
    EXPECT_EQ(result.violating, violating);
    EXPECT_GT(enclosed, 20u);
    EXPECT_EQ(result.enclosed, enclosed);
  }
}

TEST(FreeSpace, RaysBeginAtTheLidarThatMeasured) {
  // The second LiDAR is 8 m to the left. A point between the first one and the wall is not in its
  // rays, and one on its own ray is not in those of the first one.
  std::vector<MountedLidar> lidars(2);
  lidars[1].T_lidar_sensor.translation().y() = 8;
  PointCloud scan;
  scan.position = {{10, 8, 0}};
  scan.sensor = {1};
  const ColoredPoints map = map_of({{5, 4, 0}, {5, 8, 0}});
  FreeSpaceTest test(map);
  test.add_scan(scan, RigidMotion::Identity(), /*cameras=*/{}, lidars);
  EXPECT_EQ(test.tested(), (std::vector<std::uint8_t>{0, 1}));
  EXPECT_EQ(test.result().violating, 1u);
}

}  // namespace fovea::free_space_test
