// Sweeps of any direction and phase, mounts, and the drives that have them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../../tests/temporary_folder.h"
#include "fovea/core/angle.h"
#include "fovea/deskew.h"
#include "fovea/drive/drive_truth.h"
#include "fovea/drive/frame_source.h"
#include "fovea/simulation/lidar_model.h"
#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/simulate.h"
#include "fovea/simulation/test_scenery.h"
#include "fovea/world/surface_index.h"
#include "fovea/world/world_file.h"

namespace fovea::lidar_mount_test {

using Eigen::Vector3d;

constexpr double kTurn = 2 * std::numbers::pi;

Vector3d place(const std::array<float, 4>& point) {
  return Eigen::Vector3f(point[0], point[1], point[2]).cast<double>();
}

/// A wall 8 m to the left of a vehicle that drives along it, and a road that ends there.
struct WallDrive {
  TestScenery scenery;
  std::unique_ptr<RayCaster> caster;
  std::unique_ptr<VehicleMotion> motion;
  Rig rig;

  WallDrive(const SimulationOptions& options, double speed) : rig(make_rig(options)) {
    Material matte;
    matte.reflectance = 0.5f;
    MeshBuilder make;
    make.material = scenery.add(matte);
    make.quad({60, 8, -10}, {-60, 8, -10}, {-60, 8, 10}, {60, 8, 10});
    make.quad({60, -30, 0}, {60, 7.9, 0}, {-60, 7.9, 0}, {-60, -30, 0});
    scenery.add(Eigen::Vector2d(0, 0), make.take());
    caster = std::make_unique<RayCaster>(scenery);
    caster->move_to({0, 0}, 100);
    VehicleOptions vehicle;
    vehicle.speed = speed;
    vehicle.speed_variation = vehicle.weave = vehicle.sway = vehicle.heave = 0;
    motion = std::make_unique<VehicleMotion>(scenery.path(), 0, vehicle, 3);
  }
};

SimulationOptions exact_options() {
  SimulationOptions options;
  options.lidar.columns = 400;
  options.lidar.range_noise = options.lidar.range_resolution = options.lidar.dropouts = 0;
  return options;
}

TEST(LidarMount, SweepsTurnEitherWayFromAnyAzimuthToAnyPhase) {
  SimulationOptions options = exact_options();
  LidarOptions& lidar = options.lidar;
  lidar.elevations = {-0.1, -0.2};
  lidar.start_azimuth = 1.1;
  lidar.period = 0.05;
  const WallDrive drive(options, 9);
  const double stamp = 0.4;
  for (const SweepDirection direction :
       {SweepDirection::kClockwise, SweepDirection::kCounterclockwise}) {
    for (const double phase : {0.0, 0.25, 0.5, 1.0}) {
      lidar.direction = direction;
      lidar.stamp_phase = phase;
      const SimulatedScan scan = simulate_scan(*drive.caster, *drive.motion,
                                               drive.rig.T_vehicle_lidar, lidar, 1, 0, stamp);
      ASSERT_GT(scan.points.size(), 700u);
      const double sign = direction == SweepDirection::kClockwise ? -1 : 1;
      double first = 1, last = -1;
      for (std::size_t i = 0; i < scan.points.size(); ++i) {
        const double time = scan.truth[i].time;
        first = std::min(first, time);
        last = std::max(last, time);
        const Vector3d p = place(scan.points[i]);
        const double azimuth = 1.1 + sign * kTurn * (time / lidar.period + phase);
        ASSERT_NEAR(std::remainder(std::atan2(p.y(), p.x()) - azimuth, kTurn), 0, 2e-6);
        // The point lies where the LiDAR was at its time.
        const Vector3d p_world =
            drive.motion->T_world_vehicle(stamp + time) * drive.rig.T_vehicle_lidar * p;
        ASSERT_LT(std::min(std::abs(p_world.y() - 8), std::abs(p_world.z())), 1e-5);
      }
      EXPECT_NEAR(first, (0.5 / 400 - phase) * lidar.period, 1e-8);
      EXPECT_NEAR(last, (399.5 / 400 - phase) * lidar.period, 1e-8);
    }
  }
}

TEST(LidarMount, AnUpsideDownLidarSeesAWallOnItsOtherSide) {
  SimulationOptions options = exact_options();
  options.lidar.elevations = lidar_data_sheet(LidarModel::kVlp16).elevations;
  options.lidar.roll = std::numbers::pi;
  const WallDrive drive(options, 0);
  const SimulatedScan scan = simulate_scan(*drive.caster, *drive.motion, drive.rig.T_vehicle_lidar,
                                           options.lidar, 1, 0, 0);
  const RigidMotion T_vehicle_upright = make_rig({}).T_vehicle_lidar;
  int on_wall = 0, on_road = 0;
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    const Vector3d p = place(scan.points[i]);
    const Vector3d p_vehicle = T_vehicle_upright * Vector3d(p.x(), -p.y(), -p.z());
    // Upright, the LiDAR is turned by less than 0.4 degrees against the vehicle.
    if (std::abs(p_vehicle.y() - 8) < 1e-5) {
      EXPECT_NEAR(p.y(), -8, 0.4 * kDegree * p.norm());
      ++on_wall;
    } else {
      EXPECT_NEAR(p_vehicle.z(), 0, 1e-5);
      EXPECT_NEAR(p.z(), 1.73, 0.4 * kDegree * p.norm());
      EXPECT_LT(scan.truth[i].ring, 8);  // rings that point up in the LiDAR's own frame
      ++on_road;
    }
    // It turns clockwise about its own z axis.
    EXPECT_NEAR(scan.truth[i].time, -std::atan2(p.y(), p.x()) / kTurn * options.lidar.period, 1e-7);
  }
  EXPECT_GT(on_wall, 500);
  EXPECT_GT(on_road, 500);
}

