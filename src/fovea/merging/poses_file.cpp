#include "fovea/merging/poses_file.h"

#include "fovea/city/json_values.h"

namespace fovea {
namespace {

constexpr std::size_t kVersion = 1;
constexpr const char* kRemedy = "make it again with 'fovea adjust'";

Json json_of_map(const PlacedMap& map) {
  Json json{{"identity", map.name.identity}, {"drive", map.name.drive}, {"fixed", map.is_fixed},
            {"matches", map.matches},        {"moved_m", map.moved},    {"submaps", Json::array()}};
  for (const SubmapPlacement& submap : map.submaps) {
    json["submaps"].push_back({{"T_ecef_submap", json_of(submap.T_ecef_submap)},
                               {"log2_gain", json_of<3>(submap.log2_gain)}});
  }
  return json;
}

PlacedMap map_from(const Json& json) {
  PlacedMap map;
  map.name.identity = json.at("identity").get<std::string>();
  map.name.drive = json.at("drive").get<std::string>();
  map.is_fixed = json.at("fixed").get<bool>();
  map.matches = count_of(json.at("matches"));
  map.moved = json.at("moved_m").get<double>();
  for (const Json& submap : list_at(json, "submaps")) {
    map.submaps.push_back(
        {motion_of(submap.at("T_ecef_submap")), vector_of<3>(submap.at("log2_gain"))});
  }
  map.name.submaps = map.submaps.size();
  return map;
}

Json json_of_rejected(const RejectedMatch& match) {
  return {{"identity_a", match.identity_a},
          {"identity_b", match.identity_b},
          {"submap_a", match.submap_a},
          {"submap_b", match.submap_b},
          {"distance_m", match.distance}};
}

RejectedMatch rejected_from(const Json& json) {
  return {json.at("identity_a").get<std::string>(), json.at("identity_b").get<std::string>(),
          count_of(json.at("submap_a")), count_of(json.at("submap_b")),
          json.at("distance_m").get<double>()};
}

Json json_of_point(const PointResidual& point) {
  return {{"name", point.name},
          {"role", point.is_check ? "check" : "control"},
          {"east_north_up_m", json_of<3>(point.east_north_up)}};
}

PointResidual point_from(const Json& json) {
  const auto role = json.at("role").get<std::string>();
  if (role != "control" && role != "check") throw std::invalid_argument("no role is " + role);
  return {json.at("name").get<std::string>(), role == "check",
          vector_of<3>(json.at("east_north_up_m"))};
}

}  // namespace

void write_city_poses(const CityPoses& city, const std::filesystem::path& path, bool force) {
  Json json{{"fovea_poses", kVersion},
            {"origin", json_of(city.origin)},
            {"maps", Json::array()},
            {"rejected", Json::array()},
            {"points", Json::array()}};
  for (const PlacedMap& map : city.maps) json["maps"].push_back(json_of_map(map));
  for (const RejectedMatch& match : city.rejected) {
    json["rejected"].push_back(json_of_rejected(match));
  }
  for (const PointResidual& point : city.points) json["points"].push_back(json_of_point(point));
  write_json(json, path, force);
}

CityPoses read_city_poses(const std::filesystem::path& path) {
  CityPoses city;
  read_json(path, "poses of a city", kRemedy, [&](const Json& json) {
    if (count_of(json.at("fovea_poses")) != kVersion) {
      throw std::invalid_argument("it is of another version of Fovea");
    }
    city.origin = geodetic_point_of(json.at("origin"));
    for (const Json& map : list_at(json, "maps")) city.maps.push_back(map_from(map));
    for (const Json& match : list_at(json, "rejected"))
      city.rejected.push_back(rejected_from(match));
    for (const Json& point : list_at(json, "points")) city.points.push_back(point_from(point));
  });
  return city;
}

}  // namespace fovea
