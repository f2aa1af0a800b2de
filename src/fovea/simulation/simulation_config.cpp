#include "fovea/simulation/simulation_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "fovea/base/errors.h"
#include "fovea/base/settings.h"

namespace fovea {
namespace {

constexpr int kMaxCameras = 10;

/// The list of cameras as keys: their numbers, and place and kind of each by its number.
class CameraKeys {
 public:
  explicit CameraKeys(const CameraOptions& options) {
    for (const SimulatedCamera& camera : options.cameras) {
      numbers_.push_back(camera.number);
      if (camera.number < 0 || camera.number >= kMaxCameras) continue;  // validate() will say so
      right_[std::size_t(camera.number)] = camera.right;
      grey_[std::size_t(camera.number)] = camera.grey;
    }
  }

  void visit(SettingVisitor& visit) {
    visit("camera.numbers", numbers_);
    for (std::size_t k = 0; k < kMaxCameras; ++k)
      visit(fmt::format("camera.right_{}", k), right_[k]);
    for (std::size_t k = 0; k < kMaxCameras; ++k) visit(fmt::format("camera.grey_{}", k), grey_[k]);
  }

  /// ConfigError for a place or kind that was just given of a camera that is not simulated.
  void store(CameraOptions& options) const {
    const CameraKeys before(options);
    for (std::size_t k = 0; k < kMaxCameras; ++k) {
      if (std::find(numbers_.begin(), numbers_.end(), int(k)) != numbers_.end()) continue;
      if (right_[k] != before.right_[k]) reject(fmt::format("camera.right_{}", k));
      if (grey_[k] != before.grey_[k]) reject(fmt::format("camera.grey_{}", k));
    }
    options.cameras.clear();
    for (const int number : numbers_) {
      SimulatedCamera camera = kitti_camera(number);
      if (number >= 0 && number < kMaxCameras) {
        camera.right = right_[std::size_t(number)].value_or(camera.right);
        camera.grey = grey_[std::size_t(number)].value_or(camera.grey);
      }
      options.cameras.push_back(camera);
    }
  }

 private:
  [[noreturn]] static void reject(const std::string& key) {
    throw ConfigError("this camera is not simulated", key, "name it in camera.numbers, too");
  }

  std::vector<int> numbers_;
  std::array<std::optional<double>, kMaxCameras> right_;
  std::array<std::optional<bool>, kMaxCameras> grey_;
};

/// Calls `visit(key, reference)` for every key but those of `cameras`' list.
void visit_config(SettingVisitor& visit, SimulationOptions& o, CameraKeys& cameras) {
  visit("drive.pass", o.pass);
  visit("light.sun_azimuth", Degrees{o.light.sun_azimuth});
  visit("light.sun_elevation", Degrees{o.light.sun_elevation});
  visit("light.sun", o.light.sun);
  visit("light.sky", o.light.sky);
  visit("light.reflections", o.light.reflections);

  visit("vehicle.speed", o.vehicle.speed);
  visit("vehicle.speed_variation", o.vehicle.speed_variation);
  visit("vehicle.weave", o.vehicle.weave);
  visit("vehicle.sway", Degrees{o.vehicle.sway});
  visit("vehicle.heave", o.vehicle.heave);
  visit("vehicle.stop_at", o.vehicle.stop_at);
  visit("vehicle.stop_braking", o.vehicle.stop_braking);
  visit("vehicle.stop_duration", o.vehicle.stop_duration);

  visit("street.bends", Degrees{o.bends});
  visit("street.curvature", o.curvature);

  visit("lidar.period", o.lidar.period);
  visit("lidar.columns", o.lidar.columns);
  visit("lidar.min_range", o.lidar.min_range);
  visit("lidar.max_range", o.lidar.max_range);
  visit("lidar.range_noise", o.lidar.range_noise);
  visit("lidar.range_resolution", o.lidar.range_resolution);
  visit("lidar.dropouts", o.lidar.dropouts);
  visit("lidar.height", o.lidar.height);

  cameras.visit(visit);
  visit("camera.width", o.camera.width);
  visit("camera.height", o.camera.height);
  visit("camera.focal", o.camera.focal);
  visit("camera.cx", o.camera.cx);
  visit("camera.cy", o.camera.cy);
  visit("camera.exposure", o.camera.exposure);
  visit("camera.exposure_variation", o.camera.exposure_variation);
  visit("camera.vignetting", o.camera.vignetting);
  visit("camera.noise", o.camera.noise);
  visit("camera.rotation_error_x", Degrees{o.camera.rotation_error.x()});
  visit("camera.rotation_error_y", Degrees{o.camera.rotation_error.y()});
  visit("camera.rotation_error_z", Degrees{o.camera.rotation_error.z()});
  visit("camera.trigger_delay", o.camera.trigger_delay);

  NavigationOptions& n = o.navigation;
  visit("navigation.latitude", n.origin.latitude);  // degrees, as in the records
  visit("navigation.longitude", n.origin.longitude);
  visit("navigation.altitude", n.origin.altitude);
  visit("navigation.min_delay", n.min_delay);
  visit("navigation.max_delay", n.max_delay);
  visit("navigation.position_noise", n.position_noise);
  visit("navigation.position_walk", n.position_walk);
  visit("navigation.position_bias", n.position_bias);
  visit("navigation.angle_noise", Degrees{n.angle_noise});
  visit("navigation.angle_walk", Degrees{n.angle_walk});
  visit("navigation.jump_rate", n.jump_rate);
  visit("navigation.jump_size", n.jump_size);
  visit("navigation.outages", n.outages);
}

void apply(const SettingsDocument& document, SimulationOptions& options) {
  SimulationOptions result = options;
  CameraKeys cameras(result.camera);
  document.apply([&](SettingVisitor& visit) { visit_config(visit, result, cameras); },
                 [&] {
                   cameras.store(result.camera);
                   result.validate();
                 },
                 "see docs/simulator.md for the keys");
  options = std::move(result);
}

}  // namespace

void apply_config_file(const std::filesystem::path& file, SimulationOptions& options) {
  apply(SettingsDocument::from_file(file), options);
}

void apply_config_text(std::string_view text, std::string_view name, SimulationOptions& options) {
  apply(SettingsDocument::from_text(text, name), options);
}

void apply_setting(std::string_view setting, SimulationOptions& options) {
  apply(SettingsDocument::from_assignment(setting, "vehicle.speed=12"), options);
}

std::string to_toml(const SimulationOptions& options) {
  SimulationOptions copy = options;
  CameraKeys cameras(copy.camera);
  return settings_text([&](SettingVisitor& visit) { visit_config(visit, copy, cameras); });
}

}  // namespace fovea
