#include "fovea/simulation/lidar_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fovea/core/angle.h"
#include "fovea/core/parallel.h"
#include "fovea/deskew.h"
#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/test_lidar.h"

namespace fovea::lidar_model_test {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kTurn = 2 * std::numbers::pi;

using test::exact;
using test::kHigh;
using test::kLow;
using test::off_walls;
using test::place;
using test::room;
using test::steady;
using Drive = test::LidarDrive;

TEST(LidarModel, EveryBeamMeetsTheRoomWhereItIs) {
  Drive drive;
  drive.open(room(drive.material(0.4f)), steady(11));
  const LidarOptions options = exact(300);
  const double stamp = 0.7;
  const SimulatedScan scan = drive.scan(options, 1, 0, stamp);
  ASSERT_EQ(scan.points.size(), 64u * 300);
  ASSERT_EQ(scan.truth.size(), scan.points.size());
  const RigidMotion T_world_stamp = drive.T_world_lidar(stamp);
  const std::vector<double>& rings = lidar_data_sheet(LidarModel::kHdl64).elevations;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const TruthPoint& truth = scan.truth[i];
    const Vector3d p = place(scan.points[i]);
    const Vector3d p_world = drive.T_world_lidar(stamp + truth.time) * p;
    ASSERT_LT(off_walls(p_world, kLow, kHigh), 1e-5);
    ASSERT_LT((T_world_stamp * truth.hit_lidar.cast<double>() - p_world).norm(), 1e-5);
    ASSERT_NEAR(std::asin(p.z() / p.norm()), rings.at(truth.ring), 1e-6);
    const double azimuth = std::atan2(p.y(), p.x());
    ASSERT_NEAR(truth.time, -azimuth / kTurn * options.period, 1e-7);
    ASSERT_EQ(truth.surface, 17u);
    ASSERT_FALSE(truth.moving);
    ASSERT_EQ(truth.albedo, encode_srgb({0.2f, 0.5f, 0.9f}));
  }
}

TEST(LidarModel, TurnsClockwiseRingByRing) {
  Drive drive;
  drive.open(room(drive.material(0.4f)));
  const LidarOptions options = exact(120);
  const SimulatedScan scan = drive.scan(options);
  for (std::size_t i = 0; i < scan.truth.size(); ++i) {
    EXPECT_EQ(scan.truth[i].ring, i / 120);
    const Vector3d p = place(scan.points[i]);
    const double expected = std::numbers::pi - kTurn * (double(i % 120) + 0.5) / 120;
    EXPECT_NEAR(std::atan2(p.y(), p.x()), expected, 1e-6);
    EXPECT_LE(std::abs(scan.truth[i].time), 0.5 * options.period);
    if (i % 120 != 0) {
      EXPECT_GT(scan.truth[i].time, scan.truth[i - 1].time);
    }
  }
}

TEST(LidarModel, NoiseIsOfTheRangeAloneWithoutAMean) {
  Drive drive;
  drive.open(room(drive.material(0.4f)));
  LidarOptions options = exact(400);
  options.range_noise = 0.03;
  const SimulatedScan scan = drive.scan(options);
  const auto n = double(scan.points.size());
  ASSERT_EQ(n, 64 * 400);
  double mean = 0, square = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Vector3d p = place(scan.points[i]), hit = scan.truth[i].hit_lidar.cast<double>();
    EXPECT_LT(p.cross(hit).norm() / hit.squaredNorm(), 1e-6);
    const double error = p.norm() - hit.norm();
    mean += error / n;
    square += error * error / n;
    EXPECT_LT(std::abs(error), 6 * 0.03);
  }
  EXPECT_NEAR(mean, 0, 5 * 0.03 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(square), 0.03, 5 * 0.03 / std::sqrt(2 * n));
}

TEST(LidarModel, RangesAreMultiplesOfTheResolution) {
  Drive drive;
  drive.open(room(drive.material(0.4f)));
  LidarOptions options = exact(60);
  options.range_resolution = 0.01;
  const SimulatedScan scan = drive.scan(options);
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const double range = place(scan.points[i]).norm();
    EXPECT_NEAR(range, 0.01 * std::round(range / 0.01), 1e-5);
    EXPECT_NEAR(range, scan.truth[i].hit_lidar.norm(), 0.005 + 1e-5);
  }
}

