// MapReader::digest(), as docs/map-format.md defines it.
#include "fovea/map/map_file.h"
#include "fovea/map/map_store.h"
#include "fovea/map/meta_keys.h"
#include "fovea/map/record_rows.h"
#include "fovea/map/value_hash.h"

namespace fovea {
namespace {

bool is_in_digest(const std::string& key) {
  return key != meta_key::kFormatVersion && !key.starts_with(meta_key::kTimingPrefix) &&
         !key.starts_with(meta_key::kCameraModelPrefix);
}

/// The values of a row that belong to the digest.
void add_row(const Table& table, const Row& row, ValueHash& digest) {
  digest.row();
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (table.columns[i].in_digest) add_cell(row[i], digest);
  }
}

void add_meta(const MapReader& map, ValueHash& digest) {
  digest.section(kMetaTable.name);
  for (const auto& [key, value] : map.meta()) {
    if (is_in_digest(key)) add_row(kMetaTable, meta_row(key, value), digest);
  }
}

/// Records whose numbers are their places.
template <class Record>
void add_numbered(const Table& table, const std::vector<Record>& records,
                  Row (*to_row)(std::size_t, const Record&), ValueHash& digest) {
  digest.section(table.name);
  for (std::size_t id = 0; id < records.size(); ++id) {
    add_row(table, to_row(id, records[id]), digest);
  }
}

void add_frames(const std::vector<FrameRecord>& frames, ValueHash& digest) {
  digest.section(kFramesTable.name);
  for (const FrameRecord& frame : frames) add_row(kFramesTable, frame_row(frame), digest);
  digest.section(kViewsTable.name);
  for (const FrameRecord& frame : frames) {
    for (const ViewRecord& view : frame.views) {
      add_row(kViewsTable, view_row(frame.index, view), digest);
    }
  }
}

void add_keyframes(const MapReader& map, ValueHash& digest) {
  digest.section(kKeyframesTable.name);
  map.for_each_keyframe([&](const KeyframeRecord& keyframe) {
    std::vector<std::byte> blob;
    Row row = keyframe_row(keyframe, blob);
    const std::vector<std::byte> ranges = packed_ranges(keyframe);
    row.back() = std::span<const std::byte>(ranges);
    add_row(kKeyframesTable, row, digest);
  });
}

void add_tiles(const MapReader& map, ValueHash& digest) {
  digest.section(kTilesTable.name);
  map.for_each_stored_tile([&](const TileId& id, const TilePoints& tile) {
    const PackedTile packed = pack_tile(id, tile);
    TileRow row;
    row.submap = static_cast<std::int64_t>(id.submap);
    row.key = id.key;
    row.points = packed.points;
    row.colored = packed.colored;
    row.origin = packed.origin;
    Row cells = cells_of(row);
    for (std::size_t i = 0; i < kStoredColumns; ++i) {
      const bool is_missing = i >= kFirstOptionalColumn && packed.columns[i].empty();
      cells[kFirstPointColumn + i] =
          is_missing ? Cell() : Cell(std::span<const std::byte>(packed.columns[i]));
    }
    add_row(kTilesTable, cells, digest);
  });
}

/// The checksums of the tiles, which need not be decompressed for that.
void add_tile_checksums(MapFile& file, ValueHash& hash) {
  hash.section(kTilesTable.name);
  sqlite::Statement rows = file.query(kTilesTable, [&] {
    return sqlite::Statement(
        file.sqlite(), "SELECT submap, x, y, z, checksum FROM tiles ORDER BY submap, x, y, z");
  });
  while (file.query(kTilesTable, [&] { return rows.step(); })) {
    hash.row();
    for (int column = 0; column < 5; ++column) hash.value(rows.integer(column));
  }
}

void add_small_tables(const MapReader& map, ValueHash& digest) {
  add_meta(map, digest);
  add_numbered(kDrivesTable, map.drives(), drive_row, digest);
  add_numbered(kSensorsTable, map.sensors(), sensor_row, digest);
  add_frames(map.frames(), digest);
  add_numbered(kSubmapsTable, map.submap_records(), submap_row, digest);
}

}  // namespace

std::string MapReader::digest() const {
  const Snapshot snapshot(file_->sqlite());
  ValueHash digest;
  add_small_tables(*this, digest);
  add_keyframes(*this, digest);
  add_tiles(*this, digest);
  return digest.hex128();
}

std::string MapReader::identity() const {
  const Snapshot snapshot(file_->sqlite());
  ValueHash hash;
  add_small_tables(*this, hash);
  add_tile_checksums(*file_, hash);
  return hash.hex128();
}

}  // namespace fovea
