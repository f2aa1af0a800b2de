#include "fovea/mapping/sensor_profile_estimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "fovea/core/angle.h"
#include "fovea/core/random.h"
#include "fovea/geometry/lidar_data_sheet.h"
#include "fovea/mapping/registration/test_scenes.h"

namespace fovea::sensor_profile_estimate_test {

constexpr double kNoise = 0.03;  // m
constexpr double kColumn = 2 * std::numbers::pi / 900;

/// Sixteen rings above a floor, ring after ring.
PointCloud scan(std::uint64_t seed, const std::vector<double>& elevations) {
  PointCloud cloud;
  cloud.position =
      test::ring_scan(test::open_place(), RigidMotion::Identity(), elevations, seed, kNoise);
  return cloud;
}

void expect_sixteen_rings(const SensorProfile& profile) {
  // In an open place the upper eight rings hit only the boxes; all have returns.
  const std::vector<double> truth = test::sixteen_rings();
  ASSERT_GE(profile.ring_elevations.size(), 8u);
  for (const double elevation : profile.ring_elevations) {
    const double nearest = *std::min_element(truth.begin(), truth.end(), [&](double a, double b) {
      return std::abs(a - elevation) < std::abs(b - elevation);
    });
    EXPECT_NEAR(elevation, nearest, 0.01 * kDegree);
  }
  EXPECT_TRUE(std::is_sorted(profile.ring_elevations.rbegin(), profile.ring_elevations.rend()));
  EXPECT_NEAR(profile.ring_spacing, 2 * kDegree, 0.02 * kDegree);
  EXPECT_NEAR(profile.point_spacing, kColumn, 0.02 * kColumn);
  EXPECT_NEAR(profile.range_noise, kNoise, 0.15 * kNoise);
  ASSERT_TRUE(profile.height.has_value());
  EXPECT_NEAR(*profile.height, 1.7, 0.03);
}

TEST(SensorProfileEstimate, OfScansRingByRing) {
  const std::vector<PointCloud> scans{scan(1, test::sixteen_rings()),
                                      scan(2, test::sixteen_rings())};
  expect_sixteen_rings(estimate_sensor_profile(scans, {}));
}

TEST(SensorProfileEstimate, OfScansInAnyOrderByTheirElevations) {
  PointCloud shuffled = scan(3, test::sixteen_rings());
  Random random(1);
  for (std::size_t i = shuffled.size(); i > 1; --i) {
    std::swap(shuffled.position[i - 1], shuffled.position[random.below(i)]);
  }
  expect_sixteen_rings(estimate_sensor_profile({&shuffled, 1}, {}));
}

TEST(SensorProfileEstimate, OfAColumnOfRings) {
  // Scattered elevations, as in a motion-compensated scan: only the column identifies rings.
  PointCloud cloud;
  Random random(1);
  for (int column = 0; column < 900; ++column) {
    for (int ring = 0; ring < 8; ++ring) {
      const double azimuth = column * kColumn;
      const double elevation = (2 - ring + 0.6 * (random.uniform() - 0.5)) * kDegree;
      cloud.position.emplace_back(20 * std::cos(azimuth) * std::cos(elevation),
                                  20 * std::sin(azimuth) * std::cos(elevation),
                                  20 * std::sin(elevation));
      cloud.ring.push_back(static_cast<std::uint16_t>(ring));
    }
  }
  const SensorProfile profile = estimate_sensor_profile({&cloud, 1}, {});
  ASSERT_EQ(profile.ring_elevations.size(), 8u);
  for (int ring = 0; ring < 8; ++ring) {
    EXPECT_NEAR(profile.ring_elevations[std::size_t(ring)], (2 - ring) * kDegree, 0.05 * kDegree);
  }
}

TEST(SensorProfileEstimate, WithoutRingsSpacingIsThatOfPoints) {
  // 20,000 directions at random in a field of view of 70 x 60 degrees.
  PointCloud cloud;
  Random random(4);
  for (int i = 0; i < 20'000; ++i) {
    const double azimuth = 70 * kDegree * (random.uniform() - 0.5);
    const double elevation = std::asin(std::sin(30 * kDegree) * (2 * random.uniform() - 1));
    cloud.position.emplace_back(15 * std::cos(azimuth) * std::cos(elevation),
                                15 * std::sin(azimuth) * std::cos(elevation),
                                15 * std::sin(elevation));
  }
  const SensorProfile profile = estimate_sensor_profile({&cloud, 1}, {});
  EXPECT_TRUE(profile.ring_elevations.empty());
  const double solid_angle = 70 * kDegree * 2 * std::sin(30 * kDegree);
  EXPECT_NEAR(profile.point_spacing, std::sqrt(solid_angle / 20'000), 0.05 * profile.point_spacing);
}

TEST(SensorProfileEstimate, ARosetteHasNoRings) {
  // Fields of view of 70 and 120 degrees, point after point.
  for (const auto& [width, height] : {std::pair(70.4, 77.2), std::pair(120.0, 25.0)}) {
    PointCloud cloud;
    for (int i = 0; i < 24'000; ++i) {
      const Eigen::Vector2d angles =
          rosette_angles({width * kDegree, height * kDegree}, 0.1 * i / 24'000);
      cloud.position.emplace_back(15 * std::cos(angles[0]) * std::cos(angles[1]),
                                  15 * std::sin(angles[0]) * std::cos(angles[1]),
                                  15 * std::sin(angles[1]));
    }
    EXPECT_TRUE(estimate_sensor_profile({&cloud, 1}, {}).ring_elevations.empty()) << width;
  }
}

TEST(SensorProfileEstimate, UpsideDownItIsAsHigh) {
  PointCloud turned = scan(5, test::sixteen_rings());
  for (Eigen::Vector3f& p : turned.position) p = {p.x(), -p.y(), -p.z()};
  const SensorProfile profile = estimate_sensor_profile({&turned, 1}, {});
  ASSERT_TRUE(profile.height.has_value());
  EXPECT_NEAR(*profile.height, 1.7, 0.03);
}

TEST(SensorProfileEstimate, WithoutScansIsTheStatedOne) {
  SensorProfile stated;
  stated.name = "front";
  EXPECT_EQ(estimate_sensor_profile({}, stated), stated);
  const PointCloud empty;
  EXPECT_EQ(estimate_sensor_profile({&empty, 1}, stated), stated);
}

TEST(SensorProfile, RingGapOnTheGroundIsTheDistanceOfItsCircles) {
  SensorProfile profile;
  profile.height = 2;
  for (const double degrees : {2.0, -4.0, -5.0, -6.0, -9.0}) {
    profile.ring_elevations.push_back(degrees * kDegree);
  }
  // Rings at -5 and -6 degrees meet the ground at 22.9 and 19.0 m.
  const double near = 2 / std::tan(6 * kDegree), far = 2 / std::tan(5 * kDegree);
  EXPECT_NEAR(ring_gap_on_ground(profile, (near + far) / 2), far - near, 0.02 * (far - near));
  EXPECT_NEAR(ring_spacing_at(profile, -5.5 * kDegree), 1 * kDegree, 1e-12);
  EXPECT_NEAR(ring_spacing_at(profile, 30 * kDegree), 6 * kDegree, 1e-12);
  EXPECT_NEAR(ring_spacing_at(profile, -30 * kDegree), 3 * kDegree, 1e-12);
}

}  // namespace fovea::sensor_profile_estimate_test