TEST(LidarModel, NoiseBelongsToSeedAndFrame) {
  Drive drive;
  drive.open(room(drive.material(0.1f)));
  LidarOptions options;
  options.columns = 60;
  const SimulatedScan scan = drive.scan(options, 4, 5);
  EXPECT_EQ(drive.scan(options, 4, 5).points, scan.points);
  EXPECT_NE(drive.scan(options, 4, 6).points, scan.points);
  EXPECT_NE(drive.scan(options, 5, 5).points, scan.points);
  const ThreadLimit one(1);
  EXPECT_EQ(drive.scan(options, 4, 5).points, scan.points);
}

TEST(LidarModel, SeesOnlyWithinItsRange) {
  Drive drive;
  drive.open(room(drive.material(0.4f)));
  LidarOptions options = exact(100);
  options.min_range = 10;
  options.max_range = 28;
  options.range_noise = 0.5;
  const SimulatedScan scan = drive.scan(options);
  EXPECT_LT(scan.points.size(), 64u * 100);
  EXPECT_GT(scan.points.size(), 1000u);
  for (const auto& point : scan.points) {
    EXPECT_GE(place(point).norm(), 10 - 1e-5);
    EXPECT_LE(place(point).norm(), 28 + 1e-5);
  }
}

/// Share of the beams that return from a ball round the LiDAR: all meet it squarely.
double share_returned(double radius, float reflectance, bool glass, double dropouts) {
  Drive drive;
  MeshBuilder make;
  make.material = drive.material(reflectance, glass);
  make.ball(drive.rig.T_vehicle_lidar.translation(), Vector3d::Constant(radius), 96);
  drive.open(make.take());
  LidarOptions options = exact(200);
  options.dropouts = dropouts;
  return double(drive.scan(options).points.size()) / (64 * 200);
}

TEST(LidarModel, WeakReturnsAreLost) {
  const double tolerance = 5 * 0.5 / std::sqrt(64 * 200);
  EXPECT_NEAR(share_returned(50, 0.1f, false, 1), 0.5, tolerance);  // the data sheet's
  EXPECT_GT(share_returned(25, 0.1f, false, 1), 0.9);
  EXPECT_LT(share_returned(90, 0.1f, false, 1), 0.15);
  EXPECT_GT(share_returned(90, 0.8f, false, 1), 0.8);
  EXPECT_NEAR(share_returned(50, 0.1f, false, 0.5), 0.75, tolerance);
  EXPECT_EQ(share_returned(90, 0.1f, false, 0), 1);
  EXPECT_EQ(share_returned(50, 0.1f, true, 0), 1);
}

TEST(LidarModel, GlassIsMostlyNotSeen) {
  EXPECT_NEAR(share_returned(10, 0.5f, true, 1), 0.15, 5 * 0.36 / std::sqrt(64 * 200));
}

TEST(LidarModel, GrazingReturnsAreWeaker) {
  const auto returned = [](double turned) {
    Drive drive;
    MeshBuilder make;
    make.material = drive.material(0.1f);
    make.frame.translation() = Vector3d(45, 0, 1.7);
    make.frame.linear() = Eigen::AngleAxisd(turned, Vector3d::UnitZ()).matrix();
    make.quad({0, 6, -15}, {0, -6, -15}, {0, -6, 6}, {0, 6, 6});
    drive.open(make.take());
    LidarOptions options = exact(3000);
    const double all = double(drive.scan(options).points.size());
    EXPECT_GT(all, 500);
    options.dropouts = 1;
    const SimulatedScan scan = drive.scan(options);
    return std::pair(double(scan.points.size()) / all, scan.points.front()[3]);
  };
  const auto [square, square_intensity] = returned(0);
  const auto [grazing, grazing_intensity] = returned(1.2);
  EXPECT_GT(square, grazing + 0.15);
  EXPECT_NEAR(square_intensity, 0.1, 0.011);
  EXPECT_LT(grazing_intensity, square_intensity);
}

