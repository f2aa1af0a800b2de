#include "fovea/simulation/simulation_config.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "fovea/core/angle.h"
#include "fovea/core/settings.h"
#include "fovea/errors.h"
#include "fovea/geometry/sweep_direction_names.h"

namespace fovea {

constexpr auto names_of(CameraRig) {
  return std::array{EnumName<CameraRig>{CameraRig::kKitti, "kitti"},
                    EnumName<CameraRig>{CameraRig::kSurround, "surround"}};
}

constexpr auto names_of(SimulatedLens) {
  return std::array{EnumName<SimulatedLens>{SimulatedLens::kNone, "none"},
                    EnumName<SimulatedLens>{SimulatedLens::kPlumbBob, "plumb_bob"},
                    EnumName<SimulatedLens>{SimulatedLens::kRational, "rational_polynomial"},
                    EnumName<SimulatedLens>{SimulatedLens::kFisheye, "equidistant"}};
}

constexpr auto names_of(Carrier) {
  return std::array{EnumName<Carrier>{Carrier::kWheels, "wheels"},
                    EnumName<Carrier>{Carrier::kWalker, "walker"},
                    EnumName<Carrier>{Carrier::kDrone, "drone"}};
}

std::vector<EnumName<LidarModel>> names_of(LidarModel) {
  std::vector<EnumName<LidarModel>> names;
  for (const LidarDataSheet& sheet : lidar_data_sheets())
    names.push_back({sheet.model, sheet.name});
  return names;
}

namespace {

constexpr int kMaxCameras = 10;
constexpr int kMaxLidars = 8;

/// The list of cameras as keys: their numbers, and place and kind of each by its number.
class CameraKeys {
 public:
  explicit CameraKeys(const CameraOptions& options) : rig_(options.rig) { load(options.cameras); }

  void visit(SettingVisitor& visit) {
    const CameraRig before = rig_;
    visit("camera.rig", rig_);
    if (rig_ != before) load(rig_cameras(rig_));
    visit("camera.numbers", numbers_);
    visit_each(visit, "right", [](SimulatedCamera& c) -> double& { return c.right; });
    visit_each(visit, "forward", [](SimulatedCamera& c) -> double& { return c.forward; });
    visit_each(visit, "yaw", [](SimulatedCamera& c) { return Degrees{c.yaw}; });
    visit_each(visit, "grey", [](SimulatedCamera& c) -> bool& { return c.grey; });
    visit_each(visit, "lens", [](SimulatedCamera& c) -> SimulatedLens& { return c.lens; });
    visit_each(visit, "rate", [](SimulatedCamera& c) -> double& { return c.rate; });
    visit_each(visit, "phase", [](SimulatedCamera& c) -> double& { return c.phase; });
  }

  /// The cameras named by their numbers. ConfigError for a key of another one.
  void store(CameraOptions& options) const {
    if (!key_of_none_.empty()) {
      throw ConfigError("this camera is not simulated", key_of_none_,
                        "name it in camera.numbers, too");
    }
    options.rig = rig_;
    options.cameras.clear();
    for (const int number : numbers_) {
      // validate() will say that there is no such number.
      options.cameras.push_back(is_place(number) ? cameras_[std::size_t(number)]
                                                 : kitti_camera(number));
    }
  }

 private:
  static bool is_place(int number) { return number >= 0 && number < kMaxCameras; }

  void load(const std::vector<SimulatedCamera>& cameras) {
    numbers_.clear();
    for (int k = 0; k < kMaxCameras; ++k) cameras_[std::size_t(k)] = kitti_camera(k);
    for (const SimulatedCamera& camera : cameras) {
      numbers_.push_back(camera.number);
      if (is_place(camera.number)) cameras_[std::size_t(camera.number)] = camera;
    }
  }

  /// One key of each camera that is simulated.
  template <class Member>
  void visit_each(SettingVisitor& visit, std::string_view name, Member&& member) {
    for (int k = 0; k < kMaxCameras; ++k) {
      const std::string key = fmt::format("camera.{}_{}", name, k);
      if (std::find(numbers_.begin(), numbers_.end(), k) == numbers_.end()) {
        if (visit.is_given(key)) key_of_none_ = key;
        continue;
      }
      auto&& value = member(cameras_[std::size_t(k)]);
      visit(key, value);
    }
  }