/// A street's drive of two frames with few points and small images.
SimulationOptions small_street() {
  SimulationOptions options = simulation_options(Scene::kStreet, "none");
  options.frames = 2;
  options.lidar.columns = 200;
  options.camera.cameras.resize(1);
  options.camera.width = 60;
  options.camera.height = 30;
  options.camera.focal = 40;
  options.camera.cx = 29.5;
  options.camera.cy = 14.5;
  return options;
}

/// Every point of a drive's scans, as the product reads and compensates them, lies on the world.
void expect_points_on_the_world(const std::filesystem::path& drive, const SimulationOptions& o) {
  const auto source = open_drive(drive, {});
  const DriveTruth truth(drive);
  const World world = read_world(truth.folder());
  const SurfaceIndex surfaces(world.mesh_local);
  for (int frame = 0; frame < 2; ++frame) {
    const auto loaded = source->load(frame);
    ASSERT_TRUE(std::holds_alternative<Frame>(loaded));
    const PointCloud& scan = std::get<Frame>(loaded).scan;
    const std::vector<TrueReturn> returns = truth.returns(frame);
    ASSERT_EQ(scan.size(), returns.size());
    const RigidMotion& T_local_lidar = truth.T_local_lidar()[std::size_t(frame)];
    for (std::size_t i = 0; i < returns.size(); ++i) {
      const Vector3d hit = T_local_lidar * returns[i].hit_lidar.cast<double>();
      ASSERT_LT((surfaces.nearest(hit).position - hit).norm(), 1e-4);
      if (!scan.time.empty()) {
        ASSERT_EQ(scan.time[i], returns[i].time);
      }
      // A vehicle of 9 m/s is at most a meter away from where it is at the stamp.
      ASSERT_LT((scan.position[i] - returns[i].hit_lidar).norm(), 9 * 1.3 * o.lidar.period);
    }
  }
}

