#include "fovea/city/city.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "fovea/city/json_values.h"
#include "fovea/core/content_kind.h"
#include "fovea/errors.h"
#include "fovea/map/map_store.h"
#include "fovea/map/value_hash.h"

namespace fovea {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kVersion = 1;
constexpr const char* kManifest = "city.json";
constexpr const char* kManifests = "manifests";  // folder of all revisions
constexpr double kMostDistance = 1e6;            // m, of a tile from the origin
constexpr const char* kRemedy = "build the city again with 'python3 -m fovea.city build'";

/// A file below the city's folder.
fs::path file_of(const Json& json, const fs::path& folder) {
  const fs::path file = json.get<std::string>();
  const bool leaves = std::find(file.begin(), file.end(), "..") != file.end();
  if (file.empty() || file.is_absolute() || leaves) {
    throw std::invalid_argument(file.string() + " is no file of the city");
  }
  return folder / file;
}

int revision_of(const Json& json) {
  const std::size_t revision = count_of(json);
  if (revision > std::size_t(std::numeric_limits<int>::max())) {
    throw std::invalid_argument("a revision is too large");
  }
  return static_cast<int>(revision);
}

std::int32_t place_of(const Json& json, double tile_size) {
  const double place = json.is_number_integer() ? json.get<double>() : kMostDistance;
  if (!(std::abs(place) * tile_size < kMostDistance)) {
    throw std::invalid_argument(json.dump() + " is no place of a tile");
  }
  return static_cast<std::int32_t>(place);
}

/// @param city  with its folder and the size of its tiles
CityTileFile tile_of(const Json& json, const City& city) {
  CityTileFile tile;
  tile.tile = {place_of(json.at("x"), city.tile_size), place_of(json.at("y"), city.tile_size)};
  tile.map = file_of(json.at("file"), city.folder);
  tile.points = count_of(json.at("points"));
  tile.revision = revision_of(json.at("revision"));
  return tile;
}

CityDrive drive_of(const Json& json, const fs::path& folder) {
  CityDrive drive;
  drive.name = json.at("name").get<std::string>();
  drive.path = json.at("path").get<std::string>();
  drive.frames = count_of(json.at("frames"));
  drive.length = json.at("length_m").get<double>();
  if (!(drive.length >= 0)) throw std::invalid_argument("the length of a drive is impossible");
  for (const Json& map : list_at(json, "maps")) drive.maps.push_back(file_of(map, folder));
  return drive;
}

void read_manifest(const Json& json, City& city) {
  if (count_of(json.at("fovea_city")) != kVersion) {
    throw std::invalid_argument("it is of another version of Fovea");
  }
  city.revision = revision_of(json.at("revision"));
  city.origin = geodetic_point_of(json.at("origin"));
  city.tile_size = json.at("tile_size_m").get<double>();
  if (!(city.tile_size >= 1 && city.tile_size <= 1000)) {
    throw std::invalid_argument("the size of the tiles is impossible");
  }
  city.session = json.at("session").get<std::string>();
  city.poses = file_of(json.at("poses"), city.folder);
  for (const Json& drive : list_at(json, "drives"))
    city.drives.push_back(drive_of(drive, city.folder));
  for (const Json& tile : list_at(json, "tiles")) city.tiles.push_back(tile_of(tile, city));
}

}  // namespace

std::size_t City::points() const {
  std::size_t points = 0;
  for (const CityTileFile& tile : tiles) points += tile.points;
  return points;
}

std::array<double, 2> City::extent() const {
  if (tiles.empty()) return {};
  const auto by_y = [](const CityTileFile& a, const CityTileFile& b) {
    return a.tile.y < b.tile.y;
  };
  const auto [south, north] = std::minmax_element(tiles.begin(), tiles.end(), by_y);
  return {tile_size * (1.0 + tiles.back().tile.x - tiles.front().tile.x),
          tile_size * (1.0 + north->tile.y - south->tile.y)};
}