  CameraRig rig_;
  std::vector<int> numbers_;
  std::array<SimulatedCamera, kMaxCameras> cameras_;  // by number
  std::string key_of_none_;
};

/// Angles in radians as a key in degrees.
void visit_degrees(SettingVisitor& visit, std::string_view key, std::vector<double>& radians) {
  std::vector<double> degrees;
  degrees.reserve(radians.size());
  for (const double angle : radians) degrees.push_back(written_degrees(angle));
  const std::vector<double> before = degrees;
  visit(key, degrees);
  if (degrees == before) return;
  radians.clear();
  for (const double angle : degrees) radians.push_back(angle * kDegree);
}

void visit_lidar(SettingVisitor& visit, const std::string& table, LidarOptions& lidar) {
  const auto key = [&](const char* name) { return table + "." + name; };
  LidarModel model = lidar.model;
  visit(key("model"), model);
  if (model != lidar.model) set_model(lidar, model);
  visit_degrees(visit, key("elevations"), lidar.elevations);
  visit(key("period"), lidar.period);
  visit(key("columns"), lidar.columns);
  visit(key("min_range"), lidar.min_range);
  visit(key("max_range"), lidar.max_range);
  visit(key("range_noise"), lidar.range_noise);
  visit(key("range_resolution"), lidar.range_resolution);
  visit(key("dropouts"), lidar.dropouts);
  visit(key("height"), lidar.height);
  visit(key("point_times"), lidar.point_times);
  visit(key("roll"), Degrees{lidar.roll});
  visit(key("pitch"), Degrees{lidar.pitch});
  visit(key("yaw"), Degrees{lidar.yaw});
  visit(key("direction"), lidar.direction);
  visit(key("start_azimuth"), Degrees{lidar.start_azimuth});
  visit(key("stamp_phase"), lidar.stamp_phase);
}

void visit_lidars(SettingVisitor& visit, SimulationOptions& options) {
  // The level of noise has set the errors of the first LiDAR. Those of the others begin there.
  FurtherLidarOptions usual;
  usual.lidar.range_noise = options.lidar.range_noise;
  usual.lidar.range_resolution = options.lidar.range_resolution;
  usual.lidar.dropouts = options.lidar.dropouts;
  visit_lidar(visit, lidar_table(0), options.lidar);
  auto& further = options.further_lidars;
  int count = int(further.size()) + 1;
  visit("lidar.count", count);
  if (count < 1 || count > kMaxLidars) {
    throw ConfigError(fmt::format("there are {} LiDARs", count), "lidar.count",
                      fmt::format("give 1 to {}", kMaxLidars));
  }
  further.resize(std::size_t(count - 1), usual);
  for (std::size_t k = 0; k < further.size(); ++k) {
    const std::string table = lidar_table(k + 1);
    visit_lidar(visit, table, further[k].lidar);
    visit(table + ".forward", further[k].forward);
    visit(table + ".left", further[k].left);
    visit(table + ".stamp_offset", further[k].stamp_offset);
  }
}

/// Only the town has these keys. ConfigError for one of them in another scene.
void visit_town(SettingVisitor& visit, SimulationOptions& options) {
  const auto visit_one = [&](std::string_view key, auto& value) {
    if (options.scene == Scene::kTown) return visit(key, value);
    if (visit.is_given(key)) {
      throw ConfigError(fmt::format("scene {} has no such key", to_string(options.scene)), key,
                        "give --scene town, or remove the key");
    }
  };
  visit_one("town.blocks_x", options.town.blocks_x);
  visit_one("town.blocks_y", options.town.blocks_y);
  visit_one("town.route", options.town.route);
  visit_one("town.begin", options.town.begin);
  visit_one("town.traffic", options.town.traffic);
}

/// Calls `visit(key, reference)` for every key but those of `cameras`' list.
void visit_config(SettingVisitor& visit, SimulationOptions& o, CameraKeys& cameras) {
  visit("drive.pass", o.pass);
  visit("light.sun_azimuth", Degrees{o.light.sun_azimuth});
  visit("light.sun_elevation", Degrees{o.light.sun_elevation});
  visit("light.sun", o.light.sun);
  visit("light.sky", o.light.sky);
  visit("light.reflections", o.light.reflections);

  visit("vehicle.carrier", o.vehicle.carrier);
  visit("vehicle.speed", o.vehicle.speed);
  visit("vehicle.speed_variation", o.vehicle.speed_variation);
  visit("vehicle.weave", o.vehicle.weave);
  visit("vehicle.sway", Degrees{o.vehicle.sway});
  visit("vehicle.heave", o.vehicle.heave);
  visit("vehicle.stop_at", o.vehicle.stop_at);
  visit("vehicle.stop_braking", o.vehicle.stop_braking);
  visit("vehicle.stop_duration", o.vehicle.stop_duration);
  visit("vehicle.turn_rate", Degrees{o.vehicle.turn_rate});
  visit("vehicle.turn_angle", Degrees{o.vehicle.turn_angle});
  visit("vehicle.stairs", o.vehicle.stairs);

  visit("street.bends", Degrees{o.bends});
  visit("street.curvature", o.curvature);
  visit_town(visit, o);

  visit_lidars(visit, o);

  cameras.visit(visit);
  visit("camera.width", o.camera.width);
  visit("camera.height", o.camera.height);
  visit("camera.focal", o.camera.focal);
  visit("camera.cx", o.camera.cx);
  visit("camera.cy", o.camera.cy);
  visit("camera.exposure", o.camera.exposure);
  visit("camera.exposure_variation", o.camera.exposure_variation);
  visit("camera.exposure_ratio", o.camera.exposure_ratio);
  visit("camera.white_balance_step", o.camera.white_balance_step);
  visit("camera.exposure_times", o.camera.exposure_times);
  visit("camera.vignetting", o.camera.vignetting);
  visit("camera.noise", o.camera.noise);
  visit("camera.rotation_error_x", Degrees{o.camera.rotation_error.x()});
  visit("camera.rotation_error_y", Degrees{o.camera.rotation_error.y()});
  visit("camera.rotation_error_z", Degrees{o.camera.rotation_error.z()});
  visit("camera.translation_error_x", o.camera.translation_error.x());
  visit("camera.translation_error_y", o.camera.translation_error.y());
  visit("camera.translation_error_z", o.camera.translation_error.z());
  visit("camera.trigger_delay", o.camera.trigger_delay);
  visit("camera.rate", o.camera.rate);
  visit("camera.phase", o.camera.phase);
  visit("camera.rolling_shutter", o.camera.rolling_shutter);

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
  visit("navigation.velocity_noise", n.velocity_noise);
  visit("navigation.rate_noise", Degrees{n.rate_noise});
  visit("navigation.jump_rate", n.jump_rate);
  visit("navigation.jump_size", n.jump_size);
  visit("navigation.outages", n.outages);
  visit_imu(visit, o.imu);
  visit_wheels(visit, o.wheels);
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
