#include "fovea/map/map_format_6.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <memory>
#include <new>
#include <utility>

#include "fovea/errors.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/number_text.h"

namespace fovea {
namespace {

/// The columns of a table in the order of map_schema.h, with the checksum last.
std::string select_6(const Table& table) {
  static const std::map<std::string, const char*> columns = {
      {"meta", "key, value, NULL AS checksum FROM meta"},
      {"frames",
       "idx AS frame, stamp_ns, status, note, pose, navigation_pose, odom_pose AS odometry_pose, "
       "submap, revisited AS revisited_submap, revisited_pose, velocity AS motion, figures, "
       "timings AS timings_ms, NULL AS checksum FROM frames"},
      {"submaps",
       "id, 0 AS drive, pose, NULL AS covariance, NULL AS log2_gain, NULL AS checksum "
       "FROM submaps"},
      {"tiles",
       "submap, x, y, z, points, colored, origin_x AS origin_x_m, origin_y AS origin_y_m, "
       "origin_z AS origin_z_m, position AS position_mm, color, camera, frame, range AS range_cm, "
       "incidence AS incidence_half_deg, interpolated, views, spread, weight, reason, intensity, "
       "NULL AS saturated, NULL AS sensor, NULL AS sampling_level, NULL AS session, checksum "
       "FROM tiles"}};
  const auto found = columns.find(table.name);
  if (found != columns.end()) return fmt::format("SELECT {}", found->second);
  // A table that format 6 does not have is empty.
  std::string nothing;
  for (const Column& column : table.columns) nothing += fmt::format("NULL AS {}, ", column.name);
  return fmt::format("SELECT * FROM (SELECT {}NULL AS checksum LIMIT 0)", nothing);
}

std::uint64_t checksum_6(const TileRow& row) {
  const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                              XXH3_freeState);
  if (state == nullptr) throw std::bad_alloc();
  XXH3_64bits_reset(state.get());
  const auto add = [&](const void* data, std::size_t size) {
    if (size > 0) XXH3_64bits_update(state.get(), data, size);
  };
  const std::array<std::int64_t, 6> numbers = {row.submap, row.key.x,  row.key.y,
                                               row.key.z,  row.points, row.colored};
  add(numbers.data(), sizeof(numbers));
  add(row.origin.data(), 3 * sizeof(double));
  for (std::size_t i = 0; i < kSaturatedColumn; ++i) {
    const auto size = static_cast<std::int64_t>(row.blobs[i].size());
    add(&size, sizeof(size));
    add(row.blobs[i].data(), row.blobs[i].size());
  }
  return XXH3_64bits_digest(state.get());
}

/// Colors are three bytes a point.
PackedSizes packed_sizes_6(std::size_t column, std::size_t points) {
  if (column == kColorColumn) return {3 * points, 3 * points};
  return packed_sizes(column, points);
}

bool unpack_column_6(std::size_t column, std::span<const std::byte> bytes, std::size_t points,
                     TilePoints& tile) {
  if (column != kColorColumn) return unpack_column(column, bytes, points, tile);
  tile.colors.resize(points);
  for (std::size_t i = 0; i < points; ++i) {
    const std::byte* color = bytes.data() + 3 * i;
    tile.colors[i].color = {std::to_integer<std::uint8_t>(color[0]),
                            std::to_integer<std::uint8_t>(color[1]),
                            std::to_integer<std::uint8_t>(color[2])};
  }
  return true;
}

void rename(MapMeta& meta, const char* from, const std::string& to) {
  auto entry = meta.extract(from);
  if (entry.empty()) return;
  entry.key() = to;
  meta.insert(std::move(entry));
}

/// "calibration.camera_2" had four numbers: a rotation and a delay.
void split_corrections(MapMeta& meta) {
  const std::string prefix = meta_key::kCalibrationPrefix;
  const MapMeta stored = meta;
  for (auto at = stored.lower_bound(prefix); at != stored.end() && at->first.starts_with(prefix);
       ++at) {
    const auto numbers = numbers_from_text(at->second);
    const bool is_whole = numbers && numbers->size() == 4;
    // The reader of the two keys refuses any other text, for one of them at least.
    meta.erase(at->first);
    meta[at->first + meta_key::kRotationEnding] =
        is_whole ? to_text(std::span(*numbers).first(3)) : at->second;
    meta[at->first + meta_key::kDelayEnding] =
        is_whole ? to_text(std::span(*numbers).last(1)) : at->second;
  }
}

MapMeta meta_6(MapMeta meta) {
  rename(meta, "schema_version", meta_key::kFormatVersion);
  rename(meta, "map.tile_size", meta_key::kTileSize);
  rename(meta, "origin.latitude", meta_key::kOriginLatitude);
  rename(meta, "origin.longitude", meta_key::kOriginLongitude);
  rename(meta, "origin.altitude", meta_key::kOriginHeight);
  split_corrections(meta);
  std::erase_if(meta, [](const auto& entry) { return entry.first.starts_with("merged."); });
  return meta;
}

std::string text_of(const MapMeta& meta, const std::string& key) {
  const auto found = meta.find(key);
  return found == meta.end() ? std::string() : found->second;
}

/// Whole numbers, of which the first two are a range.
std::vector<int> range_of(const MapMeta& meta, const std::string& key, std::size_t count) {
  constexpr double kMost = 1 << 30;
  std::vector<int> range;
  for (const double value : numbers_from_text(text_of(meta, key)).value_or(std::vector<double>())) {
    const auto number = static_cast<int>(std::clamp(value, -kMost, kMost));
    if (value == number) range.push_back(number);
  }
  if (range.size() != count || range[0] < 0 || range[1] < range[0]) {
    throw InputError(fmt::format("'{}' is missing or cannot be read", key),
                     "the map's table 'meta'", kRestoreMap);
  }
  return range;
}

std::string merged_key(std::size_t drive, const char* what) {
  return fmt::format("merged.{}.{}", drive, what);
}

void set_origin(const MapMeta& meta, DriveRecord& drive) {
  if (text_of(meta, "georeferenced") == "0") return;
  std::vector<double> origin;
  for (const char* key : {"origin.latitude", "origin.longitude", "origin.altitude"}) {
    const auto number = numbers_from_text(text_of(meta, key));
    if (!number || number->size() != 1) return;
    origin.push_back(number->front());
  }
  drive.origin = GeodeticPoint{origin[0], origin[1], origin[2]};
  drive.datum = kWgs84;
  drive.height_type = HeightType::kEllipsoidal;
}

/// The first drive has the origin of the map. Format 6 does not have those of the others.
std::vector<DriveRecord> drives_6(const MapMeta& stored) {
  std::vector<DriveRecord> drives;
  for (std::size_t k = 1; stored.contains(merged_key(k, "digest")); ++k) {
    const std::vector<int> frames = range_of(stored, merged_key(k, "frames"), 3);
    DriveRecord& drive = drives.emplace_back();
    drive.name = text_of(stored, merged_key(k, "name"));
    drive.source_digest = stored.at(merged_key(k, "digest"));
    drive.first_frame = frames[0];
    drive.end_frame = frames[1];
    drive.frame_shift = frames[2];
  }
  const auto begin = numbers_from_text(text_of(stored, "frames.begin"));
  const auto end = numbers_from_text(text_of(stored, "frames.end"));
  if (drives.empty() && begin && end && begin->size() == 1 && end->size() == 1) {
    DriveRecord& drive = drives.emplace_back();
    drive.name = text_of(stored, "drive.name");
    constexpr double kMost = 1 << 30;
    drive.first_frame = static_cast<int>(std::clamp(begin->front(), 0.0, kMost));
    drive.end_frame = static_cast<int>(std::clamp(end->front(), double(drive.first_frame), kMost));
  }
  if (drives.empty()) return drives;
  drives.front().kind = text_of(stored, "drive.kind");
  set_origin(stored, drives.front());
  return drives;
}

std::vector<int> submap_drives_6(const MapMeta& stored, std::size_t submaps) {
  std::vector<int> drives(submaps, 0);
  for (std::size_t k = 1; stored.contains(merged_key(k, "digest")); ++k) {
    const std::vector<int> range = range_of(stored, merged_key(k, "submaps"), 2);
    for (int id = range[0]; id < range[1]; ++id) {
      if (std::size_t(id) >= submaps) {
        throw InputError(fmt::format("the submaps of drive {} are missing", k),
                         "the map's table 'submaps'", kRestoreMap);
      }
      drives[std::size_t(id)] = static_cast<int>(k - 1);
    }
  }
  return drives;
}

}  // namespace

const MapFormat& format_6() {
  static const MapFormat format{6,
                                /*has_checksums=*/false,
                                {checksum_6, packed_sizes_6, unpack_column_6},
                                select_6,
                                meta_6,
                                drives_6,
                                submap_drives_6};
  return format;
}

}  // namespace fovea
