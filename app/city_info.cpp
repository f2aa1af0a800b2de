#include "app/city_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <vector>

#include "app/print.h"
#include "fovea/city/city.h"
#include "fovea/city/json_values.h"
#include "fovea/errors.h"
#include "fovea/map/map_store.h"

namespace fovea::app {
namespace {

/// The tiles by the revision in which they last changed, the newest first.
using TilesByRevision = std::map<int, std::vector<CityTile>, std::greater<>>;

TilesByRevision tiles_by_revision(const City& city) {
  TilesByRevision tiles;
  for (const CityTileFile& tile : city.tiles) tiles[tile.revision].push_back(tile.tile);
  return tiles;
}

/// Bytes of the maps of all tiles.
std::uintmax_t bytes_of(const City& city) {
  std::uintmax_t bytes = 0;
  for (const CityTileFile& tile : city.tiles) bytes += std::filesystem::file_size(tile.map);
  return bytes;
}

double length_of(const City& city) {
  double length = 0;
  for (const CityDrive& drive : city.drives) length += drive.length;
  return length;
}

std::string text_of(const std::vector<CityTile>& tiles) {
  constexpr std::size_t kMostNamed = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(tiles.size(), kMostNamed); ++i) {
    text += (i == 0 ? "" : "  ") + tiles[i].text();
  }
  if (tiles.size() > kMostNamed) text += fmt::format("  and {} more", tiles.size() - kMostNamed);
  return text;
}

void print_text(const City& city, const std::string& path) {
  print_out("{} (city, revision {})\n", path, city.revision);
  print_out("  drives     {}, {:.1f} m\n", city.drives.size(), length_of(city));
  for (const CityDrive& drive : city.drives) {
    print_out("    {}: {} frames, {:.1f} m, {}\n", drive.name, drive.frames, drive.length,
              drive.path.string());
  }
  print_out("  tiles      {} of {:g} m\n", city.tiles.size(), city.tile_size);
  for (const auto& [revision, tiles] : tiles_by_revision(city)) {
    print_out("    changed in revision {}: {}\n", revision, text_of(tiles));
  }
  print_out("  points     {} in {} bytes\n", city.points(), bytes_of(city));
  if (!city.tiles.empty()) {
    const auto [east, north] = city.extent();
    print_out("  extent     {:g} x {:g} tiles, {:g} x {:g} m\n", east / city.tile_size,
              north / city.tile_size, east, north);
  }
  print_out("  session    {}\n", city.session);
  print_out("  origin     {} N, {} E, {} m (WGS84; axes east, north, up)\n", city.origin.latitude,
            city.origin.longitude, city.origin.altitude);
  print_out("  poses      {}\n", city.poses.string());
}

void print_json(const City& city) {
  const auto [east, north] = city.extent();
  Json json{
      {"city", true},
      {"revision", city.revision},
      {"session", city.session},
      {"origin", json_of(city.origin)},
      {"poses", city.poses.string()},
      {"points", city.points()},
      {"bytes", bytes_of(city)},
      {"tile_size_m", city.tile_size},
      {"extent_tiles", {std::int64_t(east / city.tile_size), std::int64_t(north / city.tile_size)}},
      {"extent_m", {east, north}},
      {"path_length_m", length_of(city)},
      {"drives", Json::array()},
      {"tiles", Json::array()}};
  for (const CityDrive& drive : city.drives) {
    json["drives"].push_back({{"name", drive.name},
                              {"path", drive.path.string()},
                              {"frames", drive.frames},
                              {"length_m", drive.length},
                              {"maps", drive.maps.size()}});
  }
  for (const CityTileFile& tile : city.tiles) {
    json["tiles"].push_back({{"x", tile.tile.x},
                             {"y", tile.tile.y},
                             {"points", tile.points},
                             {"bytes", std::filesystem::file_size(tile.map)},
                             {"revision", tile.revision},
                             {"map", tile.map.string()}});
  }
  print_json_value(json);
}

/// Names each part of a tile that cannot be read.
/// @return whether there is none
bool is_whole(const CityTileFile& tile) {
  bool is_whole = true;
  const auto report = [&](const std::string& damage) {
    is_whole = false;
    print_out("tile {}: {}\n", tile.tile.text(), damage);
  };
  try {
    const MapReader map(tile.map, report);
    map.check();
    if (is_whole && map.size() != tile.points) {
      report(fmt::format("it has {} points, the manifest says {}", map.size(), tile.points));
    }
  } catch (const InputError& error) {
    report(error.what());
  }
  return is_whole;
}

void check(const City& city, const std::string& path) {
  std::size_t damaged = 0;
  for (const CityTileFile& tile : city.tiles) damaged += !is_whole(tile);
  if (damaged > 0) {
    throw InputError(fmt::format("{} of {} tiles {} damaged", damaged, city.tiles.size(),
                                 damaged == 1 ? "is" : "are"),
                     path, "remove their maps and build the city again");
  }
  print_out("{}: whole, {} tiles\n", path, city.tiles.size());
}

}  // namespace

void print_city(const std::string& path, const CityInfoForm& form) {
  const City city = open_city(path);
  if (form.check) return check(city, path);
  if (form.digest) {
    print_out("{}\n", city_digest(city));
  } else if (form.json) {
    print_json(city);
  } else {
    print_text(city, path);
  }
}

}  // namespace fovea::app
