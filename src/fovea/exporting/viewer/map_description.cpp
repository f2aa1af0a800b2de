#include "fovea/exporting/viewer/map_description.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "fovea/errors.h"
#include "fovea/map/meta_keys.h"
#include "fovea/pipeline/config.h"
#include "fovea/platform.h"
#include "fovea/point_cloud.h"

namespace fovea {
namespace {

using Json = nlohmann::json;

constexpr double kTimeSteps = 1e3;  // per ms: a smaller difference is noise

std::optional<MapDescription::Foveal> foveal_of(const MapMeta& meta) {
  const auto config = meta.find(meta_key::kConfig);
  if (config == meta.end()) return std::nullopt;
  try {
    const MapSettings settings = stored_settings(config->second, "config");
    if (!settings.has_foveal_region()) return std::nullopt;
    return MapDescription::Foveal{settings.foveal().near_range, settings.foveal().far_range};
  } catch (const ConfigError&) {
    return std::nullopt;  // a map of a newer program is shown without them
  }
}

Json camera_json(const Camera& camera) {
  return {{"index", camera.index},   {"width", camera.width},
          {"height", camera.height}, {"fx", camera.fx},
          {"fy", camera.fy},         {"cx", camera.cx},
          {"cy", camera.cy},         {"T_cam_lidar", matrix_rows(camera.T_cam_lidar)}};
}

Json city_json(const MapDescription::OfCity& city) {
  Json json = {{"revision", city.revision},
               {"session", city.session},
               {"tiles", city.tiles},
               {"extent_m", city.extent},
               {"drives", Json::array()}};
  for (const MapDescription::Drive& drive : city.drives) {
    json["drives"].push_back(
        {{"name", drive.name}, {"length_m", drive.length}, {"frames", drive.frames}});
  }
  return json;
}

}  // namespace

std::array<double, 12> matrix_rows(const RigidMotion& T) {
  std::array<double, 12> rows{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      rows[static_cast<std::size_t>(4 * row + column)] = T.matrix()(row, column);
    }
  }
  return rows;
}

MapDescription describe_map(const MapReader& map) {
  const MapMeta meta = map.meta();
  MapDescription description;
  const auto name = meta.find(meta_key::kDriveName);
  if (name != meta.end()) description.name = name->second;
  description.points = map.size();
  description.colored_points = map.colored_size();
  description.origin = map_origin(meta);
  if (description.points > 0) description.tile_size = map_tile_size(meta);
  description.foveal = foveal_of(meta);
  return description;
}

std::string to_json(const MapDescription& map) {
  Json json = {{"format", 1},
               {"generator", fmt::format("fovea {}", version())},
               {"name", map.name},
               {"points", map.points},
               {"colored_points", map.colored_points},
               {"live", map.live},
               {"mesh", map.mesh},
               {"tileset", nullptr},
               {"frames", "frames.json"},
               {"status", nullptr},
               {"images", map.images},
               {"origin", nullptr},
               {"tile_size", map.tile_size},
               {"sensor_period", map.sensor_period},
               {"foveal", nullptr},
               {"cameras", Json::array()},
               {"rules", kPointRuleNames},
               {"city", nullptr}};
  if (map.status) json["status"] = "status.json";
  if (!map.tileset.empty()) json["tileset"] = map.tileset;
  if (map.origin) {
    json["origin"] = {{"latitude", map.origin->latitude},
                      {"longitude", map.origin->longitude},
                      {"altitude", map.origin->altitude}};
  }
  if (map.foveal) json["foveal"] = {{"near", map.foveal->near}, {"far", map.foveal->far}};
  if (map.city) json["city"] = city_json(*map.city);
  for (const Camera& camera : map.cameras) json["cameras"].push_back(camera_json(camera));
  return json.dump();
}

nlohmann::json score_json(const FrameRecord& frame) {
  const auto score = frame.figures.find(kScoreFigure);
  return score == frame.figures.end() ? Json(nullptr) : Json(score->second);
}

nlohmann::json milliseconds_json(const FrameRecord& frame) {
  Json json = Json::object();
  for (const auto& [stage, ms] : frame.milliseconds) {
    json[stage] = std::round(ms * kTimeSteps) / kTimeSteps;
  }
  return json;
}

nlohmann::json time_json(const FrameRecord& frame, std::optional<TimeNs> first) {
  return frame.stamp && first ? Json(seconds(*frame.stamp - *first)) : Json(nullptr);
}

nlohmann::json frames_json(std::span<const FrameRecord> frames) {
  std::optional<TimeNs> first;
  std::set<std::string> stages;
  for (const FrameRecord& frame : frames) {
    if (!first) first = frame.stamp;
    for (const auto& [stage, ms] : frame.milliseconds) stages.insert(stage);
  }
  Json json = {{"index", Json::array()},  {"time", Json::array()},
               {"status", Json::array()}, {"T_local_lidar", Json::array()},
               {"score", Json::array()},  {"milliseconds", Json::object()}};
  for (const std::string& stage : stages) json["milliseconds"][stage] = Json::array();
  for (const FrameRecord& frame : frames) {
    json["index"].push_back(frame.index);
    json["time"].push_back(time_json(frame, first));
    json["status"].push_back(to_string(frame.status));
    json["T_local_lidar"].push_back(matrix_rows(frame.T_local_lidar));
    json["score"].push_back(score_json(frame));
    const Json milliseconds = milliseconds_json(frame);
    for (const std::string& stage : stages) {
      json["milliseconds"][stage].push_back(milliseconds.value(stage, Json(nullptr)));
    }
  }
  return json;
}

}  // namespace fovea
