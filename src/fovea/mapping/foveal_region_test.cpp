#include "fovea/foveal_region.h"

#include <gtest/gtest.h>

#include <numbers>

namespace fovea::foveal_region_test {

constexpr double kDegree = std::numbers::pi / 180;

/// A camera at the LiDAR's position, along its x axis, 90 degrees wide.
Camera forward_camera() {
  Camera camera{0, 1001, 801, 500, 500, 500, 400, RigidMotion::Identity()};
  camera.T_cam_lidar.linear() << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  return camera;
}

bool contains(const FovealOptions& options, const Eigen::Vector3f& p_cam,
              const Camera& camera = forward_camera()) {
  Eigen::Vector2f pixel;
  return FovealRegion(options, camera, kOneLidar).contains(p_cam, pixel);
}

TEST(FovealRegion, WhiteZoneLiesBetweenTheBlindZones) {
  EXPECT_FALSE(contains({}, {0, 0, 2.9f}));
  EXPECT_TRUE(contains({}, {0, 0, 3.1f}));
  EXPECT_TRUE(contains({}, {0, 0, 17.9f}));
  EXPECT_FALSE(contains({}, {0, 0, 18.1f}));
}

TEST(FovealRegion, RangeIsMeasuredFromTheLidar) {
  Camera camera = forward_camera();
  camera.T_cam_lidar.translation() =
      Eigen::Vector3d(0, 0, -1);  // the LiDAR is 1 m behind the camera
  EXPECT_TRUE(contains({}, {0, 0, 2.1f}, camera));
  EXPECT_FALSE(contains({}, {0, 0, 17.1f}, camera));
}

TEST(FovealRegion, NothingOutsideTheImageOrBehind) {
  EXPECT_TRUE(contains({}, {4.99f, 0, 5}));
  EXPECT_FALSE(contains({}, {5.01f, 0, 5}));
  EXPECT_FALSE(contains({}, {0, 0, -5}));
  EXPECT_FALSE(contains({}, {0, 0, 0}));
}

TEST(FovealRegion, PixelIsTheProjection) {
  Eigen::Vector2f pixel;
  ASSERT_TRUE(FovealRegion({}, forward_camera(), kOneLidar).contains({1, -2, 5}, pixel));
  EXPECT_NEAR(pixel.x(), 600, 1e-3);
  EXPECT_NEAR(pixel.y(), 200, 1e-3);
}

// The paper's figure: 50 x 10 degrees, tilted down 15.
TEST(FovealRegion, SliceTiltedDown) {
  FovealOptions options;
  options.slices = {{-25 * kDegree, 25 * kDegree, -20 * kDegree, -10 * kDegree}};
  const auto at = [&](double azimuth, double elevation) {
    // Elevation is above the horizontal plane through the camera, azimuth within that plane.
    const double a = azimuth * kDegree, e = elevation * kDegree;
    return contains(options, Eigen::Vector3d(8 * std::cos(e) * std::sin(a), -8 * std::sin(e),
                                             8 * std::cos(e) * std::cos(a))
                                 .cast<float>());
  };
  EXPECT_TRUE(at(0, -15));
  EXPECT_TRUE(at(24.5, -15));
  EXPECT_TRUE(at(-24.5, -10.5));
  EXPECT_FALSE(at(25.5, -15));
  EXPECT_FALSE(at(0, -9.5));
  EXPECT_FALSE(at(0, -20.5));
  EXPECT_FALSE(at(0, 15));
}

TEST(FovealRegion, SlicesAreAUnion) {
  FovealOptions options;
  options.slices = {{-25 * kDegree, 25 * kDegree, -5 * kDegree, 5 * kDegree},
                    {-5 * kDegree, 5 * kDegree, -25 * kDegree, 25 * kDegree}};
  EXPECT_TRUE(contains(options, {3, 0, 8}));
  EXPECT_TRUE(contains(options, {0, 3, 8}));
  EXPECT_FALSE(contains(options, {3, 3, 8}));
}

TEST(FovealPoints, AreTheScansInTheCamerasFrame) {
  PointCloud scan_lidar;
  scan_lidar.origin = {10, 0, 0};
  scan_lidar.position = {{-5, 1, 0}, {-5, 9, 0}, {-20, 0, 0}, {2, 0, -1}};
  scan_lidar.intensity = {1, 2, 3, 4};
  const PointCloud foveal_cam =
      foveal_points(scan_lidar, FovealRegion({}, forward_camera(), kOneLidar));
  EXPECT_EQ(foveal_cam.origin, Eigen::Vector3d::Zero());
  EXPECT_EQ(foveal_cam.intensity, (std::vector<float>{1, 4}));
  ASSERT_EQ(foveal_cam.size(), 2u);
  EXPECT_EQ(foveal_cam.position[0], Eigen::Vector3f(-1, 0, 5));
  EXPECT_EQ(foveal_cam.position[1], Eigen::Vector3f(0, 1, 12));
}

TEST(FovealPoints, ZonesAreThoseOfTheLidarThatMeasured) {
  FovealOptions options;
  options.near_range = 3;
  options.far_range = 18;
  const FovealRegion region(options, forward_camera(), {{0, 0, 0}, {10, 0, 0}});
  PointCloud scan_lidar;
  scan_lidar.position = {{8, 0, 0}, {8, 0, 0}, {25, 0, 0}, {25, 0, 0}};
  scan_lidar.sensor = {0, 1, 0, 1};  // the vehicle in sight of the second LiDAR; in its reach
  scan_lidar.intensity = {1, 2, 3, 4};
  EXPECT_EQ(foveal_points(scan_lidar, region).intensity, (std::vector<float>{1, 4}));
  EXPECT_EQ(region.reach(), 28);
  EXPECT_TRUE(region.may_color({0, 0, 25}, 15));  // of the map: any LiDAR's zone
  EXPECT_FALSE(region.may_color({0, 0, 29}, 15));
}

TEST(LimitIncidence, DropsSurfacesSeenEdgeOn) {
  PointCloud cloud;
  for (const double degrees : {0.0, 30.0, 69.0, 71.0, 89.0}) {
    cloud.position.emplace_back(0.f, 0.f, 10.f);
    cloud.normal.emplace_back(float(std::sin(degrees * kDegree)), 0.f,
                              -float(std::cos(degrees * kDegree)));
  }
  cloud.position.emplace_back(0.f, 3.f, 4.f);
  cloud.normal.emplace_back(0.f, 0.f, 0.f);  // unknown: passes
  EXPECT_EQ(limit_incidence(cloud, 70 * kDegree), 2u);
  ASSERT_EQ(cloud.size(), 4u);
  EXPECT_NEAR(cloud.incidence[1], 30 * kDegree, 1e-5);
  EXPECT_NEAR(cloud.range[1], 10, 1e-6);
  EXPECT_TRUE(std::isnan(cloud.incidence[3]));
  EXPECT_NEAR(cloud.range[3], 5, 1e-6);
}

}  // namespace fovea::foveal_region_test