TEST(LidarMount, AGenericDriveHasItsMountTimesAndImages) {
  const TemporaryFolder folder;
  SimulationOptions options = small_street();
  options.format = DriveFormat::kGeneric;
  options.lidar.elevations = lidar_data_sheet(LidarModel::kVlp16).elevations;
  options.lidar.roll = std::numbers::pi;
  options.lidar.yaw = 0.7;
  options.lidar.direction = SweepDirection::kCounterclockwise;
  options.lidar.start_azimuth = 0;
  options.lidar.stamp_phase = 1;
  const std::filesystem::path drive = simulate(options, folder / "d");
  expect_points_on_the_world(drive, options);
  const auto source = open_drive(drive, {});
  // Images are taken in the middle of the sweep, which ends at the stamp.
  EXPECT_NEAR(source->info().calibration.cameras[0].image_delay, -0.5 * options.lidar.period, 1e-9);
  EXPECT_TRUE(source->info().calibration.cameras[0].T_cam_lidar.isApprox(
      make_rig(options).T_cam_lidar_calibrated[0], 1e-12));
  // A tilted LiDAR's boxes are beyond KITTI's tracklets.
  EXPECT_FALSE(std::filesystem::exists(drive / "tracklet_labels.xml"));
}

TEST(LidarMount, ADriveWithoutPointTimesStatesItsSweep) {
  const TemporaryFolder folder;
  SimulationOptions options = small_street();
  options.format = DriveFormat::kGeneric;
  options.lidar.point_times = false;
  options.lidar.period = 0.2;
  options.lidar.direction = SweepDirection::kCounterclockwise;
  options.lidar.start_azimuth = -0.4;
  options.lidar.stamp_phase = 0.9;
  const std::filesystem::path drive = simulate(options, folder / "d");
  const SweepTiming sweep = open_drive(drive, {})->info().sweep;
  EXPECT_EQ(sweep.period, 0.2);
  EXPECT_EQ(sweep.direction, SweepDirection::kCounterclockwise);
  EXPECT_NEAR(sweep.start_azimuth, -0.4, 1e-12);
  EXPECT_EQ(sweep.stamp_phase, 0.9);
  // The product's compensation takes each point to where the truth has it.
  const WallDrive wall(options, 9);
  SimulatedScan scan =
      simulate_scan(*wall.caster, *wall.motion, wall.rig.T_vehicle_lidar, options.lidar, 1, 0, 0.3);
  PointCloud cloud;
  for (const auto& point : scan.points) cloud.position.push_back(place(point).cast<float>());
  const RigidMotion T_world_lidar = wall.motion->T_world_vehicle(0.3) * wall.rig.T_vehicle_lidar;
  const RigidMotion T_world_later = wall.motion->T_world_vehicle(0.31) * wall.rig.T_vehicle_lidar;
  compensate_sweep(cloud, {log_se3(T_world_lidar.inverse() * T_world_later) / 0.01}, sweep);
  ASSERT_GT(cloud.size(), 1000u);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_LT((cloud.position[i] - scan.truth[i].hit_lidar).norm(), 1e-3);
  }
}

TEST(LidarMount, ADriveOfEveryModelIsRead) {
  for (const LidarDataSheet& sheet : lidar_data_sheets()) {
    SCOPED_TRACE(sheet.name);
    const TemporaryFolder folder;
    SimulationOptions options = small_street();
    options.format = DriveFormat::kGeneric;
    set_model(options.lidar, sheet.model);
    options.lidar.columns = sheet.rosette ? 3000 : 60;
    expect_points_on_the_world(simulate(options, folder / "d"), options);
  }
}

TEST(LidarMount, AKittiDriveHasItsMount) {
  const TemporaryFolder folder;
  SimulationOptions options = small_street();
  options.lidar.roll = std::numbers::pi;
  options.lidar.yaw = 0.3;
  const std::filesystem::path drive = simulate(options, folder / "d");
  expect_points_on_the_world(drive, options);
  const auto source = open_drive(drive, {});
  EXPECT_TRUE(source->info().calibration.cameras[0].T_cam_lidar.isApprox(
      make_rig(options).T_cam_lidar_calibrated[0], 1e-9));
}

}  // namespace fovea::lidar_mount_test
