#include "fovea/map/repair.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <optional>
#include <set>

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

/// The keys that `fovea map` always writes.
constexpr std::array kExpected = {
    meta_key::kFoveaVersion, meta_key::kDriveName,     meta_key::kDriveKind, meta_key::kCameras,
    meta_key::kFramesBegin,  meta_key::kFramesEnd,     meta_key::kHoldOut,   meta_key::kPoses,
    meta_key::kVariant,      meta_key::kConfig,        meta_key::kNotes,     meta_key::kComplete,
    meta_key::kCalibration,  meta_key::kGeoreferenced, meta_key::kTileSize,
};

/// The cameras of a map by the images of its frames.
std::string cameras_of(const MapReader& map) {
  std::set<int> cameras;
  for (const FrameRecord& frame : map.frames()) {
    for (const ViewRecord& view : frame.views) cameras.insert(view.camera);
  }
  return fmt::format("{}", fmt::join(cameras, ","));
}

/// Meta data that other tables state, too.
MapMeta stated_elsewhere(const MapReader& map, std::optional<double> tile_size) {
  MapMeta meta;
  if (tile_size) meta[meta_key::kTileSize] = fmt::to_string(*tile_size);
  if (const std::string cameras = cameras_of(map); !cameras.empty()) {
    meta[meta_key::kCameras] = cameras;
  }
  const std::vector<DriveRecord> drives = map.drives();
  if (drives.empty()) return meta;
  const DriveRecord& first = drives.front();
  if (!first.name.empty()) meta[meta_key::kDriveName] = first.name;
  if (!first.kind.empty()) meta[meta_key::kDriveKind] = first.kind;
  meta[meta_key::kFramesBegin] = fmt::to_string(first.first_frame);
  meta[meta_key::kFramesEnd] = fmt::to_string(drives.back().end_frame);
  meta[meta_key::kGeoreferenced] = fmt::to_string(first.origin ? 1 : 0);
  if (!first.origin) return meta;
  meta[meta_key::kOriginLatitude] = fmt::to_string(first.origin->latitude);
  meta[meta_key::kOriginLongitude] = fmt::to_string(first.origin->longitude);
  meta[meta_key::kOriginHeight] = fmt::to_string(first.origin->altitude);
  return meta;
}

/// Puts meta data that are lost and that other tables state, too; notes which ones.
void restore_meta(const MapReader& map, const MapMeta& meta, std::optional<double> tile_size,
                  MapWriter& output, RepairFigures& figures) {
  const MapMeta elsewhere = stated_elsewhere(map, tile_size);
  for (const auto& [key, value] : elsewhere) {
    if (meta.contains(key)) continue;
    output.put_meta(key, value);
    figures.restored.push_back(key);
  }
  for (const char* key : kExpected) {
    if (!meta.contains(key) && !elsewhere.contains(key)) figures.lost.emplace_back(key);
  }
}

/// The value of the key `repair`.
std::string description(const MapMeta& meta, const RepairFigures& figures) {
  std::string text;
  if (const auto before = meta.find(meta_key::kRepair); before != meta.end()) {
    text = before->second + "; ";
  }
  text += fmt::format("{} damaged parts are left out", figures.left_out);
  if (!figures.lost.empty()) text += fmt::format("; lost: {}", fmt::join(figures.lost, ", "));
  return text;
}

}  // namespace

RepairFigures repair_map(const std::filesystem::path& map, MapWriter& output,
                         const std::function<void(const std::string&)>& on_damage) {
  RepairFigures figures;
  bool is_structure = true;
  const MapReader reader(map, [&](const std::string& damage) {
    on_damage((is_structure ? "damaged: " : "left out: ") + damage);
    ++(is_structure ? figures.faults : figures.left_out);
  });
  const auto held_state = reader.hold_state();
  reader.check_structure();
  is_structure = false;
  const MapMeta meta = reader.meta();
  const bool is_meta_damaged = figures.left_out > 0;
  reader.check_records();
  copy_all_but_tiles(reader, output);
  std::optional<double> tile_size;
  reader.for_each_stored_tile([&](const TileId& id, const TilePoints& tile) {
    figures.points += tile.size();
    if (!tile_size) tile_size = tile_size_of(id, tile);
    output.put_tile(id, tile);
  });
  if (is_meta_damaged) restore_meta(reader, meta, tile_size, output, figures);
  if (figures.left_out > 0) output.put_meta(meta_key::kRepair, description(meta, figures));
  output.finish();
  return figures;
}

}  // namespace fovea