TEST(LidarModel, IntensityIsTheMaterialsInPercent) {
  Drive drive;
  drive.open(room(drive.material(0.8f)));
  for (const auto& point : drive.scan(exact(50)).points) {
    EXPECT_GE(point[3], 0.28f);
    EXPECT_LE(point[3], 0.8f);
    EXPECT_NEAR(100 * point[3], std::round(100 * point[3]), 1e-4);
  }
}

// The sweep's timing and direction are those that the product undoes.
TEST(LidarModel, CompensatedSweepsAreStraight) {
  Drive drive;
  MeshBuilder make;
  make.material = drive.material(0.5f);
  make.quad({25, 60, -10}, {25, -60, -10}, {25, -60, 10}, {25, 60, 10});
  drive.open(make.take(), steady(10));
  LidarOptions options = exact(1000);
  const double stamp = 0.3;
  const SimulatedScan scan = drive.scan(options, 1, 3, stamp);
  ASSERT_GT(scan.points.size(), 10'000u);
  PointCloud cloud;
  for (const auto& point : scan.points) cloud.position.push_back(place(point).cast<float>());
  const RigidMotion T_world_lidar = drive.T_world_lidar(stamp);
  const auto worst = [&] {
    double off = 0;
    for (const Vector3f& p : cloud.position) {
      off = std::max(off, std::abs((T_world_lidar * p.cast<double>()).x() - 25));
    }
    return off;
  };
  EXPECT_GT(worst(), 0.1);
  EXPECT_LT(worst(), 0.3);
  const double dt = 0.01;
  const Twist velocity = log_se3(T_world_lidar.inverse() * drive.T_world_lidar(stamp + dt)) / dt;
  EXPECT_NEAR(velocity.tail<3>().norm(), 10, 1e-6);
  compensate_sweep(cloud, {velocity}, {.period = options.period});
  EXPECT_LT(worst(), 1e-4);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_LT((cloud.position[i] - scan.truth[i].hit_lidar).norm(), 1e-4);
  }
}

TEST(LidarModel, MovingThingsAreMetWhereTheyAreWhenTheBeamFires) {
  Drive drive;
  constexpr double kSpeed = -14, kAt = 9;
  drive.material(0.5f);
  MeshBuilder make;
  make.box({-1, -4, 0}, {1, 4, 3});
  drive.scenery.add(Model{"lorry", make.take(), 6, {}});
  drive.scenery.moving = [=](double time, double /*way*/) {
    Placement lorry;
    lorry.T_world_model.translation() = Vector3d(kAt, 1 + kSpeed * time, 0);
    lorry.paint = 1;
    lorry.surface = Scenery::kMoving | 2;
    return std::vector<Placement>{lorry};
  };
  MeshBuilder ground;
  ground.quad({-90, -90, 0}, {90, -90, 0}, {90, 90, 0}, {-90, 90, 0});
  drive.open(ground.take(), steady(6));
  const double stamp = 0.05;
  const SimulatedScan scan = drive.scan(exact(900), 1, 0, stamp);
  int met = 0;
  double low = 1e9, high = -1e9;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    if (!scan.truth[i].moving) continue;
    ++met;
    const double time = stamp + scan.truth[i].time;
    const Vector3d p = drive.T_world_lidar(time) * place(scan.points[i]);
    EXPECT_EQ(scan.truth[i].surface, Scenery::kMoving | 2);
    const double y = p.y() - (1 + kSpeed * time);
    EXPECT_NEAR(p.x(), kAt - 1, 1e-5);
    low = std::min(low, y);
    high = std::max(high, y);
  }
  EXPECT_GT(met, 1000);
  EXPECT_NEAR(low, -4, 0.2);
  EXPECT_NEAR(high, 4, 0.2);
  EXPECT_GE(low, -4 - 1e-5);
  EXPECT_LE(high, 4 + 1e-5);
}

}  // namespace fovea::lidar_model_test
