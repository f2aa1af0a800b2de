#include "fovea/evaluation/scored_city.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "fovea/city/city_frames.h"
#include "fovea/errors.h"
#include "fovea/map/map_meta.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/tile_place.h"

namespace fovea {
namespace {

/// Places of the path are this far apart, m.
constexpr double kStep = 5;

std::vector<Eigen::Vector3d> path_of(const std::vector<FrameRecord>& frames) {
  std::vector<Eigen::Vector3d> path;
  for (const FrameRecord& frame : frames) {
    const Eigen::Vector3d place = frame.T_local_lidar.translation();
    if (path.empty() || (path.back() - place).norm() >= kStep) path.push_back(place);
  }
  return path;
}

/// Meta data of the drive's own map if the city still has the file: a tile has those of another
/// drive.
MapMeta meta_of(const City& city, const std::string& drive, const std::filesystem::path& tile) {
  MapMeta meta;
  const auto of = std::find_if(city.drives.begin(), city.drives.end(),
                               [&](const CityDrive& d) { return d.name == drive; });
  std::error_code ignored;
  if (of != city.drives.end() && !of->maps.empty() &&
      std::filesystem::is_regular_file(of->maps.front(), ignored)) {
    meta = MapReader(of->maps.front()).meta();
  } else {
    meta = MapReader(tile).meta();
    meta.erase(meta_key::kCalibration);
  }
  meta[meta_key::kGeoreferenced] = "1";
  meta[meta_key::kOriginLatitude] = fmt::format("{}", city.origin.latitude);
  meta[meta_key::kOriginLongitude] = fmt::format("{}", city.origin.longitude);
  meta[meta_key::kOriginHeight] = fmt::format("{}", city.origin.altitude);
  return meta;
}

/// The numbers of frames in the drive by those in a tile.
std::map<int, int> numbers_in_tile(const MapReader& map, const DriveInCity& drive) {
  std::map<int, int> numbers;
  for (DriveRecord& record : map.drives()) {
    const int shift = record.frame_shift;
    const auto of_map = drive.numbers.find(CityFrames{std::move(record), {}}.map_id());
    if (of_map == drive.numbers.end()) continue;
    for (const auto& [in_map, in_drive] : of_map->second) numbers[in_map + shift] = in_drive;
  }
  return numbers;
}

/// A part of a city's tile that lies near the path.
struct NearTile {
  TileId id;
  std::size_t points = 0;
  RigidMotion T_city_submap;
};

std::vector<NearTile> tiles_near(const City& city, const CityTile& tile, const MapReader& map,
                                 const std::vector<Eigen::Vector3d>& path) {
  const double tile_size = map_tile_size(map.meta());
  const double reach = kScoredReach + reach_of_tile(tile_size);
  std::vector<RigidMotion> T_city_submap = map.submaps();
  for (RigidMotion& T : T_city_submap) T = city.T_local_tile(tile) * T;
  std::vector<NearTile> near;
  for (const auto& [id, points] : map.tile_sizes()) {
    const RigidMotion& T = T_city_submap.at(id.submap);
    const Eigen::Vector3d middle = T * middle_of(id.key, tile_size);
    const bool is_near = std::any_of(path.begin(), path.end(), [&](const Eigen::Vector3d& place) {
      return (place - middle).norm() <= reach;
    });
    if (is_near) near.push_back({id, points, T});
  }
  return near;
}

std::size_t points_near(const City& city, const std::vector<std::size_t>& tiles,
                        const std::vector<Eigen::Vector3d>& path) {
  std::size_t points = 0;
  for (const std::size_t number : tiles) {
    const CityTileFile& file = city.tiles[number];
    for (const NearTile& near : tiles_near(city, file.tile, MapReader(file.map), path)) {
      points += near.points;
    }
  }
  return points;
}

/// Appends the points of a tile that lie near the path.
void append_tile(const City& city, const CityTileFile& file, const DriveInCity& drive,
                 const std::vector<Eigen::Vector3d>& path, ScoredMap& scored) {
  const MapReader map(file.map);
  const auto held = map.hold_state();
  const std::map<int, int> numbers = numbers_in_tile(map, drive);
  for (const NearTile& near : tiles_near(city, file.tile, map, path)) {
    PointCloud part = scored_columns(map.read_tile(near.id));
    for (std::int32_t& frame : part.frame) {
      const auto number = numbers.find(frame);
      frame = number == numbers.end() ? -1 : number->second;
    }
    append_points(std::move(part), near.T_city_submap, scored);
  }
}

}  // namespace

ScoredMap load_scored_city(const City& city, const DriveInCity& drive) {
  const std::vector<Eigen::Vector3d> path = path_of(drive.frames);
  const std::vector<std::size_t> tiles = city.tiles_near(path, kScoredReach);
  ScoredMap scored;
  scored.frames = drive.frames;
  if (!tiles.empty()) {
    scored.meta = meta_of(city, drive.name, city.tiles[tiles.front()].map);
  }
  begin_points(scored, points_near(city, tiles, path));
  for (const std::size_t number : tiles) {
    append_tile(city, city.tiles[number], drive, path, scored);
  }
  if (scored.points_local.empty()) {
    throw InputError(fmt::format("the city has no points near the drive '{}'", drive.name),
                     city.folder.string(), "give a drive of this place");
  }
  finish_points(scored);
  return scored;
}

}  // namespace fovea
