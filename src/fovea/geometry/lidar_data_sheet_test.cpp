#include "fovea/geometry/lidar_data_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fovea/core/angle.h"
#include "fovea/errors.h"

namespace fovea::lidar_data_sheet_test {

/// Elevations in degrees.
std::vector<double> rings_of(LidarModel model) {
  std::vector<double> degrees = lidar_data_sheet(model).elevations;
  for (double& elevation : degrees) elevation /= kDegree;
  return degrees;
}

void expect_even(LidarModel model, std::size_t count, double highest, double lowest) {
  const std::vector<double> rings = rings_of(model);
  ASSERT_EQ(rings.size(), count);
  const double step = (highest - lowest) / double(count - 1);
  for (std::size_t i = 0; i < count; ++i) EXPECT_NEAR(rings[i], highest - double(i) * step, 1e-12);
}

TEST(LidarDataSheet, RingsAreThoseOfTheDataSheets) {
  expect_even(LidarModel::kVlp16, 16, 15, -15);
  expect_even(LidarModel::kXt32, 32, 15, -16);
  expect_even(LidarModel::kOs1_64, 64, 22.5, -22.5);
  expect_even(LidarModel::kOs1_128, 128, 22.5, -22.5);

  // The manual rounds to a hundredth.
  const std::vector<double> hdl32 = rings_of(LidarModel::kHdl32);
  ASSERT_EQ(hdl32.size(), 32u);
  EXPECT_NEAR(hdl32[0], 10.67, 0.005);
  EXPECT_EQ(hdl32[8], 0);
  EXPECT_NEAR(hdl32[9], -1.33, 0.005);
  EXPECT_NEAR(hdl32[31], -30.67, 0.005);

  const std::vector<double> hdl64 = rings_of(LidarModel::kHdl64);
  ASSERT_EQ(hdl64.size(), 64u);
  EXPECT_NEAR(hdl64[0], 2, 1e-12);
  EXPECT_NEAR(hdl64[31], 2 - 31 / 3.0, 1e-12);
  EXPECT_NEAR(hdl64[32], -8.83, 1e-12);
  EXPECT_NEAR(hdl64[63], -24.33, 1e-12);
}

TEST(LidarDataSheet, PandarsRingsAreDenseInTheMiddle) {
  const std::vector<double> rings = rings_of(LidarModel::kPandar64);
  ASSERT_EQ(rings.size(), 64u);
  // The nominal channels: 15, 11, 8, 5, 3, then 2 to -6 by a sixth, -7 to -14 by 1, -19, -25.
  std::vector<double> nominal{15, 11, 8, 5, 3};
  for (int i = 0; i <= 48; ++i) nominal.push_back(2 - i / 6.0);
  for (int i = 7; i <= 14; ++i) nominal.push_back(-i);
  nominal.insert(nominal.end(), {-19, -25});
  ASSERT_EQ(nominal.size(), 64u);
  for (std::size_t i = 0; i < 64; ++i) EXPECT_NEAR(rings[i], nominal[i], 0.13) << i;
}

TEST(LidarDataSheet, EveryModelIsComplete) {
  const std::vector<std::string> names = lidar_model_names();
  EXPECT_THAT(names, testing::ElementsAre("hdl64", "hdl32", "vlp16", "os1-64", "os1-128",
                                          "pandar64", "xt32", "livox-avia", "livox-hap"));
  for (const std::string& name : names) {
    const LidarDataSheet& sheet = lidar_data_sheet(parse_lidar_model(name));
    EXPECT_EQ(sheet.name, name);
    EXPECT_FALSE(sheet.product.empty());
    EXPECT_TRUE(std::is_sorted(sheet.elevations.rbegin(), sheet.elevations.rend())) << name;
    EXPECT_EQ(std::adjacent_find(sheet.elevations.begin(), sheet.elevations.end()),
              sheet.elevations.end());
    EXPECT_EQ(sheet.elevations.size() == 1, sheet.rosette.has_value()) << name;
    EXPECT_GE(sheet.firing_rate * sheet.period, 1000) << name;
    EXPECT_LT(sheet.min_range, sheet.max_range) << name;
    EXPECT_GE(sheet.range_noise, 0.005) << name;
    EXPECT_LE(sheet.range_noise, 0.03) << name;
    EXPECT_LE(sheet.dark_range, sheet.max_range) << name;
  }
  EXPECT_THROW(parse_lidar_model("radar"), ConfigError);
}

TEST(LidarDataSheet, VelodynesTurnByAFifthOfADegree) {
  const LidarDataSheet& vlp16 = lidar_data_sheet(LidarModel::kVlp16);
  EXPECT_NEAR(360 / (vlp16.firing_rate * vlp16.period), 0.2, 0.001);
  EXPECT_NEAR(vlp16.firing_rate * 16, 300e3, 15e3);  // points a second
}

TEST(LidarDataSheet, RosettesFillTheirFieldOfViewAndDoNotRepeat) {
  const Rosette rosette{1.2, 0.4};
  double widest = 0, highest = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Eigen::Vector2d angles = rosette_angles(rosette, i * 1e-5);
    const double radius = std::hypot(angles.x() / 0.6, angles.y() / 0.2);
    EXPECT_LE(radius, 1 + 1e-12);
    widest = std::max(widest, std::abs(angles.x()));
    highest = std::max(highest, std::abs(angles.y()));
  }
  EXPECT_NEAR(widest, 0.6, 1e-3);
  EXPECT_NEAR(highest, 0.2, 1e-3);
  // A tenth of a second later the beam is elsewhere.
  double apart = 0;
  for (int i = 0; i < 1000; ++i) {
    apart += (rosette_angles(rosette, i * 1e-4 + 0.1) - rosette_angles(rosette, i * 1e-4)).norm();
  }
  EXPECT_GT(apart / 1000, 0.05);
}

}  // namespace fovea::lidar_data_sheet_test
