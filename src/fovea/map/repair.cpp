#include "fovea/map/repair.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "fovea/map/meta_keys.h"

namespace fovea {
namespace {

/// The size of the tiles by the place of one tile; nothing for a tile at 0, which fits any size.
std::optional<double> tile_size_of(const TileId& id, const TilePoints& tile) {
  const Eigen::Vector3i key(id.key.x, id.key.y, id.key.z);
  for (int axis = 0; axis < 3; ++axis) {
    if (key[axis] == 0) continue;
    // A product of a size with few digits and a whole number.
    constexpr double kStepsPerMeter = 1e6;
    const double size = std::round(tile.origin[axis] / key[axis] * kStepsPerMeter) / kStepsPerMeter;
    if (size > 0 && size <= kMaxTileSize) return size;
  }
  return std::nullopt;
}

/// Puts meta data that are lost and that other rows state, too.
void restore_meta(const MapReader& map, std::optional<double> tile_size, MapWriter& output) {
  const MapMeta meta = map.meta();
  const auto put_missing = [&](const char* key, const std::string& value) {
    if (!meta.contains(key)) output.put_meta(key, value);
  };
  if (tile_size) put_missing(meta_key::kTileSize, fmt::to_string(*tile_size));
  const std::vector<DriveRecord> drives = map.drives();
  if (drives.empty() || !drives.front().origin) return;
  const GeodeticPoint& origin = *drives.front().origin;
  put_missing(meta_key::kGeoreferenced, "1");
  put_missing(meta_key::kOriginLatitude, fmt::to_string(origin.latitude));
  put_missing(meta_key::kOriginLongitude, fmt::to_string(origin.longitude));
  put_missing(meta_key::kOriginHeight, fmt::to_string(origin.altitude));
}

}  // namespace

RepairFigures repair_map(const std::filesystem::path& map, MapWriter& output,
                         const std::function<void(const std::string&)>& on_damage) {
  RepairFigures figures;
  const MapReader reader(map, [&](const std::string& damage) {
    ++figures.damages;
    on_damage(damage);
  });
  const auto held_state = reader.hold_state();
  copy_all_but_tiles(reader, output);
  std::optional<double> tile_size;
  reader.for_each_stored_tile([&](const TileId& id, const TilePoints& tile) {
    figures.points += tile.size();
    if (!tile_size) tile_size = tile_size_of(id, tile);
    output.put_tile(id, tile);
  });
  if (figures.damages > 0) {
    restore_meta(reader, tile_size, output);
    output.put_meta(meta_key::kRepair,
                    fmt::format("{} damaged parts are left out", figures.damages));
  }
  output.finish();
  return figures;
}

}  // namespace fovea
