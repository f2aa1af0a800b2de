#include "fovea/exporting/city/city_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "fovea/city/city_frames.h"

namespace fovea {
namespace {

using Json = nlohmann::json;

/// A frame of a drive.
struct PathFrame {
  FrameStatus status = FrameStatus::kMapped;
  RigidMotion T_local_lidar;
};

struct DrivePath {
  std::string name;  ///< of the drive
  /// By their number in the drive; several tiles may show the same frame.
  std::map<int, PathFrame> frames;
};

/// By CityFrames::map_id(): drives may have one name.
using Paths = std::map<std::string, DrivePath>;

void read_paths(const City& city, const CityTileFile& tile, Paths& paths) {
  for (const CityFrames& of_map : frames_of_tile(city, tile.tile, MapReader(tile.map))) {
    DrivePath& path = paths[of_map.map_id()];
    path.name = of_map.drive.name;
    for (const FrameRecord& frame : of_map.frames) {
      path.frames.try_emplace(frame.index, PathFrame{frame.status, frame.T_local_lidar});
    }
  }
}

/// Distance between the frames that the page gets, m: a city of any size has a bounded file.
double step_of(const City& city) {
  constexpr double kMostFrames = 50'000, kFinest = 1;
  double length = 0;
  for (const CityDrive& drive : city.drives) length += drive.length;
  return std::max(kFinest, length / kMostFrames);
}

void append_path(const std::map<int, PathFrame>& path, std::size_t drive, double step, Json& json) {
  const PathFrame* before = nullptr;
  const int last = path.rbegin()->first;
  for (const auto& [number, frame] : path) {
    const bool is_near =
        before != nullptr &&
        (frame.T_local_lidar.translation() - before->T_local_lidar.translation()).norm() < step;
    if (is_near && number != last) continue;
    before = &frame;
    json["index"].push_back(json["index"].size());
    json["time"].push_back(nullptr);
    json["status"].push_back(to_string(frame.status));
    json["T_local_lidar"].push_back(matrix_rows(frame.T_local_lidar));
    json["score"].push_back(nullptr);
    json["drive"].push_back(drive);
  }
}

}  // namespace

MapDescription describe_city(const City& city) {
  MapDescription description;
  description.name = std::filesystem::weakly_canonical(city.folder).filename().string();
  description.points = description.colored_points = city.points();
  description.origin = city.origin;
  MapDescription::OfCity of_city;
  of_city.revision = city.revision;
  of_city.session = city.session;
  of_city.tiles = city.tiles.size();
  of_city.extent = city.extent();
  for (const CityDrive& drive : city.drives) {
    of_city.drives.push_back({drive.name, drive.length, drive.frames});
  }
  description.city = std::move(of_city);
  return description;
}

nlohmann::json city_frames_json(const City& city) {
  Json json = {{"index", Json::array()},  {"time", Json::array()},
               {"status", Json::array()}, {"T_local_lidar", Json::array()},
               {"score", Json::array()},  {"milliseconds", Json::object()},
               {"drive", Json::array()},  {"failures", Json::array()}};
  Paths paths;
  for (const CityTileFile& tile : city.tiles) {
    try {
      read_paths(city, tile, paths);
    } catch (const std::exception& error) {
      json["failures"].push_back(fmt::format("tile {}: {}", tile.tile.text(), error.what()));
    }
  }
  const double step = step_of(city);
  for (const auto& [id, path] : paths) {
    const auto drive =
        std::find_if(city.drives.begin(), city.drives.end(),
                     [&](const CityDrive& of_city) { return of_city.name == path.name; });
    if (path.frames.empty() || drive == city.drives.end()) continue;
    append_path(path.frames, std::size_t(drive - city.drives.begin()), step, json);
  }
  return json;
}

std::string city_frames_text(const City& city) {
  return city_frames_json(city).dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace fovea