RigidMotion City::T_local_tile(const CityTile& tile) const {
  return T_ecef_enu(origin).inverse() * T_ecef_enu(CityGrid(origin, tile_size).middle(tile));
}

std::vector<std::size_t> City::tiles_near(const Eigen::Vector3d& center_local,
                                          double radius) const {
  const CityGrid grid(origin, tile_size);
  const Eigen::Vector2d center = grid.projected(T_ecef_enu(origin) * center_local);
  const auto is_near = [&](const CityTile& tile) {
    const Eigen::Array2d low = tile_size * Eigen::Array2d(tile.x, tile.y);
    const Eigen::Array2d nearest = center.array().max(low).min(low + tile_size);
    return (nearest.matrix() - center).norm() <= radius;
  };
  // The tiles are sorted by x.
  const auto first_x = std::floor((center.x() - radius) / tile_size);
  auto tile = std::lower_bound(tiles.begin(), tiles.end(), first_x,
                               [](const CityTileFile& t, double x) { return t.tile.x < x; });
  std::vector<std::size_t> near;
  for (; tile != tiles.end() && tile->tile.x * tile_size <= center.x() + radius; ++tile) {
    if (is_near(tile->tile)) near.push_back(std::size_t(tile - tiles.begin()));
  }
  return near;
}

std::vector<std::size_t> City::tiles_near(std::span<const Eigen::Vector3d> path_local,
                                          double radius) const {
  std::set<std::size_t> numbers;
  for (const Eigen::Vector3d& place : path_local) {
    const std::vector<std::size_t> near = tiles_near(place, radius);
    numbers.insert(near.begin(), near.end());
  }
  return {numbers.begin(), numbers.end()};
}

fs::path overview_of_tile(const fs::path& map) {
  return fs::path(map).replace_extension(".overview.glb");
}

std::string city_digest(const City& city) {
  ValueHash hash;
  hash.section("tiles");
  for (const CityTileFile& tile : city.tiles) {
    hash.row();
    hash.value(std::int64_t{tile.tile.x});
    hash.value(std::int64_t{tile.tile.y});
    hash.value(std::string_view(MapReader(tile.map).digest()));
  }
  return hash.hex128();
}

bool is_city(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored) || (fs::is_regular_file(path, ignored) &&
                                             content_kind_of(path) == ContentKind::kCityManifest);
}

City open_city(const fs::path& path) {
  std::error_code ignored;
  const bool is_folder = fs::is_directory(path, ignored);
  const fs::path manifest = is_folder ? path / kManifest : path;
  if (is_folder && !fs::exists(manifest, ignored)) {
    throw InputError(fmt::format("the folder is no city: it has no {}", kManifest), path.string(),
                     "give a folder that 'python3 -m fovea.city build' made");
  }
  City city;
  city.folder = is_folder ? path : fs::absolute(path).parent_path();
  if (!is_folder && city.folder.filename() == kManifests) city.folder = city.folder.parent_path();
  read_json(manifest, "manifest of a city", kRemedy,
            [&](const Json& json) { read_manifest(json, city); });
  const auto by_place = [](const CityTileFile& a, const CityTileFile& b) {
    return a.tile < b.tile;
  };
  std::sort(city.tiles.begin(), city.tiles.end(), by_place);
  std::sort(city.drives.begin(), city.drives.end(),
            [](const CityDrive& a, const CityDrive& b) { return a.name < b.name; });
  for (std::size_t i = 0; i < city.tiles.size(); ++i) {
    const CityTileFile& tile = city.tiles[i];
    if (i > 0 && tile.tile == city.tiles[i - 1].tile) {
      throw InputError(fmt::format("tile {} is listed twice", tile.tile.text()), manifest.string(),
                       kRemedy);
    }
    if (fs::is_regular_file(tile.map, ignored)) continue;
    throw InputError(fmt::format("the map of tile {} is missing", tile.tile.text()),
                     tile.map.string(), kRemedy);
  }
  return city;
}

}  // namespace fovea
