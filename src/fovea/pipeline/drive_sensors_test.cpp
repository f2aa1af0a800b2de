// Profiles of real LiDARs, each by one scan or a few.
#include "fovea/pipeline/drive_sensors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "../../../tests/kitti_sample.h"
#include "fovea/core/angle.h"
#include "fovea/drive/scans/lidar_scan.h"
#include "fovea/mapping/sensor_profile_estimate.h"

namespace fovea::drive_sensors_test {

/// Scans of other sensors, next to those of KITTI; without both, tests are skipped.
#define FOVEA_OTHER_SENSORS_OR_SKIP(variable)                                  \
  FOVEA_KITTI_SAMPLE_OR_SKIP(variable##_sample);                               \
  const std::filesystem::path variable =                                       \
      std::filesystem::weakly_canonical(variable##_sample / "../../../other"); \
  if (!std::filesystem::is_directory(variable)) GTEST_SKIP() << "no scans of other sensors"

SensorProfile of_file(const std::filesystem::path& file) {
  const LidarScan scan = read_lidar_scan(file, {}, 0);
  return estimate_sensor_profile({&scan.points, 1}, {});
}

SensorProfile of_drive(const std::filesystem::path& drive) {
  DriveOptions options;
  options.use_images = false;
  return mounted_lidars(*open_drive(drive, options)).front().profile;
}

/// Expects the elevations of the data sheet.
void expect_rings(const SensorProfile& profile, const std::vector<double>& degrees,
                  double tolerance_degrees) {
  for (const double elevation : profile.ring_elevations) {
    const double found = elevation / kDegree;
    const double nearest = *std::min_element(
        degrees.begin(), degrees.end(),
        [&](double a, double b) { return std::abs(a - found) < std::abs(b - found); });
    EXPECT_NEAR(found, nearest, tolerance_degrees);
  }
}

/// Evenly spaced elevations (degrees), highest first.
std::vector<double> even(double highest, double step, int count) {
  std::vector<double> degrees;
  for (int i = 0; i < count; ++i) degrees.push_back(highest - i * step);
  return degrees;
}

TEST(DriveSensors, VelodyneVlp16) {
  FOVEA_OTHER_SENSORS_OR_SKIP(other);
  const SensorProfile profile = of_file(other / "vlp16.pcd");
  // The lowest ring hits only the vehicle.
  EXPECT_EQ(profile.ring_elevations.size(), 15u);
  expect_rings(profile, even(15, 2, 16), 0.02);
  EXPECT_NEAR(profile.ring_spacing, 2 * kDegree, 0.01 * kDegree);
  EXPECT_NEAR(profile.point_spacing, 0.2 * kDegree, 0.01 * kDegree);
}

TEST(DriveSensors, VelodyneVlp32) {
  FOVEA_OTHER_SENSORS_OR_SKIP(other);
  const SensorProfile profile = of_file(other / "vlp32.pcd");
  EXPECT_EQ(profile.ring_elevations.size(), 32u);
  expect_rings(profile, {15,     10.333, 7,      4.667,  3.333,  2.333,  1.667,   1.333,
                         1,      0.667,  0.333,  0,      -0.333, -0.667, -1,      -1.333,
                         -1.667, -2,     -2.333, -2.667, -3,     -3.333, -3.667,  -4,
                         -4.667, -5.333, -6.148, -7.254, -8.843, -11.31, -15.639, -25},
               0.02);
  EXPECT_NEAR(profile.ring_spacing, 0.333 * kDegree, 0.01 * kDegree);
}

TEST(DriveSensors, HesaiXt32) {
  FOVEA_OTHER_SENSORS_OR_SKIP(other);
  const SensorProfile profile = of_file(other / "xt32.pcd");
  EXPECT_EQ(profile.ring_elevations.size(), 32u);
  expect_rings(profile, even(15, 1, 32), 0.1);  // calibrated angles
  EXPECT_NEAR(profile.ring_spacing, 1 * kDegree, 0.02 * kDegree);
  EXPECT_NEAR(profile.point_spacing, 0.18 * kDegree, 0.01 * kDegree);
}

TEST(DriveSensors, HesaiOt128) {
  FOVEA_OTHER_SENSORS_OR_SKIP(other);
  const SensorProfile profile = of_file(other / "ot128.pcd");
  // The upper rings of this scan have no returns.
  EXPECT_GE(profile.ring_elevations.size(), 100u);
  EXPECT_LE(profile.ring_elevations.size(), 128u);
  EXPECT_NEAR(profile.ring_spacing, 0.125 * kDegree, 0.02 * kDegree);
}

TEST(DriveSensors, HesaiAt128HasAFieldOfViewOf120Degrees) {
  FOVEA_OTHER_SENSORS_OR_SKIP(other);
  const SensorProfile profile = of_file(other / "at128.pcd");
  EXPECT_GE(profile.ring_elevations.size(), 70u);
  EXPECT_LE(profile.ring_elevations.size(), 128u);
  EXPECT_NEAR(profile.ring_spacing, 0.2 * kDegree, 0.01 * kDegree);
}

TEST(DriveSensors, ADriveThatStatesItsRings) {
  FOVEA_OTHER_SENSORS_OR_SKIP(other);
  const SensorProfile hdl32 = of_drive(other / "six-cameras-and-32-rings");
  EXPECT_EQ(hdl32.ring_elevations.size(), 32u);
  expect_rings(hdl32, even(10.667, 1.333, 32), 0.25);  // motion compensated
  EXPECT_NEAR(hdl32.ring_spacing, 1.333 * kDegree, 0.02 * kDegree);
  EXPECT_NEAR(hdl32.height.value_or(0), 1.84, 0.1);  // of the calibration
  const SensorProfile pandar64 = of_drive(other / "camera-and-64-rings");
  EXPECT_EQ(pandar64.ring_elevations.size(), 64u);
  EXPECT_NEAR(pandar64.ring_elevations.front(), 14.88 * kDegree, 0.02 * kDegree);
  EXPECT_NEAR(pandar64.ring_elevations.back(), -24.9 * kDegree, 0.02 * kDegree);
  EXPECT_NEAR(pandar64.ring_spacing, 0.167 * kDegree, 0.01 * kDegree);
}

TEST(DriveSensors, KittisHdl64) {
  FOVEA_KITTI_SAMPLE_OR_SKIP(drive);
  const SensorProfile profile = of_drive(drive);
  EXPECT_EQ(profile.ring_elevations.size(), 64u);
  EXPECT_NEAR(profile.ring_spacing, 0.4 * kDegree, 0.02 * kDegree);
  EXPECT_NEAR(profile.height.value_or(0), 1.73, 0.03);
  EXPECT_GT(profile.range_noise, 0.005);
  EXPECT_LT(profile.range_noise, 0.03);
}

SensorProfile rings(double spacing_degrees) {
  SensorProfile profile;
  profile.height = 1.73;
  for (double degrees = 2; degrees > -24; degrees -= spacing_degrees) {
    profile.ring_elevations.push_back(degrees * kDegree);
  }
  profile.ring_spacing = spacing_degrees * kDegree;
  return profile;
}

TEST(DriveSensors, SettingsFollowFromTheRings) {
  // 64 rings: the settings from KITTI.
  const MapperOptions dense = suited_to(rings(0.4), MapperOptions());
  EXPECT_EQ(dense.surface.max_edge, 0.4);
  EXPECT_EQ(dense.surface.planar_edge, 1.0);
  EXPECT_EQ(row_height_of(rings(0.4)), RangeImage::kLeastRowHeight);
  // Rings 1.5 degrees apart meet the ground at 15 m 3.5 m apart, and a wall there 0.39 m apart.
  const MapperOptions sparse = suited_to(rings(1.5), MapperOptions());
  EXPECT_NEAR(sparse.surface.planar_edge, 1.5 * kDegree * (1.73 + 15 * 15 / 1.73), 1e-9);
  EXPECT_NEAR(sparse.surface.max_edge, 1.2 * 15 * 1.5 * kDegree, 1e-9);
  EXPECT_NEAR(row_height_of(rings(1.5)), 1.1 * 1.5 * kDegree, 1e-9);
  // No edge grows without limit.
  const MapperOptions sparsest = suited_to(rings(6), MapperOptions());
  EXPECT_EQ(sparsest.surface.planar_edge, 4);
  EXPECT_EQ(sparsest.surface.max_edge, 1);
}

TEST(DriveSensors, GivenSettingsStay) {
  MapperOptions given;
  given.surface.max_edge = 0.3;
  given.surface.planar_edge = 0.7;
  const MapperOptions options = suited_to(rings(2), given);
  EXPECT_EQ(options.surface.max_edge, 0.3);
  EXPECT_EQ(options.surface.planar_edge, 0.7);
  DriveInfo drive;
  drive.lidars = {{rings(2)}};
  PaperOptions paper;
  paper.ground.sensor_height = 2.5;
  EXPECT_EQ(suited_to(drive, paper).ground.sensor_height, 2.5);
}

TEST(DriveSensors, HeightAndNoiseComeFromTheProfile) {
  SensorProfile profile = rings(0.4);
  profile.height = 2.2;
  profile.range_noise = 0.05;
  EXPECT_EQ(suited_to(profile, MapperOptions()).refinement.range_noise, 0.05);
  DriveInfo drive;
  drive.lidars = {{profile}};
  EXPECT_EQ(suited_to(drive, PaperOptions()).ground.sensor_height, 2.2);
  // A drive whose LiDAR is not known.
  EXPECT_EQ(suited_to(DriveInfo(), PaperOptions()).ground.sensor_height, kUsualSensorHeight);
}

TEST(DriveSensors, TheSparsestOfSeveralLidarsSetsTheEdges) {
  DriveInfo drive;
  drive.lidars = {{rings(0.4)}, {rings(1.5)}};
  drive.lidars[0].profile.range_noise = 0.05;
  const MapperOptions both = suited_to(drive, MapperOptions());
  EXPECT_EQ(both.surface.max_edge, suited_to(rings(1.5), MapperOptions()).surface.max_edge);
  EXPECT_EQ(both.refinement.range_noise, 0.05);
}

}  // namespace fovea::drive_sensors_test
