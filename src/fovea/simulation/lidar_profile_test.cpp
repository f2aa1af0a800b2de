// The models of LiDARs as they are simulated.
#include <gtest/gtest.h>

#include <cmath>

#include "fovea/simulation/test_lidar.h"

namespace fovea::lidar_profile_test {

using Eigen::Vector3d;
using test::exact;
using test::kHigh;
using test::kLow;
using test::off_walls;
using test::place;
using test::room;
using test::steady;
using Drive = test::LidarDrive;

/// A model's LiDAR, exact unless `noisy`.
LidarOptions lidar_of(LidarModel model, bool noisy = false) {
  LidarOptions options;
  options.dropouts = 0;
  if (!noisy) options.range_noise = options.range_resolution = 0;
  set_model(options, model);
  return options;
}

TEST(LidarProfile, RingsOfEveryModelAreThoseOfItsDataSheet) {
  Drive drive;
  drive.open(room(drive.material(0.4f)));
  for (const LidarDataSheet& sheet : lidar_data_sheets()) {
    if (sheet.rosette) continue;
    LidarOptions options = lidar_of(sheet.model);
    options.columns = 36;
    const SimulatedScan scan = drive.scan(options);
    ASSERT_EQ(scan.points.size(), sheet.elevations.size() * 36) << sheet.name;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const Vector3d p = place(scan.points[i]);
      ASSERT_EQ(scan.truth[i].ring, i / 36);
      ASSERT_NEAR(std::asin(p.z() / p.norm()), sheet.elevations[i / 36], 1e-6) << sheet.name;
    }
  }
}

TEST(LidarProfile, RingsOfAnyElevationCanBeGiven) {
  Drive drive;
  drive.open(room(drive.material(0.4f)));
  LidarOptions options = exact(50);
  options.elevations = {0.3, 0.1, -0.25};
  const SimulatedScan scan = drive.scan(options);
  ASSERT_EQ(scan.points.size(), 150u);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Vector3d p = place(scan.points[i]);
    EXPECT_NEAR(std::asin(p.z() / p.norm()), options.elevations[i / 50], 1e-6);
  }
}

TEST(LidarProfile, FiringsFollowTheModelsRate) {
  for (const double period : {0.05, 0.1, 0.2}) {
    LidarOptions options = lidar_of(LidarModel::kVlp16);
    options.period = period;
    EXPECT_EQ(sweep_columns(options), std::lround(period / 55.296e-6));
    Drive drive;
    drive.open(room(drive.material(0.4f)));
    EXPECT_EQ(drive.scan(options).points.size(), 16u * std::lround(period / 55.296e-6));
    options.columns = 100;
    EXPECT_EQ(sweep_columns(options), 100);
  }
  EXPECT_EQ(sweep_columns(LidarOptions()), 2083);
}

TEST(LidarProfile, NoiseOfEveryModelIsThatOfItsDataSheet) {
  Drive drive;
  drive.open(room(drive.material(0.4f)));
  for (const LidarDataSheet& sheet : lidar_data_sheets()) {
    LidarOptions options = lidar_of(sheet.model, /*noisy=*/true);
    options.columns = sheet.rosette ? 20'000 : 20'000 / int(sheet.elevations.size());
    const SimulatedScan scan = drive.scan(options);
    ASSERT_GT(scan.points.size(), 15'000u) << sheet.name;
    double square = 0;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const double error = place(scan.points[i]).norm() - scan.truth[i].hit_lidar.norm();
      square += error * error / double(scan.points.size());
    }
    // Rounding to the resolution adds a twelfth of its square.
    const double expected = std::hypot(sheet.range_noise, sheet.range_resolution / std::sqrt(12.0));
    EXPECT_NEAR(std::sqrt(square), expected,
                5 * expected / std::sqrt(2 * double(scan.points.size())))
        << sheet.name;
  }
}

TEST(LidarProfile, ANonRepetitivePatternFollowsTheTime) {
  Drive drive;
  drive.open(room(drive.material(0.4f)), steady(11));
  const LidarOptions options = lidar_of(LidarModel::kLivoxAvia);
  const Rosette rosette = *lidar_data_sheet(options.model).rosette;
  const double stamp = 0.7;
  const SimulatedScan scan = drive.scan(options, 1, 7, stamp);
  ASSERT_EQ(scan.points.size(), 24'000u);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const TruthPoint& truth = scan.truth[i];
    const Vector3d p = place(scan.points[i]);
    // The truth has the time in single precision: the beam turns by 1e-5 in that.
    const Eigen::Vector2d angles = rosette_angles(rosette, stamp + truth.time);
    ASSERT_NEAR(std::atan2(p.y(), p.x()), angles.x(), 2e-5);
    ASSERT_NEAR(std::asin(p.z() / p.norm()), angles.y(), 2e-5);
    ASSERT_EQ(truth.ring, 0);
    const Vector3d p_world = drive.T_world_lidar(stamp + truth.time) * p;
    ASSERT_LT(off_walls(p_world, kLow, kHigh), 1e-5);
    if (i > 0) {
      ASSERT_GT(truth.time, scan.truth[i - 1].time);
    }
  }
  EXPECT_NE(drive.scan(options, 1, 8, 0.8).points, scan.points);
}

}  // namespace fovea::lidar_profile_test
