// A LiDAR in a room, for tests.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include "fovea/simulation/lidar_model.h"
#include "fovea/simulation/mesh_builder.h"
#include "fovea/simulation/test_scenery.h"

namespace fovea::test {

inline VehicleOptions steady(double speed) {
  VehicleOptions options;
  options.speed = speed;
  options.speed_variation = options.weave = options.sway = options.heave = 0;
  return options;
}

inline LidarOptions exact(int columns) {
  LidarOptions options;
  options.columns = columns;
  options.range_noise = options.range_resolution = options.dropouts = 0;
  return options;
}

/// A vehicle that drives along x through a scenery, at the origin at time 0.
struct LidarDrive {
  TestScenery scenery;
  Rig rig = make_rig({});
  std::unique_ptr<RayCaster> caster;
  std::unique_ptr<VehicleMotion> motion;

  std::uint16_t material(float reflectance, bool glass = false) {
    Material m;
    m.reflectance = reflectance;
    m.glass = glass;
    m.color = {0.2f, 0.5f, 0.9f};
    return scenery.add(m);
  }
  void open(TriangleMesh mesh, const VehicleOptions& vehicle = steady(0)) {
    scenery.add(Eigen::Vector2d(0, 0), std::move(mesh));
    caster = std::make_unique<RayCaster>(scenery);
    caster->move_to({0, 0}, 100);
    motion = std::make_unique<VehicleMotion>(scenery.path(), 0, vehicle, 3);
  }
  RigidMotion T_world_lidar(double time) const {
    return motion->T_world_vehicle(time) * rig.T_vehicle_lidar;
  }
  SimulatedScan scan(const LidarOptions& options, int seed = 1, int frame = 0,
                     double stamp = 0) const {
    return simulate_scan(*caster, *motion, rig.T_vehicle_lidar, options, seed, frame, stamp);
  }
};

inline Eigen::Vector3d place(const std::array<float, 4>& point) {
  return Eigen::Vector3f(point[0], point[1], point[2]).cast<double>();
}

/// Distance of a place from the room that box(low, high) is, seen from within.
inline double off_walls(const Eigen::Vector3d& p, const Eigen::Vector3d& low,
                        const Eigen::Vector3d& high) {
  return std::min((p - low).cwiseAbs().minCoeff(), (high - p).cwiseAbs().minCoeff());
}

inline const Eigen::Vector3d kLow(-30, -25, -0.5), kHigh(34, 22, 9);

inline TriangleMesh room(std::uint16_t material) {
  MeshBuilder make;
  make.material = material;
  make.surface = 17;
  make.box(kLow, kHigh);
  return make.take();
}

}  // namespace fovea::test
