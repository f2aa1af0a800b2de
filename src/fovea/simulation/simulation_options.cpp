#include "fovea/simulation/simulation_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "fovea/core/random.h"
#include "fovea/errors.h"
#include "fovea/simulation/image_schedule.h"
#include "fovea/simulation/option_checks.h"
#include "fovea/simulation/rig.h"
#include "fovea/simulation/town_route.h"

namespace fovea {
namespace {

constexpr std::array<std::pair<Scene, std::string_view>, 7> kScenes{{{Scene::kStreet, "street"},
                                                                     {Scene::kTraffic, "traffic"},
                                                                     {Scene::kCrossing, "crossing"},
                                                                     {Scene::kCanyon, "canyon"},
                                                                     {Scene::kPlaza, "plaza"},
                                                                     {Scene::kStress, "stress"},
                                                                     {Scene::kTown, "town"}}};

void check(const LightOptions& light) {
  check_degrees("light.sun_azimuth", light.sun_azimuth, -360, 360);
  check_degrees("light.sun_elevation", light.sun_elevation, 0, 90);
  check_range("light.sun", light.sun, 0, 100);
  check_range("light.sky", light.sky, 0, 100);
}

void check(const VehicleOptions& vehicle) {
  check_range("vehicle.speed", vehicle.speed, 0, 50, "m/s");
  check_range("vehicle.speed_variation", vehicle.speed_variation, 0, 0.99);
  check_range("vehicle.weave", vehicle.weave, 0, 1, "m");
  check_degrees("vehicle.sway", vehicle.sway, 0, 10);
  check_range("vehicle.heave", vehicle.heave, 0, 0.5, "m");
  check_range("vehicle.stop_at", vehicle.stop_at, -1, 1e5, "s");
  check_range("vehicle.stop_braking", vehicle.stop_braking, 0.5, 60, "s");
  check_range("vehicle.stop_duration", vehicle.stop_duration, 0, 3600, "s");
  check_degrees("vehicle.turn_rate", vehicle.turn_rate, 0, 360);
  check_degrees("vehicle.turn_angle", vehicle.turn_angle, 5, 170);
  check_range("vehicle.stairs", vehicle.stairs, 0, 20, "m");
}

void check(const CameraOptions& camera) {
  if (camera.cameras.empty()) reject("there is no camera", "camera.numbers", "give one or more");
  std::set<int> numbers;
  for (const SimulatedCamera& one : camera.cameras) {
    check_range("camera.numbers", one.number, 0, 9);
    check_range(fmt::format("camera.right_{}", one.number), one.right, -10, 10, "m");
    check_range(fmt::format("camera.forward_{}", one.number), one.forward, -10, 10, "m");
    check_degrees(fmt::format("camera.yaw_{}", one.number), one.yaw, -360, 360);
    if (!numbers.insert(one.number).second) {
      reject(fmt::format("camera {} is named twice", one.number), "camera.numbers",
             "name each camera once");
    }
  }
  check_range("camera.width", camera.width, 8, 8192, "pixels");
  check_range("camera.height", camera.height, 8, 8192, "pixels");
  check_range("camera.focal", camera.focal, 1, 1e5, "pixels");
  check_range("camera.cx", camera.cx, -1e5, 1e5, "pixels");
  check_range("camera.cy", camera.cy, -1e5, 1e5, "pixels");
  check_range("camera.exposure", camera.exposure, 0.01, 100);
  check_range("camera.exposure_variation", camera.exposure_variation, 0, 3);
  check_range("camera.exposure_ratio", camera.exposure_ratio, 0.01, 100);
  check_range("camera.white_balance_step", camera.white_balance_step, 0, 1);
  check_range("camera.vignetting", camera.vignetting, 0, 1);
  check_range("camera.noise", camera.noise, 0, 100, "grey levels");
  check_degrees("camera.rotation_error_x", camera.rotation_error.x(), -5, 5);
  check_degrees("camera.rotation_error_y", camera.rotation_error.y(), -5, 5);
  check_degrees("camera.rotation_error_z", camera.rotation_error.z(), -5, 5);
  check_range("camera.translation_error_x", camera.translation_error.x(), -0.5, 0.5, "m");
  check_range("camera.translation_error_y", camera.translation_error.y(), -0.5, 0.5, "m");
  check_range("camera.translation_error_z", camera.translation_error.z(), -0.5, 0.5, "m");
  check_range("camera.trigger_delay", camera.trigger_delay, -0.2, 0.2, "s");
  check_image_times(camera);
  check_range("camera.rolling_shutter", camera.rolling_shutter, 0, 0.1, "s");
}

/// KITTI's format has rectified cameras only, which look the same way.
void check_format(const CameraOptions& camera) {
  for (const SimulatedCamera& one : camera.cameras) {
    if (one.yaw == 0 && one.forward == 0 && one.lens == SimulatedLens::kNone) continue;
    reject(
        fmt::format("camera {} is turned, moved forward or distorts, which KITTI's format cannot "
                    "say",
                    one.number),
        "camera.rig", "use --format generic");
  }
}

/// A pixel that no ray reaches would have no colour.
void check_lenses(const CameraOptions& camera) {
  for (const SimulatedCamera& one : camera.cameras) {
    const LensCamera optics = lens_camera(one, camera);
    for (const double u : {-0.5, optics.width - 0.5}) {
      for (const double v : {-0.5, optics.height - 0.5}) {
        if (optics.ray({u, v})) continue;
        reject(fmt::format("the lens of camera {} does not reach the corners of its image",
                           one.number),
               fmt::format("camera.lens_{}", one.number), "give a longer camera.focal");
      }
    }
  }
}

void check(const NavigationOptions& navigation, double period) {
  // East and north are not defined at the poles.
  check_range("navigation.latitude", navigation.origin.latitude, -89, 89, "degrees");
  check_range("navigation.longitude", navigation.origin.longitude, -180, 180, "degrees");
  check_range("navigation.altitude", navigation.origin.altitude, -1000, 10'000, "m");
  check_range("navigation.min_delay", navigation.min_delay, 0, 0.2, "s");
  check_range("navigation.max_delay", navigation.max_delay, 0, 0.2, "s");
  const double spread = navigation.max_delay - navigation.min_delay;
  if (spread < 0) {
    reject("the longest delay is below the shortest", "navigation.max_delay",
           "give at least navigation.min_delay");
  }
  if (spread >= period) {
    reject("the delays would put records out of order", "navigation.max_delay",
           "give less than navigation.min_delay and lidar.period together");
  }
  check_range("navigation.position_noise", navigation.position_noise, 0, 100, "m");
  check_range("navigation.position_walk", navigation.position_walk, 0, 100, "m per root second");
  check_range("navigation.position_bias", navigation.position_bias, 0, 100, "m");
  check_degrees("navigation.angle_noise", navigation.angle_noise, 0, 10);
  check_degrees("navigation.angle_walk", navigation.angle_walk, 0, 10);
  check_range("navigation.velocity_noise", navigation.velocity_noise, 0, 100, "m/s");
  check_degrees("navigation.rate_noise", navigation.rate_noise, 0, 100);
  check_range("navigation.jump_rate", navigation.jump_rate, 0, 10, "a second");
  check_range("navigation.jump_size", navigation.jump_size, 0, 100, "m");
}

/// What a scene has of its own; errors as by default.
SimulationOptions scene_options(Scene scene) {
  SimulationOptions options;
  options.scene = scene;
  switch (scene) {
    case Scene::kStreet:
    case Scene::kTraffic:
      break;
    case Scene::kCrossing:
      options.vehicle.speed = 7;
      options.bends = 0;
      break;
    case Scene::kCanyon:
      options.vehicle.speed = 8;
      options.bends = 4 * kDegree;
      options.navigation.outages = true;
      break;
    case Scene::kPlaza:
      options.vehicle.speed = 5;
      break;
    case Scene::kStress:
      options.vehicle.speed = 6;
      break;
    case Scene::kTown:
      options.bends = 0;
      break;
  }
  return options;
}

void take_errors_off(SimulationOptions& options) {
  options.lidar.range_noise = options.lidar.range_resolution = options.lidar.dropouts = 0;
  options.camera.exposure_variation = options.camera.vignetting = options.camera.noise = 0;
  NavigationOptions& n = options.navigation;
  n.position_noise = n.position_walk = n.position_bias = 0;
  n.angle_noise = n.angle_walk = n.velocity_noise = n.rate_noise = 0;
  n.jump_rate = n.jump_size = 0;
  n.outages = false;
  scale_errors(options.imu, options.wheels, 0);
}

void make_harsh(SimulationOptions& options) {
  options.lidar.range_noise = 0.04;
  options.lidar.range_resolution = 0.005;
  options.lidar.dropouts = 2.5;
  options.camera.exposure_variation = 0.8;
  options.camera.vignetting = 0.5;
  options.camera.noise = 4;
  NavigationOptions& n = options.navigation;
  n.position_noise = 0.03;
  n.position_walk = 0.08;
  n.position_bias = 1;
  n.angle_noise = 0.035 * kDegree;
  n.angle_walk = 0.05 * kDegree;
  n.velocity_noise = 0.05;
  n.rate_noise = 0.15 * kDegree;
  n.jump_rate = 0.06;
  n.jump_size = 1;
  n.outages = true;
  scale_errors(options.imu, options.wheels, 2.5);
}

}  // namespace

void SimulationOptions::validate() const {
  check_range("--seed", seed, 0, 2'147'483'647);
  check_range("drive.pass", pass, 0, 1'000'000);
  check_range("--frames", frames, 1, kMaxFrames);
  check(light);
  check(vehicle);
  check_degrees("street.bends", bends, 0, 60);
  check_range("street.curvature", curvature, -0.05, 0.05, "per m");
  check(lidar);
  check(further_lidars);
  if (scene == Scene::kTown) check(town);
  check(camera);
  if (format == DriveFormat::kKitti) {
    check_format(camera);
    check_kitti_image_times(camera);
    check_kitti_format(lidar);
    if (!further_lidars.empty()) {
      reject("KITTI's format has a place for one LiDAR", "lidar.count", "use --format generic");
    }
    check_kitti_format(imu, wheels);
  }
  check_lenses(camera);
  check(navigation, lidar.period);
  check(imu, wheels);
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  names.reserve(kScenes.size());
  for (const auto& entry : kScenes) names.emplace_back(entry.second);
  return names;
}

int SimulationOptions::pass_seed() const {
  constexpr std::uint64_t kPass = 0x70617373;
  if (pass == 0) return seed;
  Random random =
      Random::of_item(static_cast<std::uint64_t>(seed), kPass, static_cast<std::uint64_t>(pass));
  return static_cast<int>(random.below(2'147'483'647));
}

Scene parse_scene(std::string_view name) {
  for (const auto& [scene, known] : kScenes) {
    if (known == name) return scene;
  }
  throw ConfigError(fmt::format("unknown scene '{}'", name), "--scene",
                    fmt::format("give one of {}", fmt::join(scene_names(), ", ")));
}

std::string_view to_string(Scene scene) {
  return kScenes.at(static_cast<std::size_t>(scene)).second;
}

std::vector<std::string> noise_names() { return {"none", "default", "harsh"}; }

SimulationOptions simulation_options(Scene scene, std::string_view noise) {
  SimulationOptions options = scene_options(scene);
  if (noise == "none") {
    take_errors_off(options);
  } else if (noise == "harsh") {
    make_harsh(options);
  } else if (noise != "default") {
    throw ConfigError(fmt::format("unknown level of noise '{}'", noise), "--noise",
                      fmt::format("give one of {}", fmt::join(noise_names(), ", ")));
  }
  return options;
}

}  // namespace fovea
