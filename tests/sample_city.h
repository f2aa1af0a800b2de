// A small city of random points for tests.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fovea/geometry/city_grid.h"
#include "fovea/map/map_store.h"
#include "sample_map.h"

namespace fovea {

inline constexpr GeodeticPoint kSampleCityOrigin{49.01, 8.43, 115.0};

/// The points of a tile, within 24 m of its middle.
inline TileMap sample_tile_points(const CityTile& tile, std::size_t points) {
  Random random(static_cast<std::uint64_t>(1000 + 31 * tile.x + tile.y));
  TileMap map(4.0);
  map.add_submap(RigidMotion::Identity());
  map.add(random_map_points(points, random, 24.0));
  return map;
}

/// Two frames of drive "a", 10 m apart; those of neighbors to the east have the next numbers.
inline void put_sample_path(MapWriter& writer, const CityTile& tile) {
  DriveRecord drive = sample_drive();
  drive.name = "a";
  drive.source_digest = "0123";
  drive.first_frame = 0;
  drive.end_frame = 2;
  drive.frame_shift = -2 * (10 + tile.x);
  writer.put_drive(0, drive);
  for (int i = 0; i < 2; ++i) {
    FrameRecord frame;
    frame.index = i;
    frame.submap = 0;
    frame.T_local_lidar.translation() = Eigen::Vector3d(10 * i, 1, 2);
    writer.put_frame(frame);
  }
}

/// A map of a tile as 'fovea fuse' writes it.
inline void write_sample_tile(const std::filesystem::path& path, const CityTile& tile,
                              double tile_size, std::size_t points) {
  const GeodeticPoint middle = CityGrid(kSampleCityOrigin, tile_size).middle(tile);
  const TileMap map = sample_tile_points(tile, points);
  const auto writer = MapWriter::create(path, /*force=*/true);
  writer->put_meta("map.tile_size_m", "4");
  writer->put_meta("georeferenced", "1");
  writer->put_meta("complete", "1");
  writer->put_meta("config", "mapper = \"default\"\n");
  writer->put_meta("origin.latitude_deg", fmt::format("{}", middle.latitude));
  writer->put_meta("origin.longitude_deg", fmt::format("{}", middle.longitude));
  writer->put_meta("origin.height_m", fmt::format("{}", middle.altitude));
  put_sample_path(*writer, tile);
  writer->put_submap(0, RigidMotion::Identity());
  for (const auto& [key, stored] : map.submaps()[0].tiles) {
    writer->put_tile({0, key}, stored.points->cloud());
  }
  writer->finish();
}

/// Writes the manifest of a revision, and city.json.
inline void write_sample_manifest(const std::filesystem::path& folder,
                                  const nlohmann::ordered_json& manifest) {
  std::filesystem::create_directories(folder / "manifests");
  const int revision = manifest.at("revision").get<int>();
  for (const auto& file :
       {folder / "city.json", folder / "manifests" / (std::to_string(revision) + ".json")}) {
    std::ofstream(file) << manifest.dump(1);
  }
}

/// Writes the tiles and the manifest of a city.
/// @return the manifest
inline nlohmann::ordered_json write_sample_city(const std::filesystem::path& folder,
                                                const std::vector<CityTile>& tiles,
                                                std::size_t points = 3000) {
  constexpr double kTileSize = 64;
  nlohmann::ordered_json manifest{{"fovea_city", 1},
                                  {"revision", 1},
                                  {"origin",
                                   {{"latitude_deg", kSampleCityOrigin.latitude},
                                    {"longitude_deg", kSampleCityOrigin.longitude},
                                    {"height_m", kSampleCityOrigin.altitude}}},
                                  {"tile_size_m", kTileSize},
                                  {"session", "best"},
                                  {"poses", "poses/0.json"},
                                  {"drives",
                                   {{{"name", "a"},
                                     {"path", "/drives/a"},
                                     {"length_m", 120.5},
                                     {"frames", 8},
                                     {"maps", {"maps/a.fovea"}}}}},
                                  {"tiles", nlohmann::ordered_json::array()}};
  std::filesystem::create_directories(folder / "tiles");
  for (const CityTile& tile : tiles) {
    const std::string file = fmt::format("tiles/{}_{}_0.fovea", tile.x, tile.y);
    write_sample_tile(folder / file, tile, kTileSize, points);
    manifest["tiles"].push_back({{"x", tile.x},
                                 {"y", tile.y},
                                 {"file", file},
                                 {"points", points},
                                 {"bytes", std::filesystem::file_size(folder / file)},
                                 {"revision", 1}});
  }
  write_sample_manifest(folder, manifest);
  return manifest;
}

/// A city of any size without much to write: all tiles have the map of one.
inline void write_repeated_city(const std::filesystem::path& folder,
                                const std::vector<CityTile>& tiles, std::size_t points) {
  nlohmann::ordered_json manifest = write_sample_city(folder, {{0, 0}}, points);
  const nlohmann::ordered_json of_one = manifest["tiles"][0];
  manifest["tiles"].clear();
  for (const CityTile& tile : tiles) {
    nlohmann::ordered_json copy = of_one;
    copy["x"] = tile.x;
    copy["y"] = tile.y;
    manifest["tiles"].push_back(copy);
  }
  write_sample_manifest(folder, manifest);
}

/// Changes a byte of a tile's points.
inline void damage_sample_tile(const std::filesystem::path& map) {
  std::filesystem::permissions(map, std::filesystem::perms::owner_write,
                               std::filesystem::perm_options::add);
  std::fstream file(map, std::ios::in | std::ios::out | std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::size_t column = bytes.rfind("\x28\xb5\x2f\xfd");  // begins a zstd frame
  ASSERT_NE(column, std::string::npos);
  file.seekp(static_cast<std::streamoff>(column + 4));
  file << "over";
}

}  // namespace fovea
